// playback_source.hpp: holds, rewinds and repeats a frame source, with stamps that always advance.
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
  kEnd,   ///< the source ends
  kStay,  ///< the last frame is repeated
  kLoop,  ///< the source starts over; if it cannot rewind, as kStay
};

constexpr std::string_view to_string(AtEnd at_end) {
  return at_end == AtEnd::kEnd ? "end" : at_end == AtEnd::kStay ? "stay" : "loop";
}

/// Passes on the frames of an inner source, with hold, repeat and rewind. Stamps always advance, since
/// callers move objects by them: a repeated frame, and the first frame after a rewind, a hold or a pause, is
/// 1/30 s later than the frame delivered before it. After a hold, stamps advance by more if the source's own
/// clock did. Index and pose remain the source's.
class PlaybackSource final : public FrameSource {
 public:
  PlaybackSource(std::unique_ptr<FrameSource> source, AtEnd at_end);

  /// `frame` must be unchanged since the last call: a held frame is not copied.
  ReadResult next(Frame& frame) override;
  bool rewind() override;
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override;
  [[nodiscard]] std::string name() const override { return source_->name(); }

  /// Takes effect with the next call of next(): true repeats the last frame, false continues.
  void hold(bool is_held) { is_held_ = is_held; }
  void set_at_end(AtEnd at_end) { at_end_ = at_end; }
  /// Call after a pause in reading: time stood still meanwhile, except on a device's clock.
  void resume() {
    frames_to_rebase_ = 2;  // one frame may have been read ahead before the pause
    old_ = kOld;
    least_offset_s_ = -std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] bool is_held() const { return is_held_; }
  [[nodiscard]] AtEnd at_end() const { return at_end_; }
  /// True if the last frame was a repetition: held, or past the end.
  [[nodiscard]] bool is_repeating() const { return is_repeating_; }
  /// True if the last frame had been delivered before: repeated, or after a rewind.
  [[nodiscard]] bool is_again() const { return is_again_; }

 private:
  static constexpr int kOld = 4;  // frames: a run reads one ahead, a session's spool two, and one is new

  std::unique_ptr<FrameSource> source_;
  AtEnd at_end_;
  bool is_held_ = false;
  bool is_repeating_ = false;
  bool is_again_ = false;
  std::int64_t newest_index_ = -1;      ///< greatest index delivered
  std::optional<double> last_stamp_s_;  ///< as delivered
  int frames_to_rebase_ =
      0;  ///< number of coming frames whose source stamps do not continue the previous ones
  bool was_repeated_ = false;    ///< the last frame delivered was a repetition
  int old_ = 0;                  ///< number of coming frames that may predate a pause, hold or rewind
  double stamp_offset_s_ = 0.0;  ///< added to the source's stamps
  double least_offset_s_ = 0.0;  ///< offset before the last hold or rewind; -infinity after a pause

  ReadResult repeat(Frame& frame);
  void follow(double stamp_s, bool is_new_after_rewind);
};

}  // namespace roomradar
