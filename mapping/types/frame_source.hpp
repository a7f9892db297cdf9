// frame_source.hpp: interface of recordings and live devices that deliver frames.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "mapping/types/frame.hpp"

namespace roomradar {

enum class ReadStatus {
  kFrame,    ///< `frame` was filled
  kSkipped,  ///< one bad frame was skipped, see `fault`; call next() again
  kWaiting,  ///< a live source had no new frame before its time-out; no frame was lost; call next() again
  kEnd,      ///< no more frames; `frame` is unchanged
};

struct [[nodiscard]] ReadResult {
  ReadStatus status = ReadStatus::kEnd;
  std::string fault;  ///< a sentence; only with kSkipped and kWaiting
};

/// Delivers frames in the order of their timestamps. Not thread safe.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  /// Fills `frame`, reusing its allocations. Returns kSkipped for a single unreadable frame; a recording may
  /// have any number of them. Throws Error if the source cannot continue (device gone or silent).
  virtual ReadResult next(Frame& frame) = 0;

  /// Goes back to the first frame and returns true. Returns false if the source cannot rewind (a live
  /// device).
  virtual bool rewind() = 0;

  /// Seeks to frame `index` (0 .. frame_count() - 1), without reading the frames between. next() then
  /// delivers this frame. Returns false and changes nothing if this source only reads sequentially.
  virtual bool seek(std::int64_t /*index*/) { return false; }

  /// Returns the total number of frames, unreadable ones included; nullopt if unknown in advance.
  [[nodiscard]] virtual std::optional<std::int64_t> frame_count() const = 0;

  /// Returns the source's name as the user gave it, for messages and reports.
  [[nodiscard]] virtual std::string name() const = 0;
};

/// Base of sources that change or select the frames of another source. Passes on all calls but next().
class WrappedSource : public FrameSource {
 public:
  bool rewind() override { return source_.rewind(); }
  bool seek(std::int64_t index) override { return source_.seek(index); }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return source_.frame_count(); }
  [[nodiscard]] std::string name() const override { return source_.name(); }

 protected:
  /// @param source  must outlive this object
  explicit WrappedSource(FrameSource& source) : source_(source) {}
  explicit WrappedSource(std::unique_ptr<FrameSource> source) : owned_(std::move(source)), source_(*owned_) {}

 private:
  std::unique_ptr<FrameSource> owned_;  ///< null: the source belongs to the caller

 protected:
  FrameSource& source_;
};

}  // namespace roomradar
