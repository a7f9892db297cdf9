// play_host.hpp: the session's side of a window: waits for the user's turn, gives events, shows results.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "app/script.hpp"
#include "app/session.hpp"
#include "app/sources/playback_source.hpp"
#include "app/window/play_link.hpp"
#include "app/window/player.hpp"
#include "app/window/snapshot.hpp"

namespace roomradar {

/// All of a run that only a window needs. Session, source and times must outlive it.
class PlayHost {
 public:
  /// @param is_live  frames come when they come; nothing waits for their stamps
  PlayHost(PlayLink& link, const Session& session, const PlaybackSource& source, const StageTimes& times,
           const Mesh& room, const std::string& object, bool is_live)
      : link_(link),
        session_(session),
        source_(source),
        times_(times),
        is_live_(is_live),
        player_(object),
        maker_(room) {}

  /// Waits until the frame is due, or the user steps to it; false once the window was closed.
  bool wait_turn(const Frame& frame);
  [[nodiscard]] bool is_closed() const { return link_.is_closed(); }
  /// What the user did since the last frame.
  std::vector<ScriptEvent> take_events();
  /// What the budget gives up now; empty: nothing.
  void say_given_up(std::string given_up) { given_up_ = std::move(given_up); }
  /// An event of the user's could not be applied.
  void complain(const std::string& fault) { link_.say(fault); }
  void show(std::int64_t run_frame, double run_time_s, const Frame& frame, const FrameResult& result);

 private:
  PlayLink& link_;
  const Session& session_;
  const PlaybackSource& source_;
  const StageTimes& times_;
  bool is_live_;
  Player player_;
  SnapshotMaker maker_;
  Snapshot filled_;
  std::int64_t run_frame_ = -1;  ///< of the newest that was shown
  std::int64_t source_frame_ = 0;
  double run_time_s_ = 0.0;
  FrameResult result_;
  std::string given_up_;

  void publish();
};

}  // namespace roomradar
