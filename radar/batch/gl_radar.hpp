// gl_radar.hpp: Cyber Radar with OpenGL: distance to contact along a line, from two orthographic depth
// passes.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "radar/batch/least_gap.hpp"
#include "radar/batch/mask_cache.hpp"
#include "radar/batch/radar_volume.hpp"
#include "radar/batch/tile_atlas.hpp"
#include "radar/batch/tile_draws.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "radar/exact/radar_pictures.hpp"
#include "radar/exact/scene_boxes.hpp"
#include "radar/geometry/contact.hpp"
#include "radar/gl/gl_context.hpp"
#include "radar/gl/gpu_mesh.hpp"

namespace roomradar {

/// A mesh that can be touched, its pose, and its kind.
struct GpuSceneMesh {
  MeshInstance instance;
  SurfaceKind kind = SurfaceKind::kStatic;
};
inline bool has_surface(const GpuSceneMesh& s) {
  return s.instance.mesh != nullptr && s.instance.mesh->triangle_count() > 0;
}

/// Builds the hierarchy over the bounding boxes of a scene's meshes, as SceneBoxes::build() does.
inline void build(SceneBoxes& boxes, std::span<const GpuSceneMesh> scene) {
  boxes.clear();
  for (std::size_t i = 0; i < scene.size(); ++i)
    if (has_surface(scene[i])) boxes.add(i, scene[i].instance.mesh->bounds(), scene[i].instance.T_world_mesh);
  boxes.finish();
}

/// Processor that computes the minimum over each query's pixels.
enum class GlMinimum {
  /// The GPU if there is one, else the CPU.
  kAuto,
  /// The renderer, by compute shader. A few bytes per query are read back.
  kOnRenderer,
  /// The CPU. All pixels are read back.
  kReadBack,
};

struct GlRadarConfig {
  /// Number of samples along the longer side of the object's bounding rectangle perpendicular to the motion,
  /// 1 to 4096.
  int resolution_px = 128;
  /// In each pixel, surfaces more than this distance behind the object's front surface are ignored.
  double overlap_tolerance_m = 0.03;
  /// Side of the textures shared by many queries, 1 to 16384. Raised to resolution_px, and limited to the
  /// renderer's max texture size.
  int atlas_px = 2048;
  GlMinimum minimum = GlMinimum::kAuto;
  /// True: a query whose lower_m would be 0 for lack of resolution (see GlRadar) gets an exact result from
  /// CyberRadar. Requires a triangle tree (GpuMesh::tree()) for the object and for every mesh that intersects
  /// the query's volume.
  bool exact_fallback = true;
};
/// Checks that all values are in their ranges.
/// @throws Error naming the field, its value and the rule
void require_valid(const GlRadarConfig& config);

/// One query of GlRadar::query_all().
struct GlQuery {
  static constexpr std::size_t kNotInScene = static_cast<std::size_t>(-1);
  /// The moving object.
  MeshInstance object;
  /// Direction of motion; any length except 0.
  Eigen::Vector3d direction_world = Eigen::Vector3d::Zero();
  /// Max distance to search, > 0, at most 10 km.
  double distance_m = 0.0;
  /// Index of the object's own mesh in the scene, which the query skips. kNotInScene if there is none.
  std::size_t own_index = kNotInScene;
};

/// Returns false if GlRadar rejects the query, whatever the scene.
bool is_usable(const GlQuery& query);

/// A contiguous range of a scene mesh's triangles, in chunks whose bounding boxes intersect a query's volume.
/// Every triangle in a range has a key that is unique within the query. Triangle first_triangle + k of the
/// mesh has the key first_key + k.
struct SceneRun {
  /// Index into the scene of contact_of().
  std::size_t scene_index = 0;
  std::uint32_t first_triangle = 0;
  std::uint32_t first_key = 0;
};

/// Returns the contact (status, bounds, point, normal and kind) of a query that was drawn.
/// @param outline  bounding rectangle and pixel grid of the object, seen along its direction of motion
/// @param result   least gap over the query's pixels, its pixel, and the key of the triangle touched
/// @param runs     triangle ranges that intersect the query's volume, by ascending first_key
/// @param scene    meshes for which the query was drawn; SceneRun::scene_index is an index into it
Contact contact_of(const GlQuery& query, const RadarOutline& outline, const TileResult& result,
                   std::span<const SceneRun> runs, std::span<const GpuSceneMesh> scene);

/// Queries that are drawn together, and their draws.
struct TileBatch {
  std::vector<TileQuery> queries;
  /// Draws of the objects whose masks are not cached.
  std::vector<TileDraw> object_draws;
  /// Draws of the scene.
  std::vector<TileDraw> scene_draws;

