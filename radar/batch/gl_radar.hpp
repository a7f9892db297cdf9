// gl_radar.hpp: collision by two orthographic depth passes: how far may an object go before it touches?
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mapping/types/image.hpp"
#include "radar/batch/least_gap.hpp"
#include "radar/batch/mask_cache.hpp"
#include "radar/batch/radar_volume.hpp"
#include "radar/batch/scene_mesh.hpp"
#include "radar/batch/tile_atlas.hpp"
#include "radar/batch/tile_draws.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "radar/exact/radar_pictures.hpp"
#include "radar/geometry/contact.hpp"
#include "radar/gl/gl_context.hpp"
#include "radar/gl/gpu_mesh.hpp"

namespace roomradar {

/// Where the least gap of a query is found.
enum class GlMinimum {
  kAuto,        ///< on a GPU there, with the software renderer here
  kOnRenderer,  ///< by a compute shader; a few bytes a query come back
  kReadBack,    ///< all pixels come back
};

struct GlRadarConfig {
  int resolution_px = 128;            ///< samples along the longer side of the object's outline, 1 to 4096
  double overlap_tolerance_m = 0.03;  ///< surfaces deeper inside the object are behind it, not in its way
  int atlas_px = 2048;                ///< side of the textures that many queries share, 1 to 16384
  GlMinimum minimum = GlMinimum::kAuto;
  /// Asks the processor's radar for the exact answer where the two passes cannot tell (see GlRadar) and all
  /// meshes that reach the query's volume share a tree (GpuMesh::tree()).
  bool settle = true;
};
/// @throws Error naming the field, its value and the rule
void require_valid(const GlRadarConfig& config);

/// One question to the radar.
struct GlQuery {
  static constexpr std::size_t kNotInScene = static_cast<std::size_t>(-1);
  MeshInstance object;
  Eigen::Vector3d direction_world = Eigen::Vector3d::Zero();  ///< any length but 0
  double distance_m = 0.0;                                    ///< how far ahead to look, > 0, at most 10 km
  /// Which of the scene is the object itself, and is left out.
  std::size_t own_index = kNotInScene;
};

/// Cyber Radar: an object that moves along a line touches first where the scene is nearest ahead of its
/// front.
///
///     rear plane                                                  far plane
///        |<------------------------ d ------------------------------->|
///        |                        [object]         (scene)            |      u ->
///        |<-------------- R ---------------------->|                  |
///        |                               |<--------------- M -------->|      L = R + M - d
///
/// M is the object seen from the far plane, R the scene seen from the rear plane through the object's
/// outline, L the gap between them in each pixel; the least L is the way to go. L is defined only where the
/// object covers the pixel and something is there. R is the first surface not behind the object's front: per
/// pixel, a surface is passed over when it lies behind the front
///   - and faces along the motion (what the object leaves, such as the table that a plate is lifted from), or
///   - by more than overlap_tolerance_m or the object's own length, whichever is less, or
///   - not for certain inside the front slab of the object's solid (in a hollow, such as the hole of a
///   handle).
///
/// travel_m is sampled: a spike or sheet thinner than a pixel may be missed, a surface in a hollow meets the
/// object's front layer only, and the answer is late by about half a pixel's diagonal times the sum of both
/// slopes. lower_m and upper_m hold all the same. They come from the same two passes: each pixel also keeps
/// what may be anywhere in its square, and what is on its centre line for certain. lower_m is 0 where
/// something of the scene is in the same pixel as the object and neither wholly ahead nor wholly behind: a
/// wall that is passed closer than a pixel, a peg in a hollow. Such a query is settled on the processor if it
/// can be (GlRadarConfig::settle): its answer is then exact, with lower_m = upper_m.
///
/// Surfaces that are met from one side only (is_one_sided(), such as the frontier of what was seen) are met
/// from both here: where that matters, ask CyberRadar.
///
/// Overlap and hollow need triangles that wind counter-clockwise seen from outside, and a closed object.
/// Masks are kept: an object that is asked about again along the same direction in its own frame is not drawn
/// again. Source of R, M and L: the Cyber Radar paper's Range, Mask and LookAt Distance Scopes. Not thread
/// safe.
class GlRadar {
 public:
  /// @throws Error if config is out of its rules or the renderer lacks what is needed
  explicit GlRadar(GlContext& context, const GlRadarConfig& config = {});
  ~GlRadar();
  GlRadar(const GlRadar&) = delete;
  GlRadar& operator=(const GlRadar&) = delete;

  /// How far `object` can move along a line until it touches the scene.
  ///
  /// @param object           the sensor object; must not be in `scene`
  /// @param direction_world  any length but 0
  /// @param distance_m       how far ahead to look, > 0, at most 10 km
  /// @param scene            what can be touched; instances with a null or empty mesh are left out
  /// @return see Contact. L within 10 um + 1e-6 d of zero counts as touching: kContact with travel 0. Where
  ///         several pixels are equally near (a face that lands flat) the point is the one nearest to their
  ///         middle.
  /// Never throws; allocates nothing after the first queries of a size.
  Contact query(const MeshInstance& object, const Eigen::Vector3d& direction_world, double distance_m,
                std::span<const SceneMesh> scene);

  /// The same for many objects and directions at once, drawn into shared textures and read back together.
  /// @param scene     what can be touched, the objects among it: each is scene for the others
  /// @param contacts  gets one for each query; must have their size
  void query_all(std::span<const GlQuery> queries, std::span<const SceneMesh> scene,
                 std::span<Contact> contacts);

  /// Of the last call's last query that was not kInvalidInput; everything empty if there is none. Where
  /// nothing of the scene reaches the volume, nothing is drawn and both hold depth_m.
  [[nodiscard]] RadarPictures pictures() const;

 private:
  /// A query that was drawn.
  struct Drawn {
    std::size_t query = 0;
    RadarOutline outline;
    std::size_t first_reach = 0, reach_count = 0;
  };
  /// A run of triangles of the scene that reaches a query's volume.
  struct Reach {
    std::size_t scene_index = 0;
    std::uint32_t first_triangle = 0;
    std::uint32_t first_key = 0;
  };
  /// Where the last picture is.
  struct Shown {
    RadarVolume volume;
    TileQuery tile;
    bool is_valid = false, is_drawn = false;
  };

  GlRadarConfig config_;
  TileAtlas object_tiles_, scene_tiles_;
  MaskCache masks_;
  TileDraws object_draws_, scene_draws_;
  LeastGap least_;
  unsigned clear_program_ = 0, object_program_ = 0, scene_program_ = 0;

  // Of one call; kept for their memory.
  SceneBoxes boxes_;
  std::vector<Drawn> drawn_;
  std::vector<Reach> reaches_;
  std::vector<TileDraw> batch_object_draws_, batch_scene_draws_;
  std::vector<TileQuery> batch_;
  Shown shown_;
  CyberRadar settler_;
  std::vector<SceneTree> settle_trees_;

  bool fit_atlases(std::size_t queries);
  bool add(std::size_t index, const GlQuery& query, std::span<const SceneMesh> scene, Contact& contact);
  void draw_batch();
  [[nodiscard]] Contact contact_of(const GlQuery& query, const Drawn& drawn, const TileResult& result,
                                   std::span<const SceneMesh> scene) const;
  void settle(const GlQuery& query, const Drawn& drawn, std::span<const SceneMesh> scene, Contact& contact);
};

}  // namespace roomradar
