// light_estimate.hpp: estimates a room's light from the colours of mapped surfaces of unknown albedo.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "app/render/room_light.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// A surface point of the static room in a frame.
struct LightSample {
  Eigen::Vector3f p_world_m = Eigen::Vector3f::Zero();
  /// Unit normal of the map's surface, towards the camera.
  Eigen::Vector3f normal_world = Eigen::Vector3f::UnitZ();
  /// Natural logarithm of red, green and blue in linear light. A byte b counts as (b / 255)^2, as in
  /// ObjectDrawer.
  Eigen::Vector3f log_colour = Eigen::Vector3f::Zero();
  LightReach reach;  ///< not set by take_light_samples()
};

/// A colour image with its camera.
struct ColourView {
  const ColourImage& colour;
  const Intrinsics& camera;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

/// The map's surface as seen from the depth camera, and the depth measured there.
struct SurfaceView {
  const DepthImage& expected_m;  ///< depth of the map
  const Intrinsics& camera;      ///< camera of expected_m
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  /// Measured depth in the same view. Its size is that of expected_m or a multiple.
  const DepthImage& measured_m;
  /// Non-zero: dynamic pixel of expected_m. Empty: none.
  const MaskImage& dynamic_mask;
};

/// Takes up to `wanted` points at the next pixels of a sequence that covers the depth image evenly. Leaves
/// out dynamic points, points where measured and expected depth disagree, and points whose neighbourhood is
/// not one smooth surface. Also leaves out points outside the colour image, and points with a saturated or
/// almost black colour. Tests at most four pixels per wanted point. Reuses the vector's memory. Returns no
/// samples without colour or depth, or if sizes do not match.
/// @param[in,out] position  index in the sequence; 0 at first. Source of the sequence: see spread_points()
void take_light_samples(const ColourView& colour, const SurfaceView& surface, int wanted,
                        std::uint64_t& position, std::vector<LightSample>& samples);

struct LightConfig {
  /// Number of surface points that are sampled per second; 0: the light is not estimated.
  int samples_per_s = 180;
  /// Time constant with which older frames are forgotten.
  double memory_s = 1.0;
};
/// Checks that all values are in their ranges.
/// @throws Error naming the field, its value and the rule
void require_valid(const LightConfig& config);

/// Returns the weight of a new value in exponential smoothing, 1 - exp(-seconds / memory_s).
float renewed_fraction(double seconds, const LightConfig& config);

/// Returns the number of points to take from a frame, dt_s after the previous one.
/// @param is_first  true: more points are taken
int wanted_samples(bool is_first, double dt_s, const LightConfig& config);

/// Estimates the light that arrives at a place in the room, from the points of the last seconds.
///
/// The model is ambient light plus one lamp, whose light falls off with the square of its distance. Surfaces
/// around a point occlude both in part (LightSample::reach). Candidate lamps are on a grid of 43 directions,
/// 3 distances and 3 strengths around the place. The logarithm of a pixel's colour is log albedo + log
/// irradiance. Surfaces of one hue are assumed to have one albedo. The score of a candidate is thus the
/// variance of log colour - log irradiance within the hues, by an estimate robust against outliers such as
/// patterns. The result is the mean over the candidates, weighted by their likelihood. Hence an uncertain
/// direction gives soft light, and the estimate does not jump. Level and colour of the light follow from the
/// hues' albedos, since the brightest common surfaces are near white. Source of this step: Finlayson and
/// Trezzi, Shades of gray and colour constancy, CIC 2004 (Minkowski norm with p = 6).
class LightEstimator {
 public:
  /// Adds a frame's samples, dt_s after the previous frame. They replace the oldest of 720 samples. The first
  /// estimate tests all candidates. Later estimates test some in turn, so that all are tested every second.
  /// There is no estimate from fewer than 30 samples. Ignores samples that are not finite or whose
  /// reach.ambient is at most 0.3, and all samples if dt_s or the position is not finite.
  /// @param place_world_m  position for which light is estimated; should change slowly
  void add(std::span<const LightSample> samples, const Eigen::Vector3f& place_world_m, double dt_s,
           const LightConfig& config);
  /// Returns the light at place_world_m without occlusion by nearby surfaces; unset before the first
  /// estimate.
  [[nodiscard]] const std::optional<RoomLight>& light() const { return light_; }
  /// Returns the light at a position that surfaces occlude as `reach` states. All zero before the first
  /// estimate.
  [[nodiscard]] RoomLight light_at(const LightReach& reach) const;

 private:
  struct Point {
    LightSample sample;
    float grey;  ///< mean of log_colour
    int hue;
  };
  std::vector<Point> points_;  ///< the latest points, as a ring buffer
  std::size_t next_point_ = 0;
  std::vector<float> scores_;  ///< mean squared residual per candidate; empty before the first samples
  std::size_t next_candidate_ = 0;
  /// Strength of lamps in each direction, beside ambient light of mean irradiance 1.
  std::array<float, kLampDirections> lamps_{};
  Eigen::Vector3f log_level_ = Eigen::Vector3f::Zero();  ///< logarithm of the ambient irradiance
  std::optional<RoomLight> light_;

  void keep_points(std::span<const LightSample> samples);
  void test_candidates(const Eigen::Vector3f& place_world_m, double dt_s, const LightConfig& config);
};

}  // namespace roomradar
