// physics_bench_scenes.cpp: builds meshes and moves bodies among them.
#include "physics_bench_scenes.hpp"

#include <array>
#include <utility>

#include "app/physics/rigid_motion.hpp"

namespace roomradar::bench {

Mesh box_mesh(const Eigen::Vector3d& size_m) {
  Mesh mesh = ball_mesh(1.0, 1);
  for (Eigen::Vector3f& v : mesh.vertices) v = v.cwiseSign().cwiseProduct((0.5 * size_m).cast<float>());
  return mesh;
}

Mesh ball_mesh(double radius_m, int n) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
          Eigen::Vector3d p;
          p[axis] = side;
          p[(axis + 1) % 3] = 2.0 * i / n - 1.0;
          p[(axis + 2) % 3] = side * (2.0 * j / n - 1.0);
          if (n > 1) {  // even spacing over the sphere
            for (int k = 1; k < 3; ++k) p[(axis + k) % 3] = std::tan(M_PI / 4.0 * p[(axis + k) % 3]);
          }
          mesh.vertices.push_back((radius_m * p.normalized()).cast<float>());
        }
      }
      const auto row = static_cast<std::uint32_t>(n + 1);
      for (std::uint32_t j = 0; j + 1 < row; ++j) {
        for (std::uint32_t i = 0; i + 1 < row; ++i) {
          const std::uint32_t a = first + j * row + i;
          mesh.triangles.push_back({a, a + 1, a + row + 1});
          mesh.triangles.push_back({a, a + row + 1, a + row});
        }
      }
    }
  }
  return mesh;
}

Thing::Thing(std::string thing_name, Mesh thing_mesh)
    : name(std::move(thing_name)), mesh(std::move(thing_mesh)) {
  tree.build_by_place(mesh);
  mass = mass_properties(mesh, tree.is_closed());
}

void World::add(const Mesh& mesh, SurfaceKind kind) {
  trees_.emplace_back().build_by_place(mesh);
  kinds_.push_back(kind);
}

StepReport World::step(Body& body, const Thing& thing, double dt_s, const PhysicsConfig& config,
                       std::span<const SceneTree> others) {
  scene_.assign(others.begin(), others.end());
  for (std::size_t i = 0; i < trees_.size(); ++i)
    scene_.push_back({{&trees_[i], Eigen::Isometry3d::Identity()}, kinds_[i]});
  const RadarScene scene{scene_, {}};
  return advance(body, dt_s, make_collision_queries(radar_, thing.tree, scene), config);
}

double energy_of(const Body& body, const PhysicsConfig& config) {
  return energy({body.velocity_world_mps, body.angular_velocity_world_rad_s}, inertia_world_m2(body)) -
         config.gravity_world_mps2.dot(centre_world(body));
}

}  // namespace roomradar::bench
