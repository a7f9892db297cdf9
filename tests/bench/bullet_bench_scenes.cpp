// bullet_bench_scenes.cpp: advances the bodies of a scene together.
#include "bullet_bench_scenes.hpp"

#include <algorithm>

#include "tests/support/body_group.hpp"

namespace roomradar::bench {

bool is_place_free(const Entry& entry, const std::vector<Entry>& entries,
                   const std::vector<Eigen::Isometry3d>& T_world_object,
                   const std::vector<bool>& is_present) {
  constexpr double kClear_m = 0.005;
  std::vector<SceneTree> scene;
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (is_present[i]) scene.push_back({{&entries[i].thing->tree, T_world_object[i]}, SurfaceKind::kObject});
  std::vector<ClosestPoint> near;
  const SurfaceKindMask crossed =
      near_features({&entry.thing->tree, entry.T_world_object}, {scene, {}}, kClear_m, 0, near);
  return crossed == 0 && near.empty();
}

Simulated simulate(const Surroundings& surroundings, const std::vector<Entry>& entries, int frames) {
  std::vector<Mesh> meshes;
  for (const Entry& entry : entries) meshes.push_back(entry.thing->mesh);
  test::BodyGroup group(meshes);
  group.add_surface(surroundings.room);
  group.add_surface(surroundings.unknown, SurfaceKind::kUnknownFrontier);
  group.weigh();
  group.frame_s = kBenchFrame_s;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    group.bodies[i].T_world_object = entries[i].T_world_object;
    group.bodies[i].velocity_world_mps = entries[i].velocity_world_mps;
    group.bodies[i].angular_velocity_world_rad_s = entries[i].angular_velocity_world_rad_s;
  }
  group.is_present.assign(entries.size(), false);
  Simulated result;
  for (int frame = 0; frame < frames; ++frame) {
    std::vector<Eigen::Isometry3d> T_world_object;
    for (const Body& body : group.bodies) T_world_object.push_back(body.T_world_object);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      group.is_undisturbed[i] = group.is_present[i];
      if (!group.is_present[i] && entries[i].frame <= frame)
        group.is_present[i] = is_place_free(entries[i], entries, T_world_object, group.is_present);
    }
    const double start_ms = test::wall_ms(), cpu_ms = test::process_ms();
    group.step({});
    result.frames.samples_ms.push_back(test::wall_ms() - start_ms);
    result.cpu.samples_ms.push_back(test::process_ms() - cpu_ms);
  }
  for (const Body& body : group.bodies) {
    result.T_world_object.push_back(body.T_world_object);
    result.asleep += body.asleep;
  }
  result.entered = static_cast<int>(std::count(group.is_present.begin(), group.is_present.end(), true));
  return result;
}

}  // namespace roomradar::bench
