// virtual_object.hpp: model, pose and state of a virtual object.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/objects/object_file.hpp"
#include "app/objects/object_model.hpp"
#include "app/physics/physics.hpp"
#include "app/render/contact_shadow.hpp"
#include "app/render/draw.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/mesh.hpp"
#include "radar/motion/closest_point.hpp"

namespace roomradar {

/// A point where an object touches something.
struct ObjectContact {
  ClosestPoint closest;         ///< ClosestPoint::gap_m is exact for the two meshes
  const Body* other = nullptr;  ///< the other object's body; null: a surface
};

/// What is known about an object since it was last placed. Placing the object replaces all of it. Removing
/// the object keeps it for the summary.
struct Placement {
  Eigen::Matrix3d R_world = Eigen::Matrix3d::Identity();  ///< orientation when placed, or released by a user
  /// When placed, the object was in unknown space that is solid; see is_in_solid_unknown().
  bool began_in_unknown = false;
  /// The object has been in solid unknown space ever since.
  bool in_unknown = false;
  /// Pose from which its motion is measured for still_s.
  Eigen::Isometry3d T_world_still = Eigen::Isometry3d::Identity();
  double still_s = 0.0;  ///< time for which the object has been awake and within 2 mm of T_world_still
  /// True if a surface intersects the object, no free pose is within 10 cm, and the object has been awake and
  /// still for 1 s. Reset when the object moves.
  bool stuck = false;
  double waited_s = 0.0;  ///< time since physics last advanced the object
  /// Pose to which physics last moved the object, if no surface of the room and no other object overlaps it
  /// there.
  std::optional<Eigen::Isometry3d> T_world_undisturbed{};
};

struct VirtualObject {
  Body body;  ///< includes name and pose
  bool in_room = false;
  std::string_view why_not_in_room = "nothing placed or dropped it";  ///< valid while in_room is false
  Placement placement;                                                ///< default until first placed
  /// Target position of the origin while a user carries the object, without gravity. Unset: not carried.
  std::optional<Eigen::Vector3d> carried_to_world;
  /// Pose in which the object last slept. Unset: the object has not slept since it was added or since
  /// end_departure() returned it.
  std::optional<Eigen::Isometry3d> T_world_rested;
  int departures = 0;  ///< number of times that it fell out of the map
  /// Contacts with a gap of at most 1.5 contact margins, found before the object's last motion. They are kept
  /// while the object sleeps.
  std::vector<ObjectContact> contacts;
  /// Number of cells of the last frame's dynamic mesh that have full resolution because this object is near.
  std::size_t fine_cells = 0;
  std::shared_ptr<const ObjectModel> model;  ///< not null
  ContactShadow shadow;                      ///< valid for ContactShadow::R_world_object

  VirtualObject(std::string name, std::shared_ptr<const ObjectModel> its_model);
};

/// Makes an object of a model. Reuses the ObjectModel of another object that was made from an identical
/// model. Throws Error as object_parts() and ObjectModel do.
std::unique_ptr<VirtualObject> object_of(GlContext& context, const std::string& name, Model source,
                                         std::span<const std::unique_ptr<VirtualObject>> others);
/// Makes an object of a mesh without textures.
std::unique_ptr<VirtualObject> object_of(GlContext& context, const std::string& name, const Mesh& mesh,
                                         std::span<const std::unique_ptr<VirtualObject>> others);
/// Makes an object from the result of object_parts(). The result is discarded if an existing ObjectModel can
/// be reused.
std::unique_ptr<VirtualObject> object_of(GlContext& context, const std::string& name, ObjectParts parts,
                                         std::span<const std::unique_ptr<VirtualObject>> others);

/// Overwrites the values of the object's material that `change` sets, and wakes the object. Throws Error, and
/// changes nothing, if a value is out of range, or if a density is set and the mesh is open.
void change_material(VirtualObject& object, const BodyMaterial& change);

/// Returns the object of this name; null if there is none.
VirtualObject* find_object(std::span<const std::unique_ptr<VirtualObject>> objects, const std::string& name);

/// Returns "outside" (of the room), "carried", "stuck", "at rest" or "moving".
std::string_view state_word(const VirtualObject& object);

/// Return the heights of the object's lowest and highest vertex above its origin in its current orientation,
/// m.
double lowest_m(const VirtualObject& object);
double highest_m(const VirtualObject& object);
/// Returns the height of the object's lowest vertex above its origin in the given orientation, m.
double lowest_m(const VirtualObject& object, const Eigen::Matrix3d& R_world_object);

/// Returns the centre of the object's bounding box in the world. Computes with local copies: Eigen's sums may
/// depend on the alignment of their operands, which differs from run to run on the heap.
Eigen::Vector3d middle_world(const VirtualObject& object);
/// Returns the radius of the circumscribed sphere of the object's bounding box, m.
double radius_m(const VirtualObject& object);
/// Returns the max horizontal distance (m) of the object's vertices from the centre of its bounding box, in
/// the given orientation.
double footprint_radius_m(const VirtualObject& object, const Eigen::Matrix3d& R_world_object);
/// Returns the horizontal vector, in world axes, from the object's origin to the centre of its bounding box
/// in the given orientation, m.
Eigen::Vector3d level_to_middle(const VirtualObject& object, const Eigen::Matrix3d& R_world_object);

/// Returns the coarsest level of detail that deviates by at most error_px pixels from the full mesh. The size
/// of a pixel is taken at the object's nearest depth. Valid while the object's model exists.
DrawnObject drawn_object(const VirtualObject& object, const Intrinsics& camera,
                         const Eigen::Isometry3d& T_world_camera, double error_px);

}  // namespace roomradar
