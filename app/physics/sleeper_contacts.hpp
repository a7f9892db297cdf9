// sleeper_contacts.hpp: contacts of sleeping bodies, kept from substep to substep.
#pragma once
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "app/physics/body.hpp"
#include "app/physics/collision_queries.hpp"

namespace roomradar {

/// Valid as long as neither the sleeping body nor a body that it touches has moved.
struct SleeperContacts {
  struct ContactBody {
    const Body* body;  ///< null: static surface
    Eigen::Isometry3d T_world_body;
  };
  const Body* body = nullptr;
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  std::vector<ClosestPoint> near;
  std::vector<ContactBody> bodies;  ///< per point of `near`
};

/// Returns the body that a point of the scene lies on; null: a surface.
/// @param others  one per triangle tree of the scene: the tree's body. Trees beyond the last entry are
///                surfaces
inline const Body* body_of(std::span<const SceneBody> others, const ClosestPoint& p) {
  return p.tree < others.size() ? others[p.tree].body : nullptr;
}

/// Copies a body's known contacts to `near` if they are still valid. Returns false if they are not.
/// ClosestPoint::tree is set to the other body's index in `others`, which may have changed.
/// @param others  as in body_of()
bool recall_contacts(std::span<const SleeperContacts> known, const Body& body,
                     std::span<const SceneBody> others, std::vector<ClosestPoint>& near);

/// Replaces the known contacts of a body.
void remember_contacts(std::vector<SleeperContacts>& known, const Body& body,
                       std::span<const SceneBody> others, const std::vector<ClosestPoint>& near);

}  // namespace roomradar
