// collision_queries.cpp: binds a body's queries to the radar, and times them.
#include "app/physics/collision_queries.hpp"

#include <chrono>

#include "mapping/types/system/stage_times.hpp"

namespace roomradar {

CollisionQueries make_collision_queries(Radar& radar, const TriangleTree& object, const RadarScene& scene,
                                        std::atomic<double>* spent_ms) {
  struct Spent {
    std::atomic<double>* spent_ms;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    ~Spent() {
      if (spent_ms != nullptr) *spent_ms += ms_since(start);
    }
  };
  CollisionQueries probe;
  probe.travel = [&, spent_ms](const Eigen::Isometry3d& T_world_object, const Eigen::Vector3d& direction,
                               double distance_m) {
    const Spent spent{spent_ms};
    return radar.query({{&object, T_world_object}, direction, distance_m}, scene);
  };
  probe.near = [&, spent_ms](const Eigen::Isometry3d& T_world_object, double reach_m,
                             SurfaceKindMask left_out, const TreeStates& trees,
                             std::vector<ClosestPoint>& points) {
    const Spent spent{spent_ms};
    return near_features({&object, T_world_object}, scene, reach_m, left_out, trees, points);
  };
  probe.free_time = [&, spent_ms](const Eigen::Isometry3d& T_world_object, const RigidMotion& motion,
                                  double duration_s, double keep_m, SurfaceKindMask left_out,
                                  const TreeStates& trees) {
    const Spent spent{spent_ms};
    return free_time({{&object, T_world_object}, motion}, duration_s, keep_m, scene, left_out, trees);
  };
  probe.patch = [&, spent_ms](std::uint32_t tree, const Eigen::Vector3d& point_world,
                              const Eigen::Vector3d& facing_world, double reach_m) {
    const Spent spent{spent_ms};
    return fit_plane(scene.trees[tree].instance, point_world, facing_world, reach_m);
  };
  return probe;
}

}  // namespace roomradar
