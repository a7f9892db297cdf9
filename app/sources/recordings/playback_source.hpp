// playback_source.hpp: a source that can be held, wound back and repeated, with stamps that always go on.
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// What follows a source's last frame.
enum class AtEnd {
  kEnd,   ///< nothing
  kStay,  ///< the last frame again and again
  kLoop,  ///< the first; of a source that cannot rewind, the last as with kStay
};

constexpr std::string_view to_string(AtEnd at_end) {
  return at_end == AtEnd::kEnd ? "end" : at_end == AtEnd::kStay ? "stay" : "loop";
}

/// Passes the frames of the source within on. A frame that is repeated, or follows a rewind, is 1/30 s later
/// than the one before, so that time goes on for whoever moves objects by it, and so is what follows repeated
/// frames, unless the source's own clock went on by more meanwhile, and what follows a pause; index and pose
/// stay the source's.
class PlaybackSource final : public FrameSource {
 public:
  PlaybackSource(std::unique_ptr<FrameSource> source, AtEnd at_end);

  /// `frame` must be as the last call left it: a held frame is not copied.
  ReadResult next(Frame& frame) override;
  bool rewind() override;
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override;
  [[nodiscard]] std::string name() const override { return source_->name(); }

  /// From the next call on: the last frame is repeated, or not any more.
  void hold(bool is_held) { is_held_ = is_held; }
  void set_at_end(AtEnd at_end) { at_end_ = at_end; }
  /// Nobody has read for a while and time stood still, but for the clock of a device.
  void resume() {
    anew_ = 2;  // one frame may have been read ahead before the pause
    old_ = kOld;
    least_offset_s_ = -std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] bool is_held() const { return is_held_; }
  [[nodiscard]] AtEnd at_end() const { return at_end_; }
  /// Whether the last frame was not a new one: held, or past the end.
  [[nodiscard]] bool is_repeating() const { return is_repeating_; }
  /// Whether the last frame had been passed on before: repeated, or after a rewind.
  [[nodiscard]] bool is_again() const { return is_again_; }

 private:
  static constexpr int kOld = 4;  // frames: a run reads one ahead, the spool of a session two, and one is new

  std::unique_ptr<FrameSource> source_;
  AtEnd at_end_;
  bool is_held_ = false;
  bool is_repeating_ = false;
  bool is_again_ = false;
  std::int64_t newest_index_ = -1;      ///< of all that were passed on
  std::optional<double> last_stamp_s_;  ///< as it was passed on
  int anew_ = 0;                        ///< of so many frames the stamp does not follow on the last one's
  bool was_repeated_ = false;           ///< the last frame was passed on once more
  int old_ = 0;                         ///< so many frames may be of before a pause, a hold or a rewind
  double stamp_offset_s_ = 0.0;         ///< added to the source's own
  double least_offset_s_ = 0.0;         ///< as it was before that

  ReadResult repeat(Frame& frame);
  void follow(double stamp_s, bool is_new_after_rewind);
};

}  // namespace roomradar
