// bullet_bench_scenes.hpp: the scenes of bullet_bench, and both ways to simulate them.
#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "bench_times.hpp"
#include "mapping/types/mesh.hpp"
#include "physics_bench_scenes.hpp"
#include "radar/motion/proximity.hpp"

namespace roomradar::bench {

inline constexpr double kBenchFrame_s = 1.0 / 30.0;

/// Surfaces at rest.
struct Surroundings {
  Mesh room;
  Mesh unknown;  ///< border of unknown space, which is solid; empty: none
};

/// An object that enters the scene once its place is free.
struct Entry {
  const Thing* thing;
  bool is_convex;
  int frame;  ///< enters in this frame or later
  Eigen::Isometry3d T_world_object;
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_world_rad_s = Eigen::Vector3d::Zero();
};

struct Simulated {
  test::Times frames;                             ///< wall-clock time of each frame's physics
  test::Times cpu;                                ///< the same, CPU time of all threads
  std::vector<Eigen::Isometry3d> T_world_object;  ///< at the end, per entry
  int asleep = 0, entered = 0;                    ///< at the end
};

/// Returns true if the place of an entry is farther than 5 mm from the surfaces of all objects in the scene.
/// @param T_world_object  per entry
/// @param is_present      per entry: it is in the scene
bool is_place_free(const Entry& entry, const std::vector<Entry>& entries,
                   const std::vector<Eigen::Isometry3d>& T_world_object, const std::vector<bool>& is_present);

/// The project's physics: all bodies advanced together.
Simulated simulate(const Surroundings& surroundings, const std::vector<Entry>& entries, int frames);

enum class BulletMotion { kDiscrete, kContinuous };
/// Bullet's discrete dynamics world: room and unknown space as btBvhTriangleMeshShape, convex objects as
/// hulls, others as GImpact meshes, margins of 1 mm, two substeps per frame. kContinuous adds Bullet's swept
/// spheres (CCD).
Simulated simulate_with_bullet(const Surroundings& surroundings, const std::vector<Entry>& entries,
                               int frames, BulletMotion motion);

}  // namespace roomradar::bench
