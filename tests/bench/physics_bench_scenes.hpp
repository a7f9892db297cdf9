// physics_bench_scenes.hpp: bodies and surfaces for the physics bench, and one body's world of meshes.
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

/// A box about the origin, outward.
Mesh box_mesh(const Eigen::Vector3d& size_m);
/// A ball about the origin: a cube's grid of 6 n^2 squares blown up to a sphere, outward; 12 n^2 triangles.
Mesh ball_mesh(double radius_m, int n);

/// What is thrown, dropped and set down.
struct Thing {
  std::string name;
  Mesh mesh;
  TriangleTree tree;
  MassProperties mass;

  Thing(std::string name, Mesh mesh);
};

/// Meshes that stand still, and the radar that looks at them.
class World {
 public:
  void add(const Mesh& mesh, SurfaceKind kind = SurfaceKind::kStatic);
  void replace(std::size_t which, const Mesh& mesh) { trees_[which].build_in_order(mesh); }
  /// Also these bodies, as objects.
  StepReport step(Body& body, const Thing& thing, double dt_s, const PhysicsConfig& config,
                  std::span<const SceneTree> others = {});

 private:
  std::vector<TriangleTree> trees_;
  std::vector<SurfaceKind> kinds_;
  std::vector<SceneTree> scene_;
  CyberRadar radar_;
  ProximityQuery field_;
};

/// J/kg against the world's zero height: of motion and of place.
double energy_of(const Body& body, const PhysicsConfig& config);

}  // namespace roomradar::bench
