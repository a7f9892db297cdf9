// bullet_bench_scenes.cpp: advances the bodies of a scene together.
#include "bullet_bench_scenes.hpp"

#include "app/physics/physics.hpp"

namespace roomradar::bench {

Simulated simulate(const Mesh& room, const std::vector<Entry>& entries, int frames) {
  TriangleTree room_tree;
  room_tree.build_by_place(room);
  std::vector<Body> bodies(entries.size());
  std::vector<bool> was_advanced(entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    bodies[i].mass = entries[i].thing->mass;
    bodies[i].T_world_object = entries[i].T_world_object;
    bodies[i].velocity_world_mps = entries[i].velocity_world_mps;
    bodies[i].angular_velocity_world_rad_s = entries[i].angular_velocity_world_rad_s;
  }
  CyberRadar radar;
  ProximityQuery field;
  ContactSystem system;
  Simulated result;
  for (int frame = 0; frame < frames; ++frame) {
    const double start_ms = test::thread_ms();
    std::vector<std::size_t> present;
    for (std::size_t i = 0; i < entries.size(); ++i)
      if (entries[i].frame <= frame) present.push_back(i);
    const std::size_t n = present.size();
    std::vector<std::vector<SceneTree>> scenes(n);
    std::vector<std::vector<SceneBody>> others(n);
    std::vector<RadarScene> radar_scenes;
    std::vector<CollisionQueries> probes;
    std::vector<AdvancedBody> advanced;
    radar_scenes.reserve(n);
    probes.reserve(n);
    for (std::size_t a = 0; a < n; ++a) {
      scenes[a].push_back({{&room_tree, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic});
      others[a].resize(1);
      for (std::size_t b = 0; b < n; ++b) {
        if (b == a) continue;
        Body& other = bodies[present[b]];
        scenes[a].push_back({{&entries[present[b]].thing->tree, other.T_world_object}, SurfaceKind::kObject});
        others[a].push_back({&other, bodies[present[a]].mass.mass_kg / other.mass.mass_kg});
      }
    }
    for (std::size_t a = 0; a < n; ++a) {
      Body& body = bodies[present[a]];
      radar_scenes.push_back({scenes[a], {}});
      probes.push_back(
          make_collision_queries(radar, field, entries[present[a]].thing->tree, radar_scenes[a]));
      probes[a].others = others[a];
      advanced.push_back({.body = &body,
                          .probe = &probes[a],
                          .mass_kg = body.mass.mass_kg,
                          .dt_s = kBenchFrame_s,
                          .is_undisturbed = was_advanced[present[a]],
                          .moved = [&scenes, &body, a, n] {
                            for (std::size_t b = 0; b < n; ++b)
                              if (b != a)
                                scenes[b][1 + (a < b ? a : a - 1)].instance.T_world_mesh =
                                    body.T_world_object;
                          }});
      was_advanced[present[a]] = true;
    }
    advance_together(advanced, {}, system);
    result.frames.samples_ms.push_back(test::thread_ms() - start_ms);
  }
  for (const Body& body : bodies) {
    result.T_world_object.push_back(body.T_world_object);
    result.asleep += body.asleep;
  }
  return result;
}

}  // namespace roomradar::bench
