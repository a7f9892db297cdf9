// virtual_object.hpp: a virtual object: model, pose and state in the room.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "app/objects/object_file.hpp"
#include "app/objects/object_model.hpp"
#include "app/physics/physics.hpp"
#include "app/render/contact_shadow.hpp"
#include "app/render/draw.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

struct VirtualObject {
  Body body;  ///< includes name and pose
  bool in_room = false;
  bool began_in_unknown = false;                              ///< was placed in unknown space
  bool in_unknown = false;                                    ///< has not left unknown space since placed
  Eigen::Matrix3d R_world_put = Eigen::Matrix3d::Identity();  ///< orientation when last placed
  /// While carried by a user's hand: target position of its origin. Gravity does not act meanwhile.
  std::optional<Eigen::Vector3d> carried_to_world;
  /// Pose when it last fell asleep; unset: it has not slept so far, or has fallen out of the map from there.
  std::optional<Eigen::Isometry3d> T_world_rested;
  int departures = 0;  ///< number of times that it fell out of the map
  /// True: it has been awake without moving for 1 s, a surface intersects it, and no free pose is near. Reset
  /// when it moves.
  bool stuck = false;
  double still_s = 0.0;  ///< time awake within 2 mm of T_world_still
  Eigen::Isometry3d T_world_still = Eigen::Isometry3d::Identity();
  double waited_s = 0.0;  ///< time since it was last advanced
  /// Cells of the last frame's dynamic mesh refined to full resolution because of this object.
  std::size_t fine_cells = 0;
  std::shared_ptr<const ObjectModel> model;  ///< not null
  ContactShadow shadow;                      ///< valid for ContactShadow::R_world_object

  VirtualObject(std::string name, std::shared_ptr<const ObjectModel> its_model);
};

/// Makes an object of this model; shares the ObjectModel of another object if that was made from the same
/// model. Throws Error as object_parts() and ObjectModel do.
std::unique_ptr<VirtualObject> object_of(GlContext& context, const std::string& name, Model source,
                                         std::span<const std::unique_ptr<VirtualObject>> others);
/// Same, of a mesh without textures.
std::unique_ptr<VirtualObject> object_of(GlContext& context, const std::string& name, const Mesh& mesh,
                                         std::span<const std::unique_ptr<VirtualObject>> others);
/// The same, with the model's parts already made; they are discarded if a model can be shared.
std::unique_ptr<VirtualObject> object_of(GlContext& context, const std::string& name, ObjectParts parts,
                                         std::span<const std::unique_ptr<VirtualObject>> others);

/// Return the height of its lowest and highest point above its origin, in its present orientation, m.
double lowest_m(const VirtualObject& object);
double highest_m(const VirtualObject& object);
/// Returns the height of its lowest point above its origin in another orientation, m.
double lowest_m(const VirtualObject& object, const Eigen::Matrix3d& R_world_object);

/// Returns the radius of the sphere around its bounding box, m.
double radius_m(const VirtualObject& object);
/// Returns its horizontal extent from its centre, in this orientation, m.
double footprint_radius_m(const VirtualObject& object, const Eigen::Matrix3d& R_world_object);
/// Returns the horizontal vector from its origin to its centre in the world, in this orientation, m. A mesh's
/// origin may be at a corner, or outside.
Eigen::Vector3d level_to_middle(const VirtualObject& object, const Eigen::Matrix3d& R_world_object);

/// Returns the coarsest level of the object within error_px of the full one, as the camera sees it at its
/// nearest point. Valid as long as the object's model.
DrawnObject drawn_object(const VirtualObject& object, const Intrinsics& camera,
                         const Eigen::Isometry3d& T_world_camera, double error_px);
/// Returns the mesh of drawn_object().
const GpuMesh& drawn_mesh(const VirtualObject& object, const Intrinsics& camera,
                          const Eigen::Isometry3d& T_world_camera, double error_px);

}  // namespace roomradar
