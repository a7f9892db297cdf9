// mapped_floor_test.cpp: bodies that slide over floors of irregular triangles, with and without a
// map's noise, and against steps and walls.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "app/physics/physics.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar::mapped_floor_test {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kFrame_s = 1.0 / 30.0, kSpeed_mps = 1.5, kLane_m = 2.0;

/// Lanes of each shape: 40 with ROOMRADAR_LONG_TESTS.
int lanes() { return std::getenv("ROOMRADAR_LONG_TESTS") != nullptr ? 40 : 4; }

/// A floor of [-half, half]^2 at z = 0: cells of some 3 cm with corners moved at random, like a simplified
/// map's triangles. Heights have normally distributed noise of standard deviation noise_m.
Mesh mapped_floor(double noise_m, unsigned seed, double half_m = 1.3) {
  constexpr double kCell_m = 0.03;
  Mesh mesh;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> aside(-0.3 * kCell_m, 0.3 * kCell_m);
  std::normal_distribution<double> noise(0.0, noise_m);
  const auto cells = static_cast<std::uint32_t>(2.0 * half_m / kCell_m);
  for (std::uint32_t j = 0; j <= cells; ++j)
    for (std::uint32_t i = 0; i <= cells; ++i) {
      const double x = i * kCell_m - half_m + aside(random), y = j * kCell_m - half_m + aside(random);
      mesh.vertices.push_back(Vec3(x, y, noise_m > 0.0 ? noise(random) : 0.0).cast<float>());
    }
  for (std::uint32_t j = 0; j < cells; ++j)
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = j * (cells + 1) + i, b = a + 1, c = a + cells + 1, d = c + 1;
      if (random() % 2 == 0) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({b, d, c});
      } else {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({a, d, c});
      }
    }
  return mesh;
}

/// Adds a block that begins at x_m and rises over the floor.
Mesh with_block(const Mesh& floor, float x_m, float height_m) {
  const Mesh block = shapes::box({0.6F, 1.0F, 2.0F * height_m});
  const std::vector<std::pair<Mesh, Eigen::Vector3f>> parts = {{floor, Eigen::Vector3f::Zero()},
                                                               {block, {x_m + 0.3F, 0.1F, 0.0F}}};
  return shapes::together(parts);
}

/// A closed prism about the z axis.
Mesh prism(std::uint32_t sides, float radius_m, float height_m) {
  Mesh mesh;
  for (const float side : {-0.5F, 0.5F})
    for (std::uint32_t i = 0; i < sides; ++i) {
      const float a = 2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(sides);
      mesh.vertices.emplace_back(radius_m * std::cos(a), radius_m * std::sin(a), side * height_m);
    }
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t next = (i + 1) % sides;
    mesh.triangles.push_back({i, next, sides + next});
    mesh.triangles.push_back({i, sides + next, sides + i});
    if (i == 0 || i + 1 == sides) continue;
    mesh.triangles.push_back({0, i + 1, i});
    mesh.triangles.push_back({sides, sides + i, sides + i + 1});
  }
  return mesh;
}

Mesh lying(Mesh mesh) {
  for (Eigen::Vector3f& v : mesh.vertices) v = {v.z(), v.y(), -v.x()};
  return mesh;
}

struct Shape {
  std::string name;
  Mesh mesh;
  double half_height_m;
};

std::vector<Shape> all_shapes() {
  return {
      {"ball", shapes::ball(0.05F, 32, 64), 0.05},     {"puck", prism(32, 0.06F, 0.03F), 0.015},
      {"cube", shapes::box({0.1F, 0.1F, 0.1F}), 0.05}, {"marble", shapes::ball(0.01F, 12, 24), 0.01},
      {"card", prism(4, 0.06F, 0.0008F), 0.0004},      {"needle", lying(prism(6, 0.0015F, 0.2F)), 0.0013}};
}

/// A body on static meshes, moved with the real radar.
class World {
 public:
  explicit World(const Mesh& floor) { floor_.build_by_place(floor); }

