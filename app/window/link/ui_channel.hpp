// ui_channel.hpp: what the thread that draws the window and the thread that runs the session say to each
// other.
//
// The session runs on a thread of its own, so that the window answers while a camera stalls or a frame takes
// long. Nothing of the session is touched by the window: it gets copies (Snapshot), and says what the user
// wants (UserCommand), which the session's thread turns into events between two frames.
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

#include "app/session/script.hpp"
#include "app/session/session.hpp"
#include "app/sources/recordings/playback_source.hpp"
#include "radar/exact/radar_pictures.hpp"

namespace roomradar {

enum class UserCommandKind {
  kEvent,   ///< `event`, as it is
  kDrop,    ///< the chosen object, over what is at the pixel
  kPlace,   ///< the chosen object, onto what is at the pixel
  kThrow,   ///< the chosen object, from the camera towards the pixel
  kGrab,    ///< whatever object is at the pixel; it is chosen
  kDrag,    ///< what was grabbed, to the pixel
  kLetGo,   ///< what was grabbed; nothing grabbed and not dragged: drop the chosen object there
  kTurn,    ///< what was grabbed or else the chosen object, by `event.turn_world_deg`
  kChoose,  ///< object `event.name`
  kNew,     ///< add an object of mesh `event.mesh` and size `event.size_m`, choose it and drop it in view
  kRemove,  ///< the chosen object
  kReset,   ///< all objects out of the room, the chosen one over a surface in view
};

struct UserCommand {
  UserCommandKind kind = UserCommandKind::kEvent;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();             ///< of the picture
  Eigen::Vector2d pixel_velocity_s = Eigen::Vector2d::Zero();  ///< of the mouse, pixels a second
  bool was_dragged = false;                                    ///< kLetGo
  double nearer_m = 0.0;                                       ///< kDrag: towards the camera, added up
  double speed_mps = 3.0;                                      ///< kThrow
  ScriptEvent event;
};

/// Views that cost time, and are made only while they are seen.
struct ViewsWanted {
  bool radar = false;   ///< R, M and L
  bool models = false;  ///< meshes of what moved
  friend bool operator==(const ViewsWanted&, const ViewsWanted&) = default;
};

struct ShownObject {
  std::string name;
  std::shared_ptr<const Mesh> mesh;  ///< the same pointer while it is the same mesh
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  Eigen::AlignedBox3d box;  ///< in its own frame
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();
  bool in_room = false;
  bool asleep = false;
  bool is_carried = false;
  SurfaceKind rests_on = SurfaceKind::kNothing;
};

/// One query of the radar for the chosen object: along its motion, or along gravity while it stands.
struct ShownRadar {
  RadarPictures pictures;  ///< empty: no object is chosen and in the room, or they are not wanted
  Contact contact;         ///< the exact radar's answer to the same question
  Eigen::Vector3d direction_world = Eigen::Vector3d::Zero();
};

/// The session after a frame.
struct Snapshot {
  std::int64_t run_frame = -1;
  std::int64_t source_frame = 0;
  double run_time_s = 0.0;
  FrameResult result;
  std::optional<Session::ShownView> view;
  ColourImage picture;
  std::vector<std::pair<std::string, float>> stages_ms;  ///< of this frame: read, then the session's
  std::vector<ShownObject> objects;
  std::string chosen;
  SurfacePolicy surfaces = SurfacePolicy::kMap;
  bool unknown_is_solid = false;
  RadarConfig radar;
  std::string given_up;  ///< for --budget-ms; empty: nothing
  bool is_held = false;
  bool is_repeating = false;  ///< the source is held or at its end
  AtEnd at_end = AtEnd::kEnd;
  std::shared_ptr<const Mesh> room;
  Mesh seen_world, inferred_world;  ///< what moved
  ShownRadar shown_radar;
};

/// Thread safe; one window, one session.
class UiChannel {
 public:
  /// @param wake  called on the session's thread when there is something new to show
  explicit UiChannel(std::function<void()> wake = [] {}) : wake_(std::move(wake)) {}

  // The window's side.
  void ask(UserCommand command);
  void set_paused(bool is_paused);
  [[nodiscard]] bool is_paused() const;
  /// One frame more while it is paused.
  void step();
  /// Times the source's own, > 0.
  void set_speed(double speed);
  void want(const ViewsWanted& views);
  /// Swaps the newest snapshot into `shown`; false if there is no newer one than that taken last.
  bool take(Snapshot& shown);
  /// The newest sentence for the user since the last call, or nothing.
  std::string take_message();
  void close();
  [[nodiscard]] bool is_over() const;

  // The session's side.
  /// Waits until the frame of that stamp is due: while paused, and in time with the stamps. Meanwhile
  /// `refresh` is called when other views are wanted. Returns false once the window was closed.
  bool wait_turn(double stamp_s, bool in_time, const std::function<void()>& refresh);
  [[nodiscard]] bool is_closed() const;
  /// Whether it was paused since the last call.
  bool take_pause();
  std::vector<UserCommand> take_commands();
  [[nodiscard]] ViewsWanted wanted() const;
  /// Swaps `filled` with a snapshot whose allocations can be used again.
  void publish(Snapshot& filled);
  void say(std::string message);
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  std::function<void()> wake_;
  mutable std::mutex mutex_;  ///< of all below
  std::condition_variable changed_;
  std::vector<UserCommand> commands_;
  Snapshot newest_;
  bool is_fresh_ = false;
  bool is_paused_ = false, is_closed_ = false, is_over_ = false;
  bool was_paused_ = false;  ///< since take_pause()
  int steps_ = 0;
  double speed_ = 1.0;
  ViewsWanted wanted_;
  bool wants_changed_ = false;
  std::string message_;
  std::optional<std::pair<double, Clock::time_point>> last_turn_;  ///< stamp and when it was
};

}  // namespace roomradar
