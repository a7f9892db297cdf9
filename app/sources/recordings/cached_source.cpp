// cached_source.cpp: writes each frame to disk when it is first delivered.
#include "app/sources/recordings/cached_source.hpp"

#include <future>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "app/sources/formats/scratch_folder.hpp"
#include "app/sources/recordings/spool_list.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

std::uintmax_t bytes_of(const Frame& frame) {
  return frame.depth_m.pixels.size() * sizeof(float) + frame.colour.pixels.size() * sizeof(Rgb);
}

class CachedSource final : public WrappedSource {
 public:
  CachedSource(std::unique_ptr<FrameSource> source, ScratchFolder folder, std::uintmax_t max_bytes)
      : WrappedSource(std::move(source)), bytes_left_(max_bytes), folder_(std::move(folder)) {}

  ReadResult next(Frame& frame) override {
    if (read_cached(frame)) {
      ++position_;
      return {ReadStatus::kFrame, {}};
    }
    if (source_position_ != position_ && !source_.seek(position_)) return {ReadStatus::kEnd, {}};
    const ReadResult result = source_.next(frame);
    if (result.status == ReadStatus::kFrame) keep(frame);
    if (result.status != ReadStatus::kEnd) ++position_;
    source_position_ = position_;
    return result;
  }

  bool rewind() override {
    position_ = 0;
    return true;
  }

  bool seek(std::int64_t index) override {
    if (index < 0 || index >= source_.frame_count().value_or(0)) return false;
    position_ = index;
    return true;
  }

 private:
  /// Returns false if the frame is not cached.
  bool read_cached(Frame& frame) {
    if (written_position_ == position_) finish_write();
    const auto cached = entries_.find(position_);
    if (cached == entries_.end()) return false;
    try {
      const auto position = static_cast<std::size_t>(position_);
      return read_spooled(cached->second, folder_.path(), position, frame).status == ReadStatus::kFrame;
    } catch (const Error&) {  // the temporary folder was cleared, or the disk is faulty
      entries_.erase(cached);
      return false;
    }
  }

  /// Writes a copy of the frame on another thread.
  void keep(const Frame& frame) {
    finish_write();
    if (bytes_of(frame) > bytes_left_) return;
    bytes_left_ -= bytes_of(frame);
    written_ = frame;
    written_position_ = position_;
    write_ = std::async(std::launch::async, [this] {
      return write_spooled(written_, folder_.path(), static_cast<std::size_t>(written_position_));
    });
  }

  void finish_write() {
    if (!write_.valid()) return;
    try {
      entries_.emplace(written_position_, write_.get());
    } catch (const Error&) {  // a full disk costs time only
      bytes_left_ = 0;
    }
  }

  std::uintmax_t bytes_left_;
  ScratchFolder folder_;
  std::unordered_map<std::int64_t, SpoolEntry> entries_;  ///< by position
  std::int64_t position_ = 0;                             ///< of the frame that next() delivers
  std::int64_t source_position_ = 0;                      ///< of the frame that source_.next() delivers
  Frame written_;
  std::int64_t written_position_ = -1;
  std::future<SpoolEntry> write_;  ///< last member: its destructor waits for the write
};

}  // namespace

std::unique_ptr<FrameSource> cache_frames(std::unique_ptr<FrameSource> source, std::uintmax_t max_bytes) {
  if (!source->frame_count() || !source->seek(0)) return source;
  std::optional<ScratchFolder> folder;
  try {
    folder.emplace();
  } catch (const Error&) {
    return source;
  }
  return std::make_unique<CachedSource>(std::move(source), std::move(*folder), max_bytes);
}

}  // namespace roomradar
