// object_motion.hpp: moves objects by physics, or as a user carries or rotates them.
#pragma once
#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "app/objects/virtual_object.hpp"
#include "app/physics/collision_queries.hpp"
#include "app/physics/contact_system.hpp"
#include "app/physics/depenetration.hpp"
#include "app/physics/physics_config.hpp"
#include "app/session/frame_scene.hpp"
#include "app/session/session_config.hpp"
#include "dynamic/surface/dynamic_surface_config.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "radar/geometry/radar_scene.hpp"

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

/// A radar and the total duration of its queries. Refers to both, which must outlive it.
struct TimedRadar {
  Radar& radar;
  std::atomic<double>& queries_ms;  ///< incremented by each query
};

/// Returns true if config.move_every_n_frames and config.picture_every_n_frames let the object with this
/// index be advanced in this frame.
bool is_turn_to_move(std::size_t index, std::int64_t frame_number, const SessionConfig& config);

/// An object that is moved in this frame, and the surfaces and objects that it can touch.
struct DueObject {
  VirtualObject* object = nullptr;
  double waited_s = 0.0;  ///< time since the object was last advanced; may exceed config.max_advance_s
  std::vector<SceneTree> scene{};   ///< surfaces, then the other objects
  bool is_undisturbed = false;      ///< see AdvancedBody::is_undisturbed
  bool was_overlapped = false;      ///< out: a surface overlapped the object, which may have been shifted
  std::vector<SceneBody> bodies{};  ///< body of each tree of the scene; null for surfaces
};

/// Returns the body of each tree of the object's scene. Entries of surfaces are null. The other objects must
/// be the last trees of the scene.
std::vector<SceneBody> bodies_in(const std::vector<SceneTree>& scene,
                                 std::span<const std::unique_ptr<VirtualObject>> objects,
                                 const VirtualObject& object);

/// Returns true if nothing new can overlap the object: only physics has moved it to its pose, and no moving
/// surface is within 25 cm.
bool is_undisturbed(const VirtualObject& object, std::span<const SceneTree> scene);

/// Advances the objects together; see advance_together(). A carried object moves at the velocity that reaches
/// its target after waited_s. Gravity, friction and restitution do not act on a carried object. Obstacles
/// stop it.
///
/// Within the call, the dynamic surfaces near an object move from their position in the last frame to their
/// position in this frame. They move in steps of at most 15 mm, and push the object on the way. Hence a hand
/// that moves by up to 15 cm per frame does not pass the object between two frames. An inferred back that
/// engulfs the object (is_engulfed()) is left out of the object's scene.
/// @param moving    this frame's surfaces; null: no surface is known to be dynamic
/// @param contacts  buffers; keeps impulses as initial guesses for a next call with the same objects
/// @param counts    incremented by the contacts of this call
void advance_objects(std::span<DueObject> due, const FrameScene* moving, const PhysicsConfig& config,
                     const TimedRadar& timed, ContactSystem& contacts, ContactCounts& counts);

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

}  // namespace roomradar
