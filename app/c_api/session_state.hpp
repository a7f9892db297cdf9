// session_state.hpp: the objects behind handles of sessions and locators, which draw on a thread of their
// own.
#pragma once
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/c_api/handles.hpp"
#include "app/c_api/roomradar_session.h"
#include "app/session/session.hpp"
#include "mapping/types/system/stage_times.hpp"
#include "radar/exact/cyber_radar.hpp"

namespace roomradar::c_api {

/// Owns a thread that sleeps between calls of run(), for an OpenGL context that lives on it. The callers' own
/// contexts (an engine's) are never touched. run() may be called from any thread, by one at a time.
class SessionThread {
 public:
  SessionThread();
  ~SessionThread();
  SessionThread(const SessionThread&) = delete;
  SessionThread& operator=(const SessionThread&) = delete;

  /// Calls work() on the thread, waits for it, and rethrows its exception.
  template <typename Work>
  void run(const Work& work) {
    run_and_wait([](const void* task) { (*static_cast<const Work*>(task))(); }, &work);
  }

 private:
  using Call = void (*)(const void*);
  std::mutex mutex_;
  std::condition_variable changed_;
  Call call_ = nullptr;  ///< null: nothing to do
  const void* task_ = nullptr;
  bool is_done_ = false, stops_ = false;
  std::exception_ptr fault_;
  std::thread thread_;  ///< declared last because it uses the members above

  void run_and_wait(Call call, const void* task);
  void serve();
};

struct SessionState : Handled {
  static constexpr const char* kKind = "session";
  std::shared_ptr<const MapState> shared_map;  ///< null if own_map is set
  std::optional<SavedMap> own_map;             ///< set if changes are adopted, which modify its octree
  std::int32_t poses = ROOMRADAR_POSES_TRACKED;
  Frame frame;  ///< buffer
  StageTimes times;
  std::uint64_t located_frames = 0;
  std::vector<std::string> notices;  ///< not taken so far
  std::uint64_t room_version = 1;
  std::uint64_t room_revision = 0;    ///< of the radar's tree at room_version
  std::uint64_t blocks_revision = 0;  ///< the same, at `blocks`
  RoomBlocks blocks;
  CyberRadar radar;  ///< exact; of queries from outside
  std::unique_ptr<Session> session;
  SessionThread thread;  ///< on which the session lives; declared last, so that it ends first

  ~SessionState();
  [[nodiscard]] const SavedMap& map() const { return own_map ? *own_map : shared_map->map; }
  /// Calls work(Session&) on the session's thread.
  template <typename Work>
  void run(const Work& work) {
    thread.run([&] { work(*session); });
  }
  /// Returns the object. Throws Refusal if there is none of that name.
  [[nodiscard]] const VirtualObject& object(const char* name) const;
  /// Keeps sentences for roomradar_session_notices(), at most the newest 1,000.
  void keep(const std::vector<ObjectNotice>& sentences);
  /// Raises room_version if the session's room is another than before.
  void look_for_new_room();
};

struct LocatorState : Handled {
  static constexpr const char* kKind = "locator";
  std::shared_ptr<const MapState> map;
  struct Rendered {
    GlContext context;
    Shape room;
    FrameScene scene;
    explicit Rendered(const Mesh& mesh);
  };
  std::unique_ptr<Rendered> rendered;
  Locator locator;
  Frame frame;  ///< buffer
  SessionThread thread;

  ~LocatorState();
};

}  // namespace roomradar::c_api
