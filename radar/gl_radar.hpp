// gl_radar.hpp: collision by two orthographic depth passes: how far may an object go before it touches?
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <span>

#include "mapping/types/image.hpp"
#include "radar/contact.hpp"
#include "radar/gl_context.hpp"
#include "radar/gpu_mesh.hpp"
#include "radar/radar_volume.hpp"

namespace roomradar {

struct GlRadarConfig {
  int resolution_px = 128;            ///< samples along the longer side of the object's outline, 1 to 4096
  double overlap_tolerance_m = 0.03;  ///< surfaces deeper inside the object are behind it, not in its way
};
/// @throws Error naming the field, its value and the rule
void require_valid(const GlRadarConfig& config);

/// A mesh that can be touched.
struct SceneMesh {
  MeshInstance instance;
  Touched kind = Touched::kStatic;
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
/// object covers the pixel (M < d) and something is there (R < d). R is the first surface not behind the
/// object's front: per pixel, a surface is passed over when it lies behind the front
///   - and faces along the motion (what the object leaves, such as the table that a plate is lifted from), or
///   - by more than overlap_tolerance_m or the object's own length, whichever is less, or
///   - behind the front slab of the object's solid (in a hollow, such as the hole of a handle).
/// The last is looked at only when an overlap would be reported; it costs one more pass over object and
/// scene.
///
/// Limits: sampling answers late: by about half a pixel's diagonal times the sum of both slopes (measured at
/// 128 px on bumpy shapes: a quarter of a pixel in the median, two at worst), and early only by the
/// renderer's snap of vertices to 1/256 pixel across a slope. A spike or sheet thinner than a pixel may be
/// missed; a sheet seen edge-on has no pixel. A surface in a hollow meets the object's front layer only, so a
/// peg inside a handle is not felt by the handle's upper side. Overlap and hollow need triangles that wind
/// counter-clockwise seen from outside. Source of R, M and L: the Cyber Radar paper's Range, Mask and LookAt
/// Distance Scopes. Not thread safe.
class GlRadar {
 public:
  explicit GlRadar(GlContext& context, const GlRadarConfig& config = {});
  ~GlRadar();
  GlRadar(const GlRadar&) = delete;
  GlRadar& operator=(const GlRadar&) = delete;

  /// How far `object` can move along a line until it touches the scene.
  ///
  /// @param object           the sensor object; must not be in `scene`
  /// @param direction_world  any length but 0
  /// @param distance_m       how far ahead to look, > 0, at most 10 km; the depth step is 6e-8 of d
  /// @param scene            what can be touched; instances with a null or empty mesh are left out
  /// @return see Contact. L within 10 um + 1e-6 d of zero counts as touching: kContact with travel 0. Where
  ///         several pixels are equally near (a face that lands flat) the point is the one nearest to their
  ///         middle.
  /// Never throws; allocates nothing after the first queries of a size.
  Contact query(const MeshInstance& object, const Eigen::Vector3d& direction_world, double distance_m,
                std::span<const SceneMesh> scene);

  /// The last query's volume and images, row by row, of volume().width_px x height_px.
  /// R, M: metres, volume().depth_m where there is nothing. L: metres, NaN where undefined. R is seen through
  /// the object's outline and past what lies behind its front. Where nothing of the scene reaches the volume,
  /// nothing is drawn and both hold depth_m. After kInvalidInput all are empty.
  [[nodiscard]] const RadarVolume& volume() const { return volume_; }
  [[nodiscard]] const Image<float>& range_m() const { return range_m_; }
  [[nodiscard]] const Image<float>& mask_m() const { return mask_m_; }
  [[nodiscard]] const Image<float>& lookat_m() const { return lookat_m_; }

 private:
  enum Layer : std::size_t { kMask, kRange, kEntry, kLayerCount };

  GlRadarConfig config_;
  RadarVolume volume_;
  Image<float> range_m_;
  Image<float> mask_m_;
  Image<float> lookat_m_;
  unsigned mask_program_ = 0;
  unsigned range_program_ = 0;
  unsigned entry_program_ = 0;
  std::array<unsigned, kLayerCount> textures_{};
  std::array<unsigned, kLayerCount> framebuffers_{};  // one a texture
  unsigned readback_buffer_ = 0;

  [[nodiscard]] double touching_m() const;
  void begin_layer(Layer layer, unsigned program) const;
  void draw_mask(const MeshInstance& object) const;
  void draw_entry(const MeshInstance& object) const;
  void draw_range(std::span<const SceneMesh> scene) const;
  std::optional<double> read_and_compare();
  [[nodiscard]] Contact contact_at_least_gap(double least_m, std::span<const SceneMesh> scene) const;
};

}  // namespace roomradar
