// virtual_object.hpp: a thing that is not there: its shape for radar and picture, and where it is.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "app/objects/object_model.hpp"
#include "app/physics/physics.hpp"
#include "app/render/contact_shadow.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

struct VirtualObject {
  Body body;  ///< its name and pose
  bool in_room = false;
  bool began_in_unknown = false;                              ///< was put where nobody has seen what is there
  bool in_unknown = false;                                    ///< and has not come out of there since
  Eigen::Matrix3d R_world_put = Eigen::Matrix3d::Identity();  ///< how it stood when it was last put somewhere
  /// While it is held by a user's hand: where its origin is wanted. Gravity does not move it then.
  std::optional<Eigen::Vector3d> carried_to_world;
  double waited_s = 0.0;       ///< since it was moved last
  std::size_t fine_cells = 0;  ///< of the last frame's mesh of what moved: as fine as the image for its sake
  std::shared_ptr<const ObjectModel> model;  ///< not null
  ContactShadow shadow;                      ///< as it stood when this was made last

  VirtualObject(std::string name, std::shared_ptr<const ObjectModel> its_model);
};

/// An object of this mesh, with the model of one of the others where that was made from the same mesh. Throws
/// Error as object_parts() and ObjectModel do.
std::unique_ptr<VirtualObject> object_of(GlContext& context, const std::string& name, const Mesh& mesh,
                                         std::span<const std::unique_ptr<VirtualObject>> others);
/// The same where the parts of a model were made already; they are not used if there is one.
std::unique_ptr<VirtualObject> object_of(GlContext& context, const std::string& name, ObjectParts parts,
                                         std::span<const std::unique_ptr<VirtualObject>> others);

/// How far its lowest and its highest point are above its origin, as it is turned now, m.
double lowest_m(const VirtualObject& object);
double highest_m(const VirtualObject& object);

/// Of a ball about its middle, which holds all of it, m.
double radius_m(const VirtualObject& object);
/// How far it reaches sideways from its middle, turned like this, m.
double footprint_radius_m(const VirtualObject& object, const Eigen::Matrix3d& R_world_object);
/// From its origin to under or over its middle, turned like this, m in the world: a mesh's origin may lie at
/// a corner, or outside.
Eigen::Vector3d level_to_middle(const VirtualObject& object, const Eigen::Matrix3d& R_world_object);

/// The coarsest mesh of the object that lies no farther than error_px off the full one, as the camera sees it
/// at its nearest point.
const GpuMesh& drawn_mesh(const VirtualObject& object, const Intrinsics& camera,
                          const Eigen::Isometry3d& T_world_camera, double error_px);

/// The mesh that a user names: `teapot`, the built-in one, 0.15 m high, or a file that read_mesh reads.
/// Scaled so that its longest side is size_m, if that is > 0. Throws Error naming the file and the fault.
Mesh object_mesh(const std::string& name_or_path, double size_m = 0.0);

}  // namespace roomradar
