// playback_source.hpp: pauses, rewinds and repeats a frame source. Stamps always increase.
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Behaviour after a source's last frame.
enum class AtEnd {
  /// The source ends.
  kEnd,
  /// The last frame is repeated.
  kStay,
  /// The source is rewound. If it cannot rewind, the last frame is repeated.
  kLoop,
};

constexpr std::string_view to_string(AtEnd at_end) {
  return at_end == AtEnd::kEnd ? "end" : at_end == AtEnd::kStay ? "stay" : "loop";
}

/// Delivers the frames of an inner source, and can hold (repeat the last frame), rewind and loop. Stamps
/// always increase, since callers simulate physics with them. A repeated frame, and the first frame after a
/// rewind, a hold or a pause, have a stamp 1/30 s after the previous frame's. After a hold, the stamp is
/// later if more time has passed on the source's clock. Index and pose are those of the inner source.
class PlaybackSource final : public FrameSource {
 public:
  PlaybackSource(std::unique_ptr<FrameSource> source, AtEnd at_end);

  /// Delivers the next frame. A repeated frame is not copied, so `frame` must still contain the result of the
  /// previous call.
  ReadResult next(Frame& frame) override;
  bool rewind() override;
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override;
  [[nodiscard]] std::string name() const override { return source_->name(); }

  /// Sets whether the source is held, from the next call of next() on. True: next() repeats the last frame.
  /// False: next() delivers the frames that follow.
  void hold(bool is_held) { is_held_ = is_held; }
  /// Sets the behaviour after the last frame.
  void set_at_end(AtEnd at_end) { at_end_ = at_end; }
  /// Call after a pause, that is, a time in which next() was not called. The next stamp is then 1/30 s after
  /// the previous one, although a device's clock continued during the pause.
  void resume() {
    // One frame may have been read ahead before the pause.
    frames_to_rebase_ = 2;
    old_ = kOld;
    least_offset_s_ = -std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] bool is_held() const { return is_held_; }
  [[nodiscard]] AtEnd at_end() const { return at_end_; }
  /// Returns true if the last frame was a repetition, because the source is held or has ended.
  [[nodiscard]] bool is_repeating() const { return is_repeating_; }
  /// Returns true if the last frame had been delivered before, because of a repetition or a rewind.
  [[nodiscard]] bool is_again() const { return is_again_; }

 private:
  // Number of frames that may have been read before a pause. A run reads one ahead, a session's spool two,
  // and one is new.
  static constexpr int kOld = 4;

  std::unique_ptr<FrameSource> source_;
  AtEnd at_end_;
  bool is_held_ = false;
  bool is_repeating_ = false;
  bool is_again_ = false;
  /// Max index delivered.
  std::int64_t newest_index_ = -1;
  /// Stamp of the last frame delivered.
  std::optional<double> last_stamp_s_;
  /// Number of next frames whose source stamps do not continue the previous stamps.
  int frames_to_rebase_ = 0;
  /// True if the last frame delivered was a repetition.
  bool was_repeated_ = false;
  /// Number of next frames that may have been read before a pause, hold or rewind.
  int old_ = 0;
  /// Offset added to the source's stamps.
  double stamp_offset_s_ = 0.0;
  /// stamp_offset_s_ before the last hold or rewind; -infinity after a pause.
  double least_offset_s_ = 0.0;

  ReadResult repeat(Frame& frame);
  void follow(double stamp_s, bool is_new_after_rewind);
};

}  // namespace roomradar
