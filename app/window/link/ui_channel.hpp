// ui_channel.hpp: thread-safe channel between the window's thread and the session's thread.
//
// The session runs on another thread. The window thus remains responsive while a camera stalls or a frame
// takes long. The window does not access the session. It receives copies of the session's state (Snapshot)
// and sends user commands (UserCommand). The session's thread converts the commands into events between two
// frames.
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
#include <variant>
#include <vector>

#include "app/session/script/script.hpp"
#include "app/session/session.hpp"
#include "app/sources/recordings/playback_source.hpp"
#include "radar/exact/radar_pictures.hpp"

namespace roomradar {

// User commands. Pixels are in the picture. The chosen object is the one that the user selected last.

/// Drops the chosen object above the surface at the pixel.
struct DropChosen {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double height_m = 0.3;  ///< DropObject::height_m
};

/// Places the chosen object on the surface at the pixel.
struct PlaceChosen {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

/// Throws the chosen object from the camera towards the pixel.
struct ThrowChosen {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double speed_mps = 3.0;
};

/// Grabs and chooses the object at the pixel.
struct GrabObject {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

/// Carries the grabbed object to the pixel.
struct DragGrabbed {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double nearer_m = 0.0;  ///< total motion towards the camera since GrabObject, by the mouse wheel
};

/// Releases the grabbed object. If no object was grabbed, drops the chosen object at the pixel.
struct LetGo {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Vector2d pixel_velocity_s = Eigen::Vector2d::Zero();  ///< velocity of the mouse, pixels per second
  bool was_dragged = false;                                    ///< the mouse was moved since GrabObject
  double nearer_m = 0.0;  ///< total motion towards the camera since GrabObject, by the mouse wheel
  double height_m = 0.3;  ///< DropObject::height_m, if no object was grabbed
};

/// Rotates the grabbed object, or the chosen one if none is grabbed.
struct TurnGrabbed {
  Eigen::Vector3d turn_world_deg = Eigen::Vector3d::Zero();  ///< rotation vector, axis times angle
};

/// Chooses an object.
struct ChooseObject {
  std::string name{};
};

/// Adds an object, chooses it and drops it in view.
struct AddNew {
  ObjectSource source{};
};

/// Removes the chosen object.
struct RemoveChosen {};

/// Removes all objects, then drops the chosen one above a surface in view.
struct ResetObjects {};

/// An Action is executed unchanged.
using UserCommand = std::variant<Action, DropChosen, PlaceChosen, ThrowChosen, GrabObject, DragGrabbed, LetGo,
                                 TurnGrabbed, ChooseObject, AddNew, RemoveChosen, ResetObjects>;

/// Expensive views that are computed only while they are visible, and the pixel under the mouse.
struct ViewsWanted {
  bool radar = false;   ///< Cyber Radar's images R, M and L
  bool models = false;  ///< meshes of dynamic surfaces
  /// Pixel of the picture under the mouse; unset: the mouse is elsewhere.
  std::optional<Eigen::Vector2d> point_px{};
  friend bool operator==(const ViewsWanted&, const ViewsWanted&) = default;
};

struct ShownObject {
  std::string name;
  std::shared_ptr<const Mesh> mesh;  ///< the pointer changes only if the mesh changes
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  Eigen::AlignedBox3d box;  ///< bounding box in the object's frame
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();
  bool in_room = false;
  bool asleep = false;
  bool is_carried = false;
  bool stuck = false;
  SurfaceKind rests_on = SurfaceKind::kNothing;
  double mass_kg = 0.0;
  Coefficients on_room;  ///< on surfaces of the room
};

/// A radar query for the chosen object along its velocity, or along gravity if it is slow.
struct ShownRadar {
  RadarPictures pictures;  ///< empty if the chosen object is not in the room, or ViewsWanted::radar is false
  Contact contact;         ///< result of the query by Cyber Radar in its exact mode
  Eigen::Vector3d direction_world = Eigen::Vector3d::Zero();
};

/// The room's surface in the world frame.
struct ShownRoom {
  Mesh mesh;
  std::vector<Eigen::Vector2f> texture_points{};  ///< one per vertex, (0, 0) top left; empty: no texture
  ColourImage texture{};
};

/// State of the session after a frame.
struct Snapshot {
  std::int64_t run_frame = -1;
  std::int64_t source_frame = 0;
  double run_time_s = 0.0;
  FrameResult result;
  std::optional<ShownView> view;
  ColourImage picture;
  /// Times in this frame of reading and of the session's stages.
  std::vector<std::pair<std::string, float>> stages_ms;
  std::vector<ShownObject> objects;
  std::string chosen;
  SurfacePolicy surfaces = SurfacePolicy::kMap;
  bool unknown_is_solid = false;
  RadarConfig radar;
  std::string given_up;  ///< text on settings reduced by --budget-ms; empty: none
  bool is_held = false;
  bool is_repeating = false;  ///< true: the frame is a repetition, since the source is held or has ended
  AtEnd at_end = AtEnd::kEnd;
  std::shared_ptr<const ShownRoom> room;  ///< the pointer changes only if the room changes
  /// Dynamic foreground: visible surface, and its inferred back sides.
  Mesh seen_world, inferred_world;
  ShownRadar shown_radar;
  /// Point of the visible surface at ViewsWanted::point_px; unset: none.
  std::optional<Eigen::Vector3d> pointed_world;
};

/// Connects one window and one session. Thread safe.
class UiChannel {
 public:
  /// @param wake  called on the session's thread after each new snapshot or message
  explicit UiChannel(std::function<void()> wake = [] {}) : wake_(std::move(wake)) {}

