// physics_bench_scenes.hpp: bodies and surfaces for physics_bench, and a world of meshes for one body.
#pragma once
#include <list>
#include <string>
#include <vector>

#include "app/physics/mass_properties.hpp"
#include "app/physics/physics.hpp"
#include "mapping/types/mesh.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "radar/motion/proximity.hpp"

namespace roomradar::bench {

/// Axis-aligned box about the origin, facing outwards.
Mesh box_mesh(const Eigen::Vector3d& size_m);
/// Ball about the origin, facing outwards: the 6 n^2 squares of a cube's grid projected onto a sphere, 12 n^2
/// triangles.
Mesh ball_mesh(double radius_m, int n);

/// An object that is thrown, dropped or set down.
struct Thing {
  std::string name;
  Mesh mesh;
  TriangleTree tree;
  MassProperties mass;

  Thing(std::string name, Mesh mesh);
};

/// Static meshes, and the radar that queries them.
class World {
 public:
  void add(const Mesh& mesh, SurfaceKind kind = SurfaceKind::kStatic);
  void replace(std::size_t which, const Mesh& mesh) { trees_[which].build_in_order(mesh); }
  /// `others` are further bodies, treated as objects.
  StepReport step(Body& body, const Thing& thing, double dt_s, const PhysicsConfig& config,
                  std::span<const SceneTree> others = {});

 private:
  std::vector<TriangleTree> trees_;
  std::vector<SurfaceKind> kinds_;
  std::vector<SceneTree> scene_;
  CyberRadar radar_;
};

/// Kinetic plus potential energy, J/kg, relative to the world's zero height.
double energy_of(const Body& body, const PhysicsConfig& config);

}  // namespace roomradar::bench
