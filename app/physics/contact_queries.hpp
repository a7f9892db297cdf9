// contact_queries.hpp: finds the surfaces and bodies within contact distance of a substep's bodies.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "app/physics/contact_system.hpp"

namespace roomradar {

/// Returns the index of the body, among the substep's bodies, to which a feature belongs; kNoOther if none.
inline std::size_t member_of(const MovingBody& moving, const ClosestPoint& p) {
  return p.tree < moving.member_of_tree.size() ? moving.member_of_tree[p.tree] : kNoOther;
}

/// Sets MovingBody::near of all active bodies, and of sleeping bodies that they touch, directly or through
/// others, to the features within 1.5 contact margins. A pair of active bodies is queried once, from the
/// lower one. In a substep's later queries, a body that has moved by at most a quarter of the margin keeps
/// the features of surfaces and of bodies that have not moved either. Sets `crosses` of active bodies that a
/// surface intersects. Returns, per body, true for the sleeping bodies that are touched.
/// @param system  bodies are queried in the order of ContactSystem::upwards; ContactSystem::sleepers caches
///                contacts
std::vector<bool> query_contacts(std::span<MovingBody> bodies, const PhysicsConfig& config,
                                 ContactSystem& system);

}  // namespace roomradar