  // For the window's thread.
  void ask(UserCommand command);
  void set_paused(bool is_paused);
  [[nodiscard]] bool is_paused() const;
  /// Permits one more frame while paused.
  void step();
  /// Sets the playback speed, > 0; 1: speed of the source.
  void set_speed(double speed);
  void want(const ViewsWanted& views);
  /// Swaps the newest snapshot with `shown`. Returns false if there is no new snapshot since the last call.
  bool take(Snapshot& shown);
  /// Returns the newest message since the last call, or an empty string.
  std::string take_message();
  /// Requests scanning more of the room after the run.
  void ask_to_scan();
  [[nodiscard]] bool wants_to_scan() const;
  void close();
  [[nodiscard]] bool is_over() const;

  // For the session's thread.
  /// Waits while the window is paused. If in_time, also waits until the frame with this stamp is due. While
  /// waiting, calls `refresh` when the wanted views change. Returns false if the window is closed.
  bool wait_turn(double stamp_s, bool in_time, const std::function<void()>& refresh);
  [[nodiscard]] bool is_closed() const;
  /// Returns true if the window has been paused since the last call.
  bool take_pause();
  std::vector<UserCommand> take_commands();
  [[nodiscard]] ViewsWanted wanted() const;
  /// Publishes `filled`, and swaps it with an old snapshot whose memory can be reused.
  void publish(Snapshot& filled);
  void say(std::string message);
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  std::function<void()> wake_;
  mutable std::mutex mutex_;  ///< guards the members below
  std::condition_variable changed_;
  std::vector<UserCommand> commands_;
  Snapshot newest_;
  bool is_fresh_ = false;
  bool is_paused_ = false, is_closed_ = false, is_over_ = false;
  bool wants_to_scan_ = false;
  bool was_paused_ = false;  ///< the window has been paused since the last take_pause()
  int steps_ = 0;
  double speed_ = 1.0;
  ViewsWanted wanted_;
  bool wants_changed_ = false;
  std::string message_;
  /// Stamp of the last frame, and the time at which the frame was due.
  std::optional<std::pair<double, Clock::time_point>> last_turn_;
};

}  // namespace roomradar
