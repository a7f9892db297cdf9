// pose_origin.hpp: origin of a scan's camera poses.
#pragma once
#include <string_view>

namespace roomradar {

enum class PoseOrigin {
  kTracked,   ///< estimated by odometry from depth and colour
  kRecorded,  ///< taken from the recording; frames without a pose are not fused
};

/// Returns the name used by the command line, maps and reports.
constexpr std::string_view to_string(PoseOrigin poses) {
  return poses == PoseOrigin::kTracked ? "tracked" : "recorded";
}

}  // namespace roomradar
