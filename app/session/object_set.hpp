// object_set.hpp: the virtual objects of a session, with functions to place, drop, carry and simulate them.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/objects/departure.hpp"
#include "app/objects/object_notice.hpp"
#include "app/objects/virtual_object.hpp"
#include "app/physics/contact_system.hpp"
#include "app/physics/physics_config.hpp"
#include "app/session/frame_scene.hpp"
#include "app/session/object_overlap.hpp"
#include "app/session/session_config.hpp"
#include "app/session/session_room.hpp"
#include "dynamic/surface/dynamic_surface.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/system/stage_times.hpp"
#include "radar/batch/passes_radar.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "radar/geometry/radar_scene.hpp"
#include "radar/motion/proximity.hpp"

namespace roomradar {

/// Initial state of an object that is put into the room.
struct ObjectState {
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();      ///< position of the object's origin
  std::optional<Eigen::Matrix3d> R_world_object{};               ///< unset: the object keeps its orientation
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();  ///< velocity of the centre of mass
  Eigen::Vector3d angular_velocity_world_rad_s = Eigen::Vector3d::Zero();
};

/// Contacts of one frame.
struct ContactCounts {
  int contacts = 0;
  std::array<int, kSurfaceKinds> by_kind{};  ///< contacts per kind of surface touched
};

/// Returns true if config.move_every_n_frames and config.picture_every_n_frames let the object with this
/// index be advanced in this frame.
bool is_turn_to_move(std::size_t index, std::int64_t frame_number, const SessionConfig& config);

/// Returns one ball around each object in the room. Inside the balls, the dynamic mesh gets full resolution.
std::vector<FineRegion> fine_regions(std::span<const std::unique_ptr<VirtualObject>> objects);

/// Sets VirtualObject::fine_cells of all objects. Objects without a region get 0.
/// @param cells_of_region  number of cells per region, in the order of fine_regions()
void set_fine_cells(std::span<const std::unique_ptr<VirtualObject>> objects,
                    std::span<const std::uint32_t> cells_of_region);

/// Rotates an object about the centre of its bounding box and wakes it. The rotation stops early at the first
/// contact with a surface of the scene. Does nothing if the radar returns no usable result.
/// @param turn_world_deg  rotation vector (axis times angle) in world axes, degrees
void turn_until_contact(VirtualObject& object, const Eigen::Vector3d& turn_world_deg,
                        std::span<const SceneTree> scene, CyberRadar& radar);

/// Reduced height of a drop onto a surface in view, used if the object would topple or roll away when dropped
/// from the requested height.
inline constexpr double kGentleDrop_m = 0.05;

/// Request to drop an object from above a given position or from above a level surface in view.
struct DropRequest {
  std::string name{};
  std::optional<Eigen::Vector3d> position_world{};  ///< unset: above a level surface in view
  /// Without position_world: the free level place nearest to this point, at most 25 cm away, is taken. Unset:
  /// the one nearest to the image centre.
  std::optional<Eigen::Vector3d> near_world{};
  /// Initial height of the object's lowest vertex above the position or surface. Without position_world, the
  /// height is reduced to kGentleDrop_m if the object would not stay otherwise.
  double height_m = 0.3;
  std::optional<Eigen::Matrix3d> R_world_object{};  ///< unset: the object keeps its orientation
};

/// A drop request without a position, for which no surface has been found so far.
struct WaitingDrop {
  DropRequest drop;
  std::int64_t try_at_frame = 0;  ///< the next search is in this localised frame or later
  /// Reason why the last search failed, as the end of a sentence. Empty: not searched so far.
  std::string why{};
};

/// Throws Error if the object's footprint (circle that it covers seen from above) has a radius above
/// kMostFootprint_m, the limit of the search for a surface.
void require_small_enough(const VirtualObject& object, const DropRequest& drop);

/// Surfaces of a frame, and the queries and physics that simulate an object's fall.
struct DropScene {
  const SessionRoom& room;
  const std::vector<SceneTree>& surfaces;  ///< all surfaces that the object can touch
  const PhysicsConfig& physics;
  CyberRadar& radar;
};

/// The frame in which find_drop_position() looks for a surface. Refers to its parts, which must outlive it.
struct DropView {
  const Intrinsics& camera;  ///< depth camera of the frame
  const Eigen::Isometry3d& T_world_camera;
  const ExpectedView& expected;
  const FrameForeground& foreground;
};

/// Result of find_drop_position().
struct [[nodiscard]] DropPosition {
  /// x and y: those of the object's origin when its centre is above the point found. z: height of the
  /// surface. Unset: no surface was found.
  std::optional<Eigen::Vector3d> position_world;
  double height_m = 0.0;  ///< at most DropRequest::height_m
  /// End of a sentence with the reason, if there is one: no surface was found; the object may not stay; it is
  /// dropped from a smaller height. Empty: the drop is as requested.
  std::string note;
};

/// Searches the view for a level surface of the static room on which the object can stand, onto which it can
/// fall freely and where it then stays. Dynamic surfaces count only if the scene has no static surface.
/// Simulates a fall from drop.height_m, and from kGentleDrop_m if the object does not stay, for at most 6
/// places. If the object stays in none of them, the first place is returned.
/// @param view  the current frame
DropPosition find_drop_position(const VirtualObject& object, const DropRequest& drop, const DropView& view,
                                const DropScene& scene);

/// The virtual objects of a session. Functions that take the name of an existing object throw Error if there
/// is none of that name. Not thread safe: call all functions on the constructing thread, whose GL context is
/// used.
class ObjectSet {
 public:
  /// All arguments must outlive the set. Changes of `config` take effect at the next call, those of its radar
  /// by set_radar().
  ObjectSet(GlContext& context, const FrameScene& scene, const SessionRoom& room,
            const SessionConfig& config);

