// scan_advice.hpp: detects faults of a running scan, and returns messages with a remedy.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "mapping/alignment/align.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Faults of a running scan, the most urgent first.
enum class ScanFault : std::uint8_t {
  kSilent,    ///< the device delivers no frames
  kTooNear,   ///< most surfaces in view are too near to be measured
  kTooFar,    ///< most surfaces in view are too far, or have no depth
  kLost,      ///< the camera's pose is unknown, or unknown relative to what was seen before
  kOneWall,   ///< the geometry in view does not constrain all degrees of freedom of the pose
  kTooFast,   ///< the camera moves too fast for the tracking
  kMovement,  ///< something moves in view
  kTooDark,   ///< the colour picture is dark
};
inline constexpr std::size_t kScanFaults = 8;

/// Returns a sentence that states the fault and the remedy.
std::string_view to_sentence(ScanFault fault);

/// Quantities of a frame and of the camera's motion from which faults are detected.
struct ScanFacts {
  double depth_fraction = 0.0;  ///< fraction of the pixels that have depth
  double near_fraction = 0.0;   ///< fraction of the pixels with depth below 0.6 m
  double far_fraction = 0.0;    ///< fraction of the pixels with depth above 4 m
  double brightness = -1.0;     ///< mean of the colour picture, 0..255; < 0: no picture
  double moved_fraction = 0.0;  ///< fraction of the pixels that show an object in space that was free before
  TrackStatus status = TrackStatus::kTracked;
  /// A new part of the scan began after a loss, and may still join what was seen before.
  bool is_apart = false;
  double speed_mps = 0.0, speed_rad_s = 0.0;  ///< speed of the camera, smoothed; 0 if unknown
};

/// Returns the quantities of a frame, except moved_fraction and the speeds. Uses every 8th pixel in both
/// directions.
ScanFacts facts_of(const Frame& frame, const Tracking& tracking);

/// Returns the camera's speed relative to the max speed for tracking: 1 at kMostSpeed_mps or
/// kMostSpeed_rad_s.
double relative_speed(const ScanFacts& facts);
inline constexpr double kMostSpeed_mps = 1.0, kMostSpeed_rad_s = 1.2;

/// Selects the fault to display. A fault is displayed after it has lasted for kLasts_s, and for at least
/// kStated_s, to avoid flicker.
class ScanAdvice {
 public:
  /// @param stamp_s  the frame's time; must not decrease
  void add(const ScanFacts& facts, double stamp_s);
  /// Returns the most urgent present fault other than kSilent; nullopt: none.
  [[nodiscard]] std::optional<ScanFault> fault() const { return fault_; }

  static constexpr double kLasts_s = 0.25, kStated_s = 1.5;

 private:
  std::array<std::optional<double>, kScanFaults> since_s_;  ///< stamp at which each fault began
  std::optional<ScanFault> fault_;
  double stated_s_ = 0.0;  ///< stamp at which fault_ was last true
};

}  // namespace roomradar