  /// Puts the body at rest on the floor at a point, turned by an angle about the vertical.
  void put(const Shape& shape, const Vec3& at, double angle_rad) {
    object_.build_by_place(shape.mesh);
    body = {};
    body.mass = mass_properties(shape.mesh, object_.is_closed());
    body.T_world_object.rotate(Eigen::AngleAxisd(angle_rad, Vec3::UnitZ()));
    body.T_world_object.pretranslate(at + Vec3(0, 0, shape.half_height_m + 0.004));
    PhysicsConfig sticky;
    sticky.friction = 1.0;
    sticky.rolling = 0.5;
    for (int frame = 0; frame < 20; ++frame) step(sticky);
    body.asleep = false;
  }
  void step(const PhysicsConfig& config) {
    const SceneTree tree{{&floor_, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic};
    const RadarScene scene{{&tree, 1}, {}};
    const StepReport report = advance(body, kFrame_s, make_collision_queries(radar_, object_, scene), config);
    EXPECT_EQ(report.status, StepStatus::kMoved);
    deepest_m = std::max(deepest_m, report.deepest_overlap_m);
  }

  Body body;
  double deepest_m = 0.0;

 private:
  TriangleTree floor_, object_;
  CyberRadar radar_;
};

struct Lane {
  double end_mps = 0.0;  ///< speed after the lane; 0 if the body did not reach its end in 2 s
  double lift_m = 0.0, aside_m = 0.0;
};

PhysicsConfig frictionless() {
  PhysicsConfig config;
  config.friction = 0.0;
  config.rolling = 0.0;
  return config;
}

/// Slides a body over the lane that has its middle at the origin.
Lane slide(World& world, const Shape& shape, double angle_rad, const PhysicsConfig& config) {
  const Vec3 along(std::cos(angle_rad), std::sin(angle_rad), 0.0), aside = Vec3::UnitZ().cross(along);
  world.put(shape, -0.5 * kLane_m * along, angle_rad);
  const Vec3 start = centre_world(world.body);
  world.body.velocity_world_mps = kSpeed_mps * along;
  Lane lane;
  for (int frame = 0; frame < 60; ++frame) {
    world.step(config);
    const Vec3 way = centre_world(world.body) - start;
    lane.lift_m = std::max(lane.lift_m, way.z());
    lane.aside_m = std::max(lane.aside_m, std::abs(way.dot(aside)));
    if (way.dot(along) < kLane_m) continue;
    lane.end_mps = world.body.velocity_world_mps.norm();
    break;
  }
  return lane;
}

/// Angles of lanes, every fourth along the cells or their diagonals.
double angle_of(int lane) { return lane % 4 == 3 ? lane / 4 * std::numbers::pi / 4.0 : 0.7 + 2.4 * lane; }

TEST(MappedFloor, BodiesWithoutFrictionKeepTheirSpeedOverFlatTriangles) {
  World world(mapped_floor(0.0, 1));
  for (const Shape& shape : all_shapes())
    for (int i = 0; i < lanes(); ++i) {
      const Lane lane = slide(world, shape, angle_of(i), frictionless());
      EXPECT_NEAR(lane.end_mps, kSpeed_mps, 1e-3) << shape.name << ", lane " << i;
      EXPECT_LT(lane.lift_m, 2.5e-4) << shape.name << ", lane " << i;
      EXPECT_LT(lane.aside_m, 1e-3) << shape.name << ", lane " << i;
    }
  EXPECT_EQ(world.deepest_m, 0.0);
}

TEST(MappedFloor, BodiesWithoutFrictionKeepTheirSpeedOverAMapsNoise) {
  constexpr double kNoise_m = 0.0005;  // a simulated Kinect's map
  World world(mapped_floor(kNoise_m, 2));
  for (const Shape& shape : all_shapes())
    for (int i = 0; i < lanes(); ++i) {
      const Lane lane = slide(world, shape, angle_of(i), frictionless());
      EXPECT_NEAR(lane.end_mps, kSpeed_mps, 0.03) << shape.name << ", lane " << i;
      EXPECT_LT(lane.lift_m, 6.0 * kNoise_m)  // from the lowest of its start to the highest of its lane
          << shape.name << ", lane " << i;
      EXPECT_LT(lane.aside_m, 0.03) << shape.name << ", lane " << i;
    }
  EXPECT_EQ(world.deepest_m, 0.0);
}

TEST(MappedFloor, AStepOfACentimetreStopsWhatSlidesAgainstIt) {
  World world(with_block(mapped_floor(0.0005, 4), 0.0F, 0.01F));
  for (const Shape& shape : all_shapes()) {
    if (shape.name != "puck" && shape.name != "marble")
      continue;  // others roll or tip over it, or are thinner
    world.put(shape, Vec3(-0.4, 0.1, 0), 0.0);
    world.body.velocity_world_mps = {kSpeed_mps, 0, 0};
    double farthest_m = -1.0;
    for (int frame = 0; frame < 45; ++frame) {
      world.step(frictionless());
      farthest_m = std::max(farthest_m, world.body.T_world_object.translation().x());
    }
    EXPECT_LT(farthest_m, 0.02) << shape.name;
    EXPECT_LT(world.body.velocity_world_mps.x(), 0.2) << shape.name;
  }
}

TEST(MappedFloor, AWallStopsABodyAndLeavesItOnTheFloor) {
  World world(with_block(mapped_floor(0.0005, 5), 0.5F, 0.5F));
  for (const Shape& shape : all_shapes()) {
    world.put(shape, Vec3(-0.1, 0.1, 0), 0.0);
    const double rest_m = centre_world(world.body).z();
    world.body.velocity_world_mps = {kSpeed_mps, 0, 0};
    double highest_m = -1.0;
    for (int frame = 0; frame < 40; ++frame) {
      world.step(frictionless());
      highest_m = std::max(highest_m, centre_world(world.body).z());
      ASSERT_LT(centre_world(world.body).x(), 0.5) << shape.name;
    }
    EXPECT_LT(std::abs(world.body.velocity_world_mps.x()), 0.1) << shape.name;
    EXPECT_LT(highest_m - rest_m, 0.01) << shape.name;
  }
}

TEST(MappedFloor, BodiesComeToRestOnNoise) {
  World world(mapped_floor(0.001, 6));
  for (const Shape& shape : all_shapes()) {
    if (shape.name == "needle") continue;  // rolls on from bump to bump
    world.put(shape, Vec3::Zero(), 0.4);
    world.body.velocity_world_mps = {0.5, 0.2, 0.0};
    for (int frame = 0; frame < 150 && !world.body.asleep; ++frame) world.step({});
    EXPECT_TRUE(world.body.asleep) << shape.name;
  }
}

}  // namespace
}  // namespace roomradar::mapped_floor_test
