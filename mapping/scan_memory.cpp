// scan_memory.cpp: extrapolates from single frames to a whole scan.
#include "mapping/scan_memory.hpp"

#include <algorithm>

#include "mapping/octree/static_map.hpp"
#include "mapping/types/system/process_memory.hpp"

namespace roomradar {

double memory_after_fusion(double octree_bytes) { return std::min(4.0 * octree_bytes, 100e6 + octree_bytes); }

std::optional<MemoryEstimate> estimate_memory(FrameSource& source, double resolution_m) {
  constexpr std::int64_t kLooks = 4, kTries = 5, kMinute = 1800;
  constexpr double kFramesAnew = 80.0, kWholeRoom = 20.0;
  // Of the stages after surface extraction: pictures for the texture, coverage, unknown space.
  constexpr double kLaterStages_bytes = 130e6;
  constexpr double kTracking_bytes = 60e6,
                   kKeyframe_bytes = 0.04e6;  // per frame; one frame in eight becomes a keyframe
  const std::optional<std::int64_t> count = source.frame_count();
  MemoryEstimate estimate{.frames = count.value_or(kMinute), .length_known = count.has_value()};
  double sum_bytes = 0.0;
  int looks = 0;
  Frame frame;
  for (std::int64_t look = 0; look < kLooks; ++look) {
    if (look > 0 && !(count && source.seek(look * *count / kLooks))) break;
    for (std::int64_t attempt = 0; attempt < kTries; ++attempt) {
      const ReadResult result = source.next(frame);
      if (result.status == ReadStatus::kEnd) break;
      if (result.status != ReadStatus::kFrame) continue;
      StaticMap map(resolution_m);
      if (map.fuse(frame, Eigen::Isometry3d::Identity()) != FuseStatus::kFused) continue;
      sum_bytes += static_cast<double>(map.memory_bytes());
      ++looks;
      break;
    }
  }
  if (!source.rewind() || looks == 0) return std::nullopt;
  const auto frames = static_cast<double>(estimate.frames);
  estimate.octree_bytes = sum_bytes / looks * std::min(1.0 + frames / kFramesAnew, kWholeRoom);
  estimate.process_bytes =
      static_cast<double>(resident_bytes()) +
      std::max(
          kTracking_bytes + frames * kKeyframe_bytes,
          estimate.octree_bytes + std::max(memory_after_fusion(estimate.octree_bytes), kLaterStages_bytes));
  return estimate;
}

}  // namespace roomradar