  [[nodiscard]] const std::vector<std::unique_ptr<VirtualObject>>& all() const { return objects_; }
  [[nodiscard]] const std::vector<WaitingDrop>& waiting_drops() const { return waiting_; }

  /// Adds an object, outside the room until it is placed or dropped. Model::notes become notices. Throws
  /// Error if the name is taken, the mesh has no valid triangles, or set_material() would throw.
  void add(const std::string& name, Model model, const BodyMaterial& material = {});
  /// Adds an object from the result of object_parts(), which can be computed on another thread.
  void add(const std::string& name, ObjectParts parts, const BodyMaterial& material = {});
  /// Overwrites the values of an object's material that `change` sets, and wakes the object. Throws Error if
  /// a value is out of range, and for a density if the mesh is open.
  void set_material(const std::string& name, const BodyMaterial& change) {
    change_material(named(name), change);
  }
  /// Puts an object into the room. An object that would overlap other objects is placed on top of them if no
  /// surface of the room is in the way. If a surface intersects the object, or a part of it is in solid
  /// unknown space, it is placed at the nearest free pose within 10 cm. A notice is created if the object was
  /// moved by 5 mm or more. An object with a velocity may begin in unknown space; a notice says that nothing
  /// stops it there. Throws PlaceRefused if no free pose is within 10 cm; the object's pose is then
  /// unchanged.
  void place(const std::string& name, const ObjectState& state);
  /// Puts an object into the room exactly in a pose, asleep, without a search for a free pose. It wakes as any
  /// sleeping object does: if its support is gone, or a surface enters it.
  void stand(const std::string& name, const Eigen::Isometry3d& T_world_object);
  /// Drops an object. With drop.position_world, places it above that position as place() does. Without it,
  /// the drop waits for release_waiting(), and require_small_enough() may throw Error.
  void drop(const DropRequest& drop, std::int64_t frame_number);
  /// Moves an object towards a position and holds it there until release(). Obstacles stop it on the way. An
  /// object outside the room is first placed at the position, see place().
  void carry(const std::string& name, const Eigen::Vector3d& position_world);
  void release(const std::string& name, const Eigen::Vector3d& velocity_world_mps);
  /// Rotates an object in the room until the first contact, see turn_until_contact().
  void turn(const std::string& name, const Eigen::Vector3d& turn_world_deg);
  void remove(const std::string& name);

