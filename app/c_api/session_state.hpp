// session_state.hpp: state of session and locator handles. Each session and each locator renders on its own
// thread.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/c_api/handles.hpp"
#include "app/c_api/roomradar_session.h"
#include "app/session/session.hpp"
#include "mapping/types/system/stage_times.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "radar/gl/gl_thread.hpp"

namespace roomradar::c_api {

struct SessionState : Handled {
  static constexpr const char* kKind = "session";
  std::shared_ptr<const MapState> shared_map;  ///< null if own_map is set
  std::optional<SavedMap> own_map;             ///< set if changes are committed, which modify its octree
  std::int32_t poses = ROOMRADAR_POSES_TRACKED;
  Frame frame;  ///< buffer
  StageTimes times;
  std::uint64_t located_frames = 0;
  PoseSigma sigma;                   ///< of the last frame's pose
  std::vector<std::string> notices;  ///< messages that the caller has not fetched
  std::uint64_t room_version = 1;
  std::uint64_t room_revision = 0;    ///< revision of the radar's tree when room_version last changed
  std::uint64_t blocks_revision = 0;  ///< room_revision for which `blocks` was made
  RoomBlocks blocks;
  CyberRadar radar;  ///< exact radar for the caller's queries
  std::unique_ptr<Session> session;
  GlThread thread;  ///< thread of all calls to the session; declared last, so that it is destroyed first

  ~SessionState();
  [[nodiscard]] const SavedMap& map() const { return own_map ? *own_map : shared_map->map; }
  /// Calls work(Session&) on the session's thread.
  template <typename Work>
  void run(const Work& work) {
    thread.run([&] { work(*session); });
  }
  /// Throws Refusal if there is no object of that name.
  [[nodiscard]] const VirtualObject& object(const char* name) const;
  /// Stores messages for roomradar_session_notices(), at most the newest 1,000.
  void keep(const std::vector<ObjectNotice>& sentences);
  /// Increments room_version if the session's room has changed.
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
  GlThread thread;

  ~LocatorState();
};

}  // namespace roomradar::c_api
