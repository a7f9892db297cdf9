// play_host.hpp: the session's side of a window: waits for the user's turn, gives events, shows results.
#pragma once
#include <cstdint>
#include <deque>
#include <future>
#include <string>
#include <utility>
#include <vector>

#include "app/session/script.hpp"
#include "app/session/session.hpp"
#include "app/sources/recordings/playback_source.hpp"
#include "app/window/link/player.hpp"
#include "app/window/link/snapshot.hpp"
#include "app/window/link/ui_channel.hpp"

namespace roomradar {

/// All of a run that only a window needs. Session, source and times must outlive it.
class PlayHost {
 public:
  /// @param is_live  frames come when they come, and nothing waits for their stamps but where they come again
  PlayHost(UiChannel& link, const Session& session, const PlaybackSource& source, const StageTimes& times,
           const Mesh& room, bool is_live)
      : link_(link), session_(session), source_(source), times_(times), is_live_(is_live), maker_(room) {}

  /// Waits until the frame is due, or the user steps to it; false once the window was closed.
  bool wait_turn(const Frame& frame);
  [[nodiscard]] bool is_closed() const { return link_.is_closed(); }
  /// What the user did since the last frame. A new object comes once its mesh was read and made ready, which
  /// happens beside the frames; one whose mesh cannot be an object is complained of. At most one add a frame.
  std::vector<ScriptEvent> take_events();
  /// Of the object that the add among the events taken last is of.
  ObjectParts take_parts() { return std::move(parts_); }
  /// What the budget gives up now; empty: nothing.
  void say_given_up(std::string given_up) { given_up_ = std::move(given_up); }
  /// An event of the user's could not be applied.
  void complain(const std::string& fault) { link_.say(fault); }
  void show(std::int64_t run_frame, double run_time_s, const Frame& frame, const FrameResult& result);

 private:
  UiChannel& link_;
  const Session& session_;
  const PlaybackSource& source_;
  const StageTimes& times_;
  bool is_live_;
  Player player_;
  std::deque<UserCommand> new_objects_;  ///< to come; the first is being made ready
  std::future<ObjectParts> readying_;
  int frames_waited_ = 0;  ///< for it
  ObjectParts parts_;
  SnapshotMaker maker_;
  Snapshot filled_;
  std::int64_t run_frame_ = -1;  ///< of the newest that was shown
  std::int64_t source_frame_ = 0;
  double run_time_s_ = 0.0;
  FrameResult result_;
  std::string given_up_;
  std::string said_to_wait_;  ///< object whose drop waits, since that was said

  /// Moves what adds an object out of the wishes, and those whose object is ready back in.
  void ready_new_objects(std::vector<UserCommand>& commands);
  void say_if_a_drop_waits();
  void publish();
};

}  // namespace roomradar