  /// Searches surfaces in view for the waiting drops. If none is found, a drop near a point is cancelled with
  /// a notice. Other drops are retried after at least 10 frames.
  /// @param expected, foreground  results for this frame
  void release_waiting(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                       const ExpectedView& expected, const FrameForeground& foreground,
                       std::int64_t frame_number);

  /// Advances the objects due in this frame, dt_s after the previous one. Stage timed: radar.
  ContactCounts move(double dt_s, std::int64_t frame_number, StageTimes& times);
  /// Calls end_departure() for all objects and returns the results. Places an object on top of others that
  /// have taken its place, as place() does. Call after move().
  std::vector<Departure> end_departures();
  /// Adds a notice that names no object.
  void notify(std::string sentence) { notices_.push_back({"", std::move(sentence)}); }
  /// Returns the notices created since the last call.
  std::vector<ObjectNotice> take_notices() { return std::exchange(notices_, {}); }
  /// Returns the max penetration depth of an object into the room or another object along gravity, m, >= 0.
  double penetration_m();

  /// Returns the frame's surfaces and all objects in the room except `object`, which may be null.
  [[nodiscard]] std::vector<SceneTree> scene_without(const VirtualObject* object) const;
  /// Returns balls in which the dynamic mesh gets full resolution; none unless config.fine_mesh.
  [[nodiscard]] std::vector<FineRegion> fine_regions() const;
  /// Returns a ball around each object in the room; one around everything while a drop waits for a place.
  [[nodiscard]] std::vector<FineRegion> bounding_balls() const;
  /// Sets VirtualObject::fine_cells of all objects from the scene's last dynamic mesh.
  void count_fine_cells();

  /// Throws Error, and changes nothing, if the renderer lacks a feature that RadarMode::kPasses needs.
  void set_radar(const RadarConfig& config);
  [[nodiscard]] std::uint64_t static_triangles_tested() const {
    return tested_before_ + radar_.static_triangles_tested();
  }
  /// Wakes all objects, so that objects whose support was removed fall. Call after the room has changed.
  void room_changed();
  /// Updates which objects are in solid unknown space. Call after unknown space became solid or free.
  void unknown_changed();

 private:
  GlContext& context_;
  const FrameScene& scene_;
  const SessionRoom& room_;
  const SessionConfig& config_;
  std::vector<std::unique_ptr<VirtualObject>> objects_;
  std::vector<WaitingDrop> waiting_;
  CyberRadar radar_;
  std::unique_ptr<PassesRadar> passes_;  ///< moves the objects instead of radar_ in RadarMode::kPasses
  std::uint64_t tested_before_ = 0;  ///< static triangles tested before the last set_radar()
  std::vector<ObjectNotice> notices_;
  ContactSystem contact_system_;  ///< buffers of move()
  CyberRadar exact_radar_;        ///< used for drops, moves out of surfaces, and penetration_m()

  VirtualObject& named(const std::string& name);
  void require_new(const std::string& name) const;
  void take_in(std::unique_ptr<VirtualObject> object, std::vector<std::string> notes,
               const BodyMaterial& material);
  /// Removes the object's waiting drop.
  void cancel_drop(const std::string& name);
  /// Returns the object. Cancels its waiting drop, and ends carrying it.
  VirtualObject& take_over(const std::string& name);
  void put(VirtualObject& object, const ObjectState& state);
  [[nodiscard]] WayOut way_out_of(const VirtualObject& object);
};

}  // namespace roomradar