  void clear();
};

/// Owns the shader programs, textures and buffers of both passes. Not thread safe.
class TilePasses {
 public:
  /// @throws Error if the renderer lacks a required feature
  explicit TilePasses(GlContext& context);
  ~TilePasses();
  TilePasses(const TilePasses&) = delete;
  TilePasses& operator=(const TilePasses&) = delete;

  /// Returns the tiles with the objects' masks (M), indexed as in MaskCache.
  TileAtlas& object_tiles() { return object_.tiles; }
  [[nodiscard]] const TileAtlas& object_tiles() const { return object_.tiles; }
  /// Returns the tiles of the scene, indexed by the query's index in its batch.
  TileAtlas& scene_tiles() { return scene_.tiles; }
  [[nodiscard]] const TileAtlas& scene_tiles() const { return scene_.tiles; }

  /// Draws both passes for the queries of the batch, and writes the minimum over each scene tile to `least`.
  /// Sorts the batch's draws. Requires at least one query.
  void draw(TileBatch& batch, LeastGap& least);
  /// Makes the next call reallocate the buffers. Call it after the renderer failed.
  void forget();

 private:
  struct Pass {
    explicit Pass(GlContext& context) : tiles(context), draws(context) {}
    TileAtlas tiles;
    TileDraws draws;
    unsigned program = 0;
  };
  Pass object_, scene_;
  unsigned clear_program_ = 0;
};

/// Computes the distance to contact of an object that moves along a line. Contact is in the pixel with the
/// least gap between the object's front and the scene ahead of it.
///
///     rear plane                                                  far plane
///        |<------------------------ d ------------------------------->|
///        |                        [object]         (scene)            |      u ->
///        |<-------------- R ---------------------->|                  |
///        |                               |<--------------- M -------->|      L = R + M - d
///
/// u is the direction of motion. M is the object's depth image (its mask) seen from the far plane. R is the
/// scene's depth image seen from the rear plane, limited to the object's silhouette. L is the gap between
/// object and scene in each pixel; the least L is the distance to contact. L is defined only in pixels that
/// both the object and the scene cover. In each pixel, R shows the first scene surface that is ahead of the
/// object's front or overlaps the object. A surface behind the front counts as an overlap, unless it
///   - is back-facing, since the object moves away from it (for example the table below a lifted plate), or
///   - is farther behind the front than overlap_tolerance_m or the object's length along u, or
///   - is not certainly inside the front slab (the solid between the object's front and its next surface
///     behind the front), since it may be in a concavity such as the hole of a handle.
///
/// contact_distance_m is sampled and has three kinds of error. A spike or sheet thinner than a pixel may be
/// missed. A surface in a concavity is compared with the object's front only. On sloped surfaces,
/// contact_distance_m is too large by about half a pixel's diagonal times the sum of the two surfaces'
/// slopes.
///
/// lower_m and upper_m are guaranteed bounds. Both come from the same two passes. Each pixel also stores
/// depth bounds of the surfaces that may touch its square, and of those that certainly cross its sample line
/// (the line along u through its sample position). lower_m is 0 if, in one of the object's pixels, a scene
/// surface is neither certainly ahead of the object nor certainly behind it. Examples are a wall that the
/// object passes at less than a pixel's distance, and a peg in a hole. Such a query is repeated with the
/// exact test on the CPU if possible (GlRadarConfig::exact_fallback). Then lower_m = upper_m, except beyond
/// CyberRadar::kMostWorkBehind.
///
/// One-sided surfaces (is_one_sided(), for example the frontier of observed space) block GlRadar's objects
/// from both sides. Use CyberRadar if they must block from their outside only.
///
/// Overlaps and concavities are recognised only if the object's mesh is closed and its triangles are
/// counter-clockwise seen from outside. Masks are cached by the object's mesh and the direction in its frame.
/// R, M and L are the Range, Mask and LookAt Distance Scopes of the Cyber Radar paper. Not thread safe.
class GlRadar {
 public:
  /// @throws Error if config is invalid or the renderer lacks a required feature
  explicit GlRadar(GlContext& context, const GlRadarConfig& config = {});
  GlRadar(const GlRadar&) = delete;
  GlRadar& operator=(const GlRadar&) = delete;

