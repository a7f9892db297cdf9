// body_group.hpp: bodies that are advanced together over static surfaces, for tests and benchmarks.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <list>
#include <vector>

#include "app/physics/physics.hpp"
#include "mapping/types/mesh.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "radar/motion/proximity.hpp"

namespace roomradar::test {

class BodyGroup {
 public:
  explicit BodyGroup(const std::vector<Mesh>& meshes) : bodies(meshes.size()), trees_(meshes.size()) {
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      trees_[i].build_by_place(meshes[i]);
      bodies[i].mass = mass_properties(meshes[i], trees_[i].is_closed());
    }
    mass_kg.assign(meshes.size(), 1.0);
    is_carried.assign(meshes.size(), false);
    is_present.assign(meshes.size(), true);
    is_undisturbed.assign(meshes.size(), false);
  }
  BodyGroup(BodyGroup&&) = default;

  void put(std::size_t body, const Eigen::Vector3d& position_world) {
    bodies[body].T_world_object.translation() = position_world;
  }
  /// Adds a surface at rest.
  void add_surface(const Mesh& mesh, SurfaceKind kind = SurfaceKind::kStatic) {
    surfaces_.push_back({{}, kind});
    surfaces_.back().tree.build_by_place(mesh);
  }
  void remove_surfaces() { surfaces_.clear(); }
  /// Gives each body the mass of its mesh; before, each has 1 kg.
  void weigh() {
    for (std::size_t i = 0; i < bodies.size(); ++i) mass_kg[i] = bodies[i].mass.mass_kg;
  }

  void step(const PhysicsConfig& config) {
    std::vector<std::size_t> present;
    for (std::size_t i = 0; i < bodies.size(); ++i)
      if (is_present[i]) present.push_back(i);
    const std::size_t n = present.size(), surfaces = surfaces_.size();
    std::vector<std::vector<SceneTree>> scenes(n);
    std::vector<std::vector<SceneBody>> others(n);
    std::vector<RadarScene> radar_scenes;
    std::vector<CollisionQueries> probes;
    std::vector<AdvancedBody> advanced;
    radar_scenes.reserve(n);
    probes.reserve(n);
    for (std::size_t i = 0; i < n; ++i) {
      for (const Surface& surface : surfaces_)
        scenes[i].push_back({{&surface.tree, Eigen::Isometry3d::Identity()}, surface.kind});
      others[i].resize(surfaces);
      for (std::size_t j = 0; j < n; ++j) {
        if (j == i) continue;
        Body& other = bodies[present[j]];
        scenes[i].push_back({{&trees_[present[j]], other.T_world_object}, SurfaceKind::kObject});
        others[i].push_back({&other, 1.0});
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t body = present[i];
      radar_scenes.push_back({scenes[i], {}});
      probes.push_back(make_collision_queries(radar_, trees_[body], radar_scenes[i]));
      probes[i].others = others[i];
      advanced.push_back({.body = &bodies[body],
                          .probe = &probes[i],
                          .scene = scenes[i],
                          .mass_kg = mass_kg[body],
                          .is_carried = is_carried[body],
                          .dt_s = frame_s,
                          .is_undisturbed = is_undisturbed[body]});
    }
    advance_together(advanced, config, system);
    for (const AdvancedBody& one : advanced) deepest_m = std::max(deepest_m, one.report.deepest_overlap_m);
  }
  void run(double seconds, const PhysicsConfig& config) {
    for (double t = 0.0; t < seconds - 1e-9; t += frame_s) step(config);
  }
  [[nodiscard]] bool all_asleep() const {
    return std::all_of(bodies.begin(), bodies.end(), [](const Body& body) { return body.asleep; });
  }
  [[nodiscard]] Eigen::Vector3d momentum() const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < bodies.size(); ++i) sum += mass_kg[i] * bodies[i].velocity_world_mps;
    return sum;
  }
  [[nodiscard]] Eigen::Vector3d angular_momentum() const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < bodies.size(); ++i)
      sum += mass_kg[i] * (inertia_world_m2(bodies[i]) * bodies[i].angular_velocity_world_rad_s +
                           centre_world(bodies[i]).cross(bodies[i].velocity_world_mps));
    return sum;
  }

  std::vector<Body> bodies;
  std::vector<double> mass_kg;
  std::vector<bool> is_carried;
  std::vector<bool> is_present;      ///< others are neither advanced nor touched
  std::vector<bool> is_undisturbed;  ///< see AdvancedBody::is_undisturbed
  ContactSystem system;
  double frame_s = 1.0 / 30.0;
  double deepest_m = 0.0;  ///< deepest overlap of a body with anything so far

 private:
  struct Surface {
    TriangleTree tree;
    SurfaceKind kind;
  };
  std::vector<TriangleTree> trees_;
  std::list<Surface> surfaces_;
  CyberRadar radar_;
};

}  // namespace roomradar::test
