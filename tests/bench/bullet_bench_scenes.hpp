// bullet_bench_scenes.hpp: the scenes of bullet_bench, and both ways to simulate them.
#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "bench_times.hpp"
#include "mapping/types/mesh.hpp"
#include "physics_bench_scenes.hpp"

namespace roomradar::bench {

inline constexpr double kBenchFrame_s = 1.0 / 30.0;

/// An object that enters the scene at a frame.
struct Entry {
  const Thing* thing;
  bool is_convex;
  int frame;
  Eigen::Isometry3d T_world_object;
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_world_rad_s = Eigen::Vector3d::Zero();
};

struct Simulated {
  test::Times frames;                             ///< thread time of each frame's physics
  std::vector<Eigen::Isometry3d> T_world_object;  ///< at the end, per entry
  int asleep = 0;                                 ///< at the end
};

/// The project's physics: all bodies advanced together.
Simulated simulate(const Mesh& room, const std::vector<Entry>& entries, int frames);

enum class BulletMotion { kDiscrete, kContinuous };
/// Bullet's discrete dynamics world: the room as btBvhTriangleMeshShape, convex objects as hulls, others as
/// GImpact meshes, margins of 1 mm, two substeps per frame. kContinuous adds Bullet's swept spheres (CCD).
Simulated simulate_with_bullet(const Mesh& room, const std::vector<Entry>& entries, int frames,
                               BulletMotion motion);

}  // namespace roomradar::bench
