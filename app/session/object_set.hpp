// object_set.hpp: the virtual objects of a session: placing, dropping, carrying, and motion by physics.
#pragma once
#include <Eigen/Geometry>
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
#include "app/session/drop_request.hpp"
#include "app/session/frame_scene.hpp"
#include "app/session/object_motion.hpp"
#include "app/session/object_overlap.hpp"
#include "app/session/session_config.hpp"
#include "app/session/session_room.hpp"
#include "mapping/types/system/stage_times.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "radar/motion/proximity.hpp"

namespace roomradar {

/// Initial state of an object that is put into the room.
struct ObjectState {
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();      ///< of the object's origin
  std::optional<Eigen::Matrix3d> R_world_object{};               ///< unset: the object keeps its orientation
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();  ///< velocity of the centre of mass
  Eigen::Vector3d angular_velocity_world_rad_s = Eigen::Vector3d::Zero();
};

/// All functions that take a name throw Error if there is no object of that name. Not thread safe; GL calls
/// are made on the constructing thread.
class ObjectSet {
 public:
  /// All arguments must outlive the set; config is read at each call.
  ObjectSet(GlContext& context, const FrameScene& scene, const SessionRoom& room,
            const SessionConfig& config);

  [[nodiscard]] const std::vector<std::unique_ptr<VirtualObject>>& all() const { return objects_; }
  [[nodiscard]] const std::vector<WaitingDrop>& waiting_drops() const { return waiting_; }

  /// Adds an object that is not in the room at first. Throws Error if the name is taken or the mesh is
  /// unsuitable.
  void add(const std::string& name, const Mesh& mesh);
  /// Same, with the model's textures; its notes become notices.
  void add(const std::string& name, Model model);
  /// Adds an object from parts that were prepared earlier, such as on another thread.
  void add(const std::string& name, ObjectParts parts);
  /// Puts an object into the room. If it would overlap other objects, it starts on top of them if the room
  /// leaves space there. If a surface of the room intersects it, or it is in solid unknown space, it starts
  /// at the nearest free pose within 10 cm, with a notice. Throws PlaceRefused, and changes nothing, if a
  /// surface intersects it and no free pose is that near.
  void place(const std::string& name, const ObjectState& state);
  /// Drops an object. With a position, places it as place() does. Without one, the drop waits for
  /// release_waiting(); throws Error if the object is too large for any place in view.
  void drop(const DropRequest& drop, std::int64_t frame_number);
  /// Carries an object towards a position until something is in the way; lasts until release().
  void carry(const std::string& name, const Eigen::Vector3d& position_world);
  void release(const std::string& name, const Eigen::Vector3d& velocity_world_mps);
  /// Rotates an object about its centre until something is in the way; no effect outside the room.
  void turn(const std::string& name, const Eigen::Vector3d& turn_world_deg);
  void remove(const std::string& name);

  /// Searches surfaces in view for the waiting drops. For a drop near a point, searches once; if there is no
  /// place, the drop ends with a notice. For other drops, searches again in later frames.
  /// @param expected, foreground  of this frame
  void release_waiting(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                       const ExpectedView& expected, const FrameForeground& foreground,
                       std::int64_t frame_number);

  /// Moves all objects that are due in this frame by dt_s of physics. Stage timed: radar.
  ContactCounts move(double dt_s, std::int64_t frame_number, StageTimes& times);
  /// Puts objects that fell out of the map back, and returns them; call after move().
  std::vector<Departure> end_departures();
  /// Returns the notices since the last call.
  std::vector<ObjectNotice> take_notices() { return std::exchange(notices_, {}); }
  /// Returns the greatest overlap of an object with the room or another object along gravity, m, >= 0.
  double penetration_m();

  /// Returns everything that `object` can touch, so all but itself; null: everything.
  [[nodiscard]] std::vector<SceneTree> scene_without(const VirtualObject* object) const;
  /// Returns balls around the objects in which the dynamic mesh has full resolution; none unless
  /// config.fine_mesh.
  [[nodiscard]] std::vector<FineRegion> fine_regions() const;
  /// Sets fine_cells of all objects from the scene's dynamic mesh, made with fine_regions().
  void count_fine_cells();

  void set_radar(const RadarConfig& config);
  /// Number of static triangles that the radar has examined so far.
  [[nodiscard]] std::uint64_t static_triangles_tested() const {
    return tested_before_ + radar_.static_triangles_tested();
  }
  /// Updates which objects are in unknown space; call after unknown space became solid or free.
  void unknown_changed();

 private:
  GlContext& context_;
  const FrameScene& scene_;
  const SessionRoom& room_;
  const SessionConfig& config_;
  std::vector<std::unique_ptr<VirtualObject>> objects_;
  std::vector<WaitingDrop> waiting_;
  CyberRadar radar_;
  std::uint64_t tested_before_ = 0;  ///< static triangles examined before set_radar() replaced radar_
  ProximityQuery proximity_;
  std::vector<ObjectNotice> notices_;
  std::vector<SceneBody> bodies_;  ///< bodies in the scene of the object being moved
  CyberRadar exact_radar_;         ///< for drops, moves out of surfaces, and penetration

  VirtualObject& named(const std::string& name);
  void require_new(const std::string& name) const;
  /// Removes the object's waiting drop.
  void cancel_drop(const std::string& name);
  /// Returns the object after cancelling its waiting drop and ending its carrying.
  VirtualObject& take_over(const std::string& name);
  void put(VirtualObject& object, const ObjectState& state);
  [[nodiscard]] WayOut way_out_of(const VirtualObject& object);
  /// Returns true if the object with this index is moved in this frame.
  [[nodiscard]] bool is_turn_to_move(std::size_t index, std::int64_t frame_number) const;
  /// Returns the directions in which dynamic surfaces near the object push it out.
  [[nodiscard]] PushDirections push_of(const VirtualObject& object) const;
  /// Returns one entry per tree of scene_without(): the tree's body, or null if the tree is not an object.
  std::span<const SceneBody> bodies_in(const std::vector<SceneTree>& scene, const VirtualObject& object);
};

}  // namespace roomradar
