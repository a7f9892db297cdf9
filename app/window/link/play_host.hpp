// play_host.hpp: connects a session to the window. Waits until frames are due, delivers the user's events,
// and publishes results.
#pragma once
#include <cstdint>
#include <deque>
#include <future>
#include <string>
#include <utility>
#include <vector>

#include "app/session/script/script.hpp"
#include "app/session/session.hpp"
#include "app/sources/recordings/playback_source.hpp"
#include "app/window/link/player.hpp"
#include "app/window/link/snapshot.hpp"
#include "app/window/link/ui_channel.hpp"

namespace roomradar {

/// Used by the session's thread if the run has a window. The constructor's references must outlive the
/// object.
class PlayHost {
 public:
  /// @param is_live  true: frames are shown when they arrive. Only repeated frames wait for their timestamps
  PlayHost(UiChannel& link, const Session& session, const PlaybackSource& source, const StageTimes& times,
           ShownRoom room, bool is_live)
      : link_(link),
        session_(session),
        source_(source),
        times_(times),
        is_live_(is_live),
        maker_(std::move(room)) {}

  /// Waits until the frame is due or the user requests a single step. Returns false if the window is closed.
  bool wait_turn(const Frame& frame);
  [[nodiscard]] bool is_closed() const { return link_.is_closed(); }
  /// Returns the user's events since the last frame, with at most one AddObject. Meshes of added objects are
  /// read on another thread. The AddObject is returned when its mesh has been read. A mesh that is not
  /// suitable as an object is only reported in the window.
  std::vector<ScriptEvent> take_events();
  /// Returns the ObjectParts for the last AddObject that take_events() has returned.
  ObjectParts take_parts() { return std::move(new_.parts); }
  /// Sets the text on settings that the budget has reduced; empty: none.
  void say_given_up(std::string given_up) { given_up_ = std::move(given_up); }
  /// Tells the user that an event could not be applied.
  void complain(const std::string& fault) { link_.say(fault); }
  void show(std::int64_t run_frame, double run_time_s, const Frame& frame, const FrameResult& result);

 private:
  /// Objects that the user adds; another thread prepares them.
  struct NewObjects {
    std::deque<AddNew> waiting{};  ///< requests; the first one is being prepared
    std::future<ObjectParts> readying{};
    int frames_waited = 0;  ///< frames since the first request's preparation began
    ObjectParts parts{};    ///< data of the last object that became ready
  };
  /// The frame that was published last.
  struct ShownFrame {
    std::int64_t run_frame = -1;
    std::int64_t source_frame = 0;
    double run_time_s = 0.0;
    FrameResult result{};
  };

  UiChannel& link_;
  const Session& session_;
  const PlaybackSource& source_;
  const StageTimes& times_;
  bool is_live_;
  Player player_;
  NewObjects new_;
  SnapshotMaker maker_;
  Snapshot filled_;
  ShownFrame shown_;
  std::string given_up_;
  std::string said_to_wait_;  ///< object whose waiting drop was last reported to the user

  /// Moves requests for new objects from `commands` to new_.waiting, and back to `commands` once the object
  /// is ready.
  void ready_new_objects(std::vector<UserCommand>& commands);
  void say_if_a_drop_waits();
  void publish();
};

}  // namespace roomradar