  /// Computes the distance to contact of `object`. Never throws. Allocates nothing once queries of this size
  /// have been run.
  ///
  /// @param object           the moving object; must not be in `scene`
  /// @param direction_world  direction of motion; any length except 0
  /// @param distance_m       max distance to search, > 0, at most 10 km
  /// @param scene            surfaces that can be touched; instances with a null or empty mesh are skipped
  /// @return see Contact. A gap L within 10 um + 1e-6 d of zero counts as touching: the result is kContact
  ///         with distance 0. If several pixels are equally near (a face that lands flat), the contact point
  ///         is in the pixel nearest to the centre of their bounding box.
  Contact query(const MeshInstance& object, const Eigen::Vector3d& direction_world, double distance_m,
                std::span<const GpuSceneMesh> scene);

  /// Runs many queries at once. The queries are drawn into shared textures, and their results are read back
  /// together.
  /// @param scene     surfaces that can be touched, including the queried objects, which can touch each other
  /// @param[out] contacts  one per query; must have the size of `queries`
  void query_all(std::span<const GlQuery> queries, std::span<const GpuSceneMesh> scene,
                 std::span<Contact> contacts);

  /// Returns the images of the last call's last valid query (not kInvalidInput). All images are empty if the
  /// call had no valid query. If no scene surface intersects the query's volume, nothing was drawn: R and M
  /// equal RadarVolume::depth_m in all pixels.
  [[nodiscard]] RadarPictures pictures() const;

 private:
  /// A query that was drawn. Its scene triangles are the run_count entries of runs_ that begin at first_run.
  struct Drawn {
    std::size_t query = 0;
    RadarOutline outline;
    std::size_t first_run = 0, run_count = 0;
  };
  /// The query whose images pictures() returns.
  struct Shown {
    RadarVolume volume;
    TileQuery tile;
    bool is_valid = false, is_drawn = false;
  };

  GlRadarConfig config_;
  TilePasses passes_;
  MaskCache masks_;
  LeastGap least_;

  // Scratch memory of one call, kept between calls.
  SceneBoxes boxes_;
  std::vector<Drawn> drawn_;
  std::vector<SceneRun> runs_;
  TileBatch batch_;
  Shown shown_;
  CyberRadar exact_radar_;
  std::vector<SceneTree> exact_trees_;

  bool fit_atlases(std::size_t queries);
  bool add(std::size_t index, const GlQuery& query, std::span<const GpuSceneMesh> scene, Contact& contact);
  void add_scene_draws(const GlQuery& query, const RadarOutline& outline, const RadarVolume& volume,
                       const TileQuery& tile, std::span<const GpuSceneMesh> scene);
  void draw_batch();
  [[nodiscard]] std::span<const SceneRun> runs_of(const Drawn& drawn) const;
  void exact_fallback(const GlQuery& query, const Drawn& drawn, std::span<const GpuSceneMesh> scene,
                      Contact& contact);
};

}  // namespace roomradar
