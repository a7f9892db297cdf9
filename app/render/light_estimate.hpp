// light_estimate.hpp: estimates a room's light from the colours of mapped surfaces of unknown albedo.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "app/render/light_samples.hpp"
#include "app/render/room_light.hpp"

namespace roomradar {

struct LightConfig {
  /// Number of new surface points per second; 0: the light is not estimated.
  int samples_per_s = 180;
  /// Time constant with which older frames are forgotten.
  double memory_s = 1.0;
};
/// Checks that all values are in their ranges.
/// @throws Error naming the field, its value and the rule
void require_valid(const LightConfig& config);

/// Fraction of a smoothed value that is new after a time; the memory's part is exp(-seconds / memory_s).
float renewed_fraction(double seconds, const LightConfig& config);

/// Number of points to take from a frame, dt_s after the previous one.
/// @param is_first  more are taken from the first frame
int wanted_samples(bool is_first, double dt_s, const LightConfig& config);

/// Estimates the light that arrives at a place in the room, from the points of the last seconds.
///
/// The light is ambient light plus one lamp, whose light falls off with the square of its distance. Candidate
/// lamps are on a grid of 43 directions, 3 distances and 3 strengths around the place. Both are reduced by
/// the surfaces around a point (LightSample::reach). The logarithm of a pixel's colour is log albedo + log
/// irradiance. Surfaces of one hue are assumed to have one albedo, so a candidate is judged by the variance
/// of log colour - log irradiance within the hues, robust against outliers such as patterns. The light is the
/// mean over the candidates, weighted by their likelihood: an uncertain direction gives soft light, and the
/// estimate has no jumps. The level and the colour follow from the hues' albedos, since the brightest common
/// surfaces are near white. Source of the latter: Finlayson and Trezzi, Shades of gray and colour constancy,
/// CIC 2004 (Minkowski norm with p = 6).
class LightEstimator {
 public:
  /// Adds a frame's samples, dt_s after the previous frame. They replace the oldest of 720. The first
  /// estimate tests all candidates, later ones some in turn, so that all are tested every second. There is no
  /// estimate from fewer than 30 samples. Ignores samples that are not finite, and frames with a dt_s that is
  /// not.
  /// @param place_world_m  where the light is wanted; should change slowly
  void add(std::span<const LightSample> samples, const Eigen::Vector3f& place_world_m, double dt_s,
           const LightConfig& config);
  /// The light at the place, if nothing shades it; unset before the first samples.
  [[nodiscard]] const std::optional<RoomLight>& light() const { return light_; }
  /// The light where the room's surfaces leave only some of it. All zero before the first samples.
  [[nodiscard]] RoomLight light_at(const LightReach& reach) const;

 private:
  struct Point {
    LightSample sample;
    float grey;  ///< mean of log_colour
    int hue;
  };
  std::vector<Point> points_;  ///< the latest, in a ring
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
