// chosen_frames.hpp: reads selected frames of a recording again, with read-ahead on a second thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "mapping/types/read_ahead.hpp"
#include "mapping/types/system/stage_times.hpp"

namespace roomradar {

/// A fused frame, and its position in the source.
struct FusedFrame {
  std::int64_t position = 0;  ///< number of frames read from the source before this frame
  std::int64_t frame_index = 0;
  Intrinsics depth_camera;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

/// Delivers the chosen frames in order. Seeks past frames that are not chosen if the source can seek. While
/// the caller uses one frame, a second thread reads the next one. The caller must not use the source
/// meanwhile.
class ChosenFrames {
 public:
  /// @param fused   all fused frames; must outlive this object
  /// @param chosen  indices in `fused`, increasing
  /// @param times   the time that next() waits is added to stage "read"
  /// @throws Error if the source cannot be rewound
  ChosenFrames(FrameSource& source, std::span<const FusedFrame> fused, std::vector<std::size_t> chosen,
               StageTimes& times);

  /// Fills `frame` with the next chosen frame, and `index` with its index in `fused`. Leaves out a frame if
  /// the source now delivers another frame index, or no readable frame, at its position. Returns false after
  /// the last frame. Rethrows Error of the source.
  bool next(Frame& frame, std::size_t& index);

 private:
  std::span<const FusedFrame> fused_;
  std::vector<std::size_t> chosen_;
  StageTimes& times_;
  std::size_t next_ = 0;  ///< index in chosen_
  ReadAhead<std::monostate> ahead_;
};

}  // namespace roomradar
