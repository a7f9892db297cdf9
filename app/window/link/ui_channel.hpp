// ui_channel.hpp: thread-safe channel between the window's thread and the session's thread.
//
// The session runs on another thread, so the window stays responsive while a camera stalls or a frame takes
// long. The window never touches the session. It receives copies (Snapshot) and sends user commands
// (UserCommand), which the session's thread turns into events between two frames.
#pragma once
#include <Eigen/Geometry>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/session/script/script.hpp"
#include "app/session/session.hpp"
#include "app/sources/recordings/playback_source.hpp"
#include "radar/exact/radar_pictures.hpp"

namespace roomradar {

enum class UserCommandKind {
  kEvent,   ///< apply `event` as it is
  kDrop,    ///< drop the chosen object over the surface at the pixel
  kPlace,   ///< place the chosen object on the surface at the pixel
  kThrow,   ///< throw the chosen object from the camera towards the pixel
  kGrab,    ///< grab and choose the object at the pixel
  kDrag,    ///< carry the grabbed object to the pixel
  kLetGo,   ///< release the grabbed object; after a click on no object: drop the chosen object here
  kTurn,    ///< rotate the grabbed or else the chosen object by `event.turn_world_deg`
  kChoose,  ///< choose the object `event.name`
  kNew,     ///< add an object from `event.mesh` of size `event.size_m`, choose it and drop it in view
  kRemove,  ///< remove the chosen object
  kReset,   ///< remove all objects and drop the chosen one over a surface in view
};

struct UserCommand {
  UserCommandKind kind = UserCommandKind::kEvent;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();             ///< in the picture
  Eigen::Vector2d pixel_velocity_s = Eigen::Vector2d::Zero();  ///< velocity of the mouse, pixels per second
  bool was_dragged = false;                                    ///< for kLetGo
  double nearer_m = 0.0;   ///< kDrag, kLetGo: total motion towards the camera so far
  double speed_mps = 3.0;  ///< for kThrow
  ScriptEvent event;
};

/// Costly views, made only while they are visible, and the point under the mouse.
struct ViewsWanted {
  bool radar = false;                         ///< R, M and L
  bool models = false;                        ///< dynamic meshes
  std::optional<Eigen::Vector2d> point_px{};  ///< pixel of the picture under the mouse; unset: none
  friend bool operator==(const ViewsWanted&, const ViewsWanted&) = default;
};

struct ShownObject {
  std::string name;
  std::shared_ptr<const Mesh> mesh;  ///< same pointer as long as the mesh is the same
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  Eigen::AlignedBox3d box;  ///< in the object's frame
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();
  bool in_room = false;
  bool asleep = false;
  bool is_carried = false;
  bool stuck = false;
  SurfaceKind rests_on = SurfaceKind::kNothing;
};

/// A radar query for the chosen object, along its motion, or along gravity if it is slow.
struct ShownRadar {
  RadarPictures pictures;  ///< empty: no chosen object in the room, or not wanted
  Contact contact;         ///< the exact radar's result for the same query
  Eigen::Vector3d direction_world = Eigen::Vector3d::Zero();
};

/// State of the session after a frame.
struct Snapshot {
  std::int64_t run_frame = -1;
  std::int64_t source_frame = 0;
  double run_time_s = 0.0;
  FrameResult result;
  std::optional<ShownView> view;
  ColourImage picture;
  std::vector<std::pair<std::string, float>> stages_ms;  ///< of this frame: read, then the session's stages
  std::vector<ShownObject> objects;
  std::string chosen;
  SurfacePolicy surfaces = SurfacePolicy::kMap;
  bool unknown_is_solid = false;
  RadarConfig radar;
  std::string given_up;  ///< settings reduced by --budget-ms; empty: none
  bool is_held = false;
  bool is_repeating = false;  ///< the frame is a repetition: source held, or at its end
  AtEnd at_end = AtEnd::kEnd;
  std::shared_ptr<const Mesh> room;
  Mesh seen_world, inferred_world;  ///< dynamic foreground
  ShownRadar shown_radar;
  std::optional<Eigen::Vector3d> pointed_world;  ///< surface point at ViewsWanted::point_px; unset: none
};

/// Connects one window and one session. Thread safe.
class UiChannel {
 public:
  /// @param wake  called on the session's thread when there is something new to show
  explicit UiChannel(std::function<void()> wake = [] {}) : wake_(std::move(wake)) {}

  // For the window's thread.
  void ask(UserCommand command);
  void set_paused(bool is_paused);
  [[nodiscard]] bool is_paused() const;
  /// Lets one frame through while paused.
  void step();
  /// Sets the speed relative to the source's, > 0.
  void set_speed(double speed);
  void want(const ViewsWanted& views);
  /// Swaps the newest snapshot into `shown`; returns false if none is newer than the last one taken.
  bool take(Snapshot& shown);
  /// Returns the newest message for the user since the last call, or an empty string.
  std::string take_message();
  void close();
  [[nodiscard]] bool is_over() const;

  // For the session's thread.
  /// Waits while paused and, if in_time, until the time of this stamp. While waiting, calls `refresh` when
  /// the wanted views change. Returns false once the window is closed.
  bool wait_turn(double stamp_s, bool in_time, const std::function<void()>& refresh);
  [[nodiscard]] bool is_closed() const;
  /// Returns true if the window was paused since the last call.
  bool take_pause();
  std::vector<UserCommand> take_commands();
  [[nodiscard]] ViewsWanted wanted() const;
  /// Swaps `filled` with a snapshot whose allocations can be reused.
  void publish(Snapshot& filled);
  void say(std::string message);
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  std::function<void()> wake_;
  mutable std::mutex mutex_;  ///< guards everything below
  std::condition_variable changed_;
  std::vector<UserCommand> commands_;
  Snapshot newest_;
  bool is_fresh_ = false;
  bool is_paused_ = false, is_closed_ = false, is_over_ = false;
  bool was_paused_ = false;  ///< paused since the last take_pause()
  int steps_ = 0;
  double speed_ = 1.0;
  ViewsWanted wanted_;
  bool wants_changed_ = false;
  std::string message_;
  std::optional<std::pair<double, Clock::time_point>> last_turn_;  ///< stamp of the last frame, and the time
                                                                   ///< when it was due
};

}  // namespace roomradar
