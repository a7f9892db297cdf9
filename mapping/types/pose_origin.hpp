// pose_origin.hpp: origin of a scan's or a run's camera poses.
#pragma once
#include <string_view>

namespace roomradar {

enum class PoseOrigin {
  /// Estimated from depth and colour. Poses that a recording brings predict and constrain the motion; depth
  /// verifies them. Without recorded poses, the same as kTracked.
  kAuto,
  kTracked,   ///< estimated from depth and colour; recorded poses are ignored
  kRecorded,  ///< taken from the recording; frames without a pose are not fused
};

/// Returns the name used by the command line, maps and reports.
constexpr std::string_view to_string(PoseOrigin poses) {
  switch (poses) {
    case PoseOrigin::kAuto:
      return "auto";
    case PoseOrigin::kTracked:
      return "tracked";
    case PoseOrigin::kRecorded:
      return "recorded";
  }
  return "unknown";
}

}  // namespace roomradar
