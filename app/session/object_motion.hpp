// object_motion.hpp: moves one object: by physics, carried by a user, or by a turn.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "app/objects/virtual_object.hpp"
#include "app/physics/collision_queries.hpp"
#include "app/physics/depenetration.hpp"
#include "app/physics/physics_config.hpp"
#include "dynamic/surface/dynamic_surface_config.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

/// Contacts of one frame.
struct ContactCounts {
  int contacts = 0;
  std::array<int, kSurfaceKinds> by_kind{};  ///< contacts per kind of surface touched
};

/// Advances an object by the time since it was last moved. A carried object moves to its target by the end of
/// this time, without gravity, friction and restitution, unless something is in the way.
/// @param waited_s  time since the object was last moved; may exceed config.max_advance_s
/// @param counts    the object's contacts are added
void advance_object(VirtualObject& object, double waited_s, const CollisionQueries& probe,
                    const PhysicsConfig& config, const PushDirections& push, ContactCounts& counts);

/// Removes the inferred back from the object's scene if the back engulfs the object (is_engulfed()).
/// @param radar_ms  the time of the queries is added
void drop_engulfing_back(const VirtualObject& object, double waited_s, const PushDirections& push,
                         const PhysicsConfig& config, CyberRadar& radar, ProximityQuery& proximity,
                         std::vector<SceneTree>& scene, double& radar_ms);

/// Returns balls around the objects in the room, in which the dynamic mesh has full resolution.
std::vector<FineRegion> fine_regions(std::span<const std::unique_ptr<VirtualObject>> objects);

/// Sets fine_cells of all objects from the counts per region of fine_regions(), in its order; 0 without a
/// region.
void set_fine_cells(std::span<const std::unique_ptr<VirtualObject>> objects,
                    std::span<const std::uint32_t> cells_of_region);

/// Rotates an object about its centre, degrees about the world's axes, until a surface of the scene is in the
/// way, and wakes the object. Does nothing if the radar returns no usable result.
void turn_until_contact(VirtualObject& object, const Eigen::Vector3d& turn_world_deg,
                        std::span<const SceneTree> scene, CyberRadar& radar);

}  // namespace roomradar
