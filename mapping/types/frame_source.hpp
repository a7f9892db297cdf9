// frame_source.hpp: the one seam with virtual functions: where frames come from.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "mapping/types/frame.hpp"

namespace roomradar {

enum class ReadStatus {
  kFrame,    ///< `frame` was filled
  kSkipped,  ///< one bad frame was passed over; `fault` says which and why; go on with the next
  kEnd,      ///< no more frames; `frame` is as it was
};

struct [[nodiscard]] ReadResult {
  ReadStatus status = ReadStatus::kEnd;
  std::string fault;     ///< a sentence, only if skipped
  bool waiting = false;  ///< skipped, but no frame was passed over: a live source has had none for a while
};

/// Frames in the order of their stamps. Not thread safe.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  /// Fills `frame`, reusing its allocations. A single unreadable frame is kSkipped; a source that cannot go
  /// on (device gone, disk error, ten unreadable frames one after the other) throws Error.
  virtual ReadResult next(Frame& frame) = 0;

  /// Goes back to the first frame and returns true, or returns false if this source cannot (a live device).
  virtual bool rewind() = 0;

  /// Goes to frame `index` (0 .. frame_count() - 1) without reading those between, so that next() delivers
  /// it, and returns true; or returns false, changing nothing, if this source can only go frame by frame.
  virtual bool seek(std::int64_t /*index*/) { return false; }

  /// Frames from first to last, bad ones included, where known beforehand.
  [[nodiscard]] virtual std::optional<std::int64_t> frame_count() const = 0;

  /// As the user named it, for messages and reports.
  [[nodiscard]] virtual std::string name() const = 0;
};

}  // namespace roomradar
