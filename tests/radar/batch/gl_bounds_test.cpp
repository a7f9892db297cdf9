// gl_bounds_test.cpp: the GL radar's bounds and contacts against the exact reference on random poses.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "radar/batch/gl_radar.hpp"
#include "tests/radar/judged_scene.hpp"
#include "tests/radar/shapes.hpp"
#include "tests/support/exact_travel.hpp"

namespace roomradar::gl_bounds_test {
namespace {

struct Throw {
  Eigen::Isometry3d T_world_object;
  Eigen::Vector3d direction;
  double distance_m = 0.0;
};

/// Queries all throws of an object at a scene in one call and checks each result. Skips throws that begin in
/// an overlap, according to the CPU radar's exact mode. Returns the number of throws checked.
int expect_bounds(const std::string& name, const Mesh& object, const Mesh& scene,
                  const std::vector<Throw>& throws, int resolution_px) {
  GlContext context;
  GlRadar radar(context, {.resolution_px = resolution_px, .atlas_px = 1024});
  GpuMesh object_gpu(context), scene_gpu(context);
  object_gpu.upload(object, MeshUsage::kStatic);
  scene_gpu.upload(scene, MeshUsage::kStatic);
  const GpuSceneMesh scene_mesh{{&scene_gpu, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic};
  std::vector<GlQuery> queries;
  for (const Throw& t : throws) {
    queries.push_back({{&object_gpu, t.T_world_object}, t.direction, t.distance_m, GlQuery::kNotInScene});
  }
  std::vector<Contact> contacts(queries.size());
  radar.query_all(queries, {&scene_mesh, 1}, contacts);

  JudgedMesh judged(object);
  JudgedScene judged_scene;
  judged_scene.add(scene);
  CyberRadar exact;
  int free = 0, touching = 0, found = 0;
  for (std::size_t i = 0; i < throws.size(); ++i) {
    judged.T_world_mesh = throws[i].T_world_object;
    const Contact truth = judged_scene.query(exact, judged, throws[i].direction, throws[i].distance_m);
    if (truth.status == ContactStatus::kOverlap) continue;
    const auto truth_m = judged_scene.contact_distance_m(judged, throws[i].direction, throws[i].distance_m);
    EXPECT_TRUE(holds(contacts[i], truth_m, throws[i].distance_m))
        << name << " at " << resolution_px << " px, pose " << i << ": "
        << describe(judged, throws[i].direction, throws[i].distance_m, contacts[i], truth_m);
    // A reported contact must be real: something is touched within the distance, perhaps earlier.
    EXPECT_TRUE(truth_m || !contacts[i]) << name << ", pose " << i << ": touches nothing";
    ++free;
    touching += truth_m ? 1 : 0;
    found += contacts[i] ? 1 : 0;
  }
  std::printf("%s at %d px: %d of %zu poses free, %d touch, %d found\n", name.c_str(), resolution_px, free,
              throws.size(), touching, found);
  return free;
}

/// Throws from above, in directions up to about 60 degrees off straight down.
std::vector<Throw> throws_at_ground(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> distance_m(0.1, 1.2);
  std::vector<Throw> throws;
  for (int i = 0; i < count; ++i) {
    Eigen::Isometry3d T(shapes::random_rotation(random));
    T.pretranslate(Eigen::Vector3d(0, 0, 0.5) +
                   Eigen::Vector3d(0.5, 0.5, 0.15).cwiseProduct(shapes::random_point(random)));
    const Eigen::Vector3d direction = Eigen::Vector3d(0, 0, -1) + 0.9 * shapes::random_point(random);
    throws.push_back({T, direction, distance_m(random)});
  }
  return throws;
}

/// Throws in all directions, from positions where much of the scene is inside the object's box.
std::vector<Throw> throws_around(double reach_m, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Throw> throws;
  for (int i = 0; i < count; ++i) {
    Eigen::Isometry3d T(shapes::random_rotation(random));
    T.pretranslate(reach_m * shapes::random_point(random));
    throws.push_back({T, shapes::random_point(random), 0.4});
  }
  return throws;
}

/// Needles that point up from the ground, thinner than any pixel.
Mesh needles() {
  std::vector<std::pair<Mesh, Eigen::Vector3f>> parts;
  for (int i = -4; i <= 4; ++i) {
    for (int j = -4; j <= 4; ++j) {
      parts.push_back({shapes::box({0.0005F, 0.0003F, 0.2F}),
                       {0.2F * static_cast<float>(i), 0.2F * static_cast<float>(j), 0.0F}});
    }
  }
  return shapes::together(parts);
}

TEST(GlBounds, HoldOnThousandsOfThrowsAtBumpyGround) {
  const Mesh ground = shapes::bumpy_ground(30);
  const std::vector<std::pair<std::string, Mesh>> objects = {
      {"box", shapes::box({0.25F, 0.15F, 0.1F})},
      {"ball", shapes::ball(0.12F, 12, 16)},
      {"bumpy torus", shapes::torus(48, 24, 0.1F, 0.04F, 0.015F)},
      {"cup", shapes::cup(0.1F, 0.2F, 0.01F, 24)},
      {"chair", shapes::chair()},
      {"needle", shapes::box({0.3F, 0.0002F, 0.0001F})},
      {"sheet", shapes::floor(0.15F, 0.0F)}};
  int judged = 0;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    for (const int resolution_px : {7, 48}) {
      judged += expect_bounds(objects[i].first, objects[i].second, ground,
                              throws_at_ground(220, static_cast<unsigned>(i)), resolution_px);
    }
  }
  EXPECT_GT(judged, 2900);
}

TEST(GlBounds, HoldWhereTheSceneIsThinnerThanAPixel) {
  expect_bounds("box at needles", shapes::box({0.25F, 0.15F, 0.1F}), needles(), throws_at_ground(300, 20),
                32);
  expect_bounds("needle at needles", shapes::box({0.3F, 0.001F, 0.001F}), needles(),
                throws_at_ground(300, 21), 32);
}

TEST(GlBounds, FreePosesOfConcaveObjectsWithSceneInTheirHollowsAreFree) {
  const Mesh peg = shapes::ball(0.02F, 8, 12);
  int judged = 0;
  judged += expect_bounds("bumpy torus", shapes::torus(32, 16, 0.1F, 0.04F, 0.015F), peg,
                          throws_around(0.12, 1800, 30), 32);
  judged += expect_bounds("cup", shapes::cup(0.1F, 0.2F, 0.01F, 24), peg, throws_around(0.15, 1500, 31), 32);
  judged += expect_bounds("chair", shapes::chair(), peg, throws_around(0.4, 1500, 32), 32);
  EXPECT_GT(judged, 2900);
}

TEST(GlBounds, HoldAndAreNarrowAtTheExtremes) {
  GlContext context;
  GlRadar radar(context, {.resolution_px = 64});
  for (const double place_m : {0.0, 1e6, -1e6}) {
    for (const double size_m : {0.001, 0.2, 50.0}) {
      for (const double distance_m : {1e-4, 1.0, 100.0}) {
        for (const double part : {0.0, 0.3, 0.999, 1.5}) {  // floor, as a fraction of the distance
          const auto side = static_cast<float>(size_m);
          JudgedMesh cube(shapes::box({side, side, side}));
          Mesh floor_mesh = shapes::floor(2.0F * side, 0.0F);
          floor_mesh.origin = Eigen::Vector3d::Constant(place_m);
          JudgedScene scene;
          scene.add(floor_mesh);
          cube.T_world_mesh.pretranslate(floor_mesh.origin +
                                         Eigen::Vector3d(0, 0, 0.5 * double{side} + part * distance_m));
          GpuMesh cube_gpu(context), floor_gpu(context);
          cube_gpu.upload(cube.mesh, MeshUsage::kStatic);
          floor_gpu.upload(floor_mesh, MeshUsage::kStatic);
          const GpuSceneMesh target{{&floor_gpu, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic};
          const Eigen::Vector3d down(0, 0, -1);
          const Contact got = radar.query({&cube_gpu, cube.T_world_mesh}, down, distance_m, {&target, 1});
          // At 1e6 m the world's double resolution displaces the cube by 1e-10 m.
          const auto truth_m = exact_travel(cube.mesh, cube.T_world_mesh, down, distance_m, floor_mesh,
                                            Eigen::Isometry3d::Identity(), ExactMethod::kBruteForce, 1e-9);
          EXPECT_TRUE(holds(got, truth_m, distance_m)) << place_m << " " << size_m << " " << part << " "
                                                       << describe(cube, down, distance_m, got, truth_m);
          if (!got) continue;
          EXPECT_LE(got.upper_m - got.lower_m, 5e-6 * (size_m + distance_m)) << "faces are flat";
        }
      }
    }
  }
}

}  // namespace
}  // namespace roomradar::gl_bounds_test
