// pose_origin.hpp: where the poses of a source's frames come from.
#pragma once
#include <string_view>

namespace roomradar {

enum class PoseOrigin {
  kTracked,   ///< estimated by odometry from depth and colour
  kRecorded,  ///< taken from the recording; frames without a pose are not fused
};

/// The name that the command line, the map and the reports use.
constexpr std::string_view to_string(PoseOrigin poses) {
  return poses == PoseOrigin::kTracked ? "tracked" : "recorded";
}

}  // namespace roomradar
