// bullet_bench_scenes.cpp: advances the bodies of a scene together.
#include "bullet_bench_scenes.hpp"

#include "tests/support/body_group.hpp"

namespace roomradar::bench {

Simulated simulate(const Mesh& room, const std::vector<Entry>& entries, int frames) {
  std::vector<Mesh> meshes;
  for (const Entry& entry : entries) meshes.push_back(entry.thing->mesh);
  test::BodyGroup group(meshes);
  group.add_surface(room);
  group.weigh();
  group.frame_s = kBenchFrame_s;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    group.bodies[i].T_world_object = entries[i].T_world_object;
    group.bodies[i].velocity_world_mps = entries[i].velocity_world_mps;
    group.bodies[i].angular_velocity_world_rad_s = entries[i].angular_velocity_world_rad_s;
  }
  Simulated result;
  for (int frame = 0; frame < frames; ++frame) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
      group.is_present[i] = entries[i].frame <= frame;
      group.is_undisturbed[i] = entries[i].frame < frame;
    }
    const double start_ms = test::thread_ms();
    group.step({});
    result.frames.samples_ms.push_back(test::thread_ms() - start_ms);
  }
  for (const Body& body : group.bodies) {
    result.T_world_object.push_back(body.T_world_object);
    result.asleep += body.asleep;
  }
  return result;
}

}  // namespace roomradar::bench
