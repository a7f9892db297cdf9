// radar_pictures_test.cpp: the CPU radar draws the same images as GL, and its M is nowhere less.
#include "radar/exact/radar_pictures.hpp"
#include "radar/exact/turned_bounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "radar/batch/gl_radar.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "radar/geometry/frame_along.hpp"
#include "tests/radar/judged_scene.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar::radar_pictures_test {
namespace {

constexpr int kResolution_px = 96;
constexpr double kDistance_m = 2.0;   // beyond the whole scene: R farther than d does not matter
constexpr float kRounding_m = 5e-5F;  // GL draws in float, over 2 m
const Eigen::Vector3d kDown = -Eigen::Vector3d::UnitZ();

class RadarPicturesTest : public ::testing::Test {
 protected:
  GlContext context;
  GlRadar gl{context, {.resolution_px = kResolution_px, .exact_fallback = false}};

  RadarPictures of_gl(const Mesh& object, const Eigen::Isometry3d& T_world_object,
                      const Eigen::Vector3d& direction, const Mesh& scene,
                      const Eigen::Isometry3d& T_world_scene) {
    GpuMesh object_mesh(context), scene_mesh(context);
    object_mesh.upload(object, MeshUsage::kStatic);
    scene_mesh.upload(scene, MeshUsage::kStreamed);
    const GpuSceneMesh in_scene{{&scene_mesh, T_world_scene}, SurfaceKind::kStatic};
    static_cast<void>(gl.query({&object_mesh, T_world_object}, direction, kDistance_m, {&in_scene, 1}));
    return gl.pictures();
  }
};

struct Differences {
  int both = 0, one_only = 0, differ = 0;
  float most_m = 0.0F;
};
/// Counts pixels that only one image has, and pixels that differ by more than the tolerance. The tolerance is
/// depth rounding, plus the effect of a small sideways shift on the local slope.
Differences compare(const Image<float>& a, const Image<float>& b, float nothing) {
  Differences result;
  const auto has = [&](float v) { return !std::isnan(v) && v != nothing; };
  const auto steepness_m = [&](int x, int y) {
    float low_m = a.at(x, y), high_m = low_m;
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, a.height - 1); ++j) {
      for (int i = std::max(x - 1, 0); i <= std::min(x + 1, a.width - 1); ++i) {
        if (!has(a.at(i, j))) continue;
        low_m = std::min(low_m, a.at(i, j));
        high_m = std::max(high_m, a.at(i, j));
      }
    }
    return high_m - low_m;
  };
  constexpr float kAcross_px = 2e-3F;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const float in_a = a.at(x, y), in_b = b.at(x, y);
      result.one_only += has(in_a) != has(in_b) ? 1 : 0;
      if (!has(in_a) || !has(in_b)) continue;
      ++result.both;
      const float apart_m = std::abs(in_a - in_b);
      result.differ += apart_m > kRounding_m + kAcross_px * steepness_m(x, y) ? 1 : 0;
      result.most_m = std::max(result.most_m, apart_m);
    }
  }
  return result;
}

/// One pixel in 200 may differ: rounding decides on which side of its sample an edge (of the outline or of a
/// depth discontinuity) passes.
void expect_same(const Image<float>& ours, const Image<float>& theirs, float nothing, const char* what) {
  ASSERT_EQ(ours.width, theirs.width);
  ASSERT_EQ(ours.height, theirs.height);
  const Differences d = compare(ours, theirs, nothing);
  EXPECT_GT(d.both, 500) << what;
  EXPECT_LE(d.one_only, d.both / 200) << what << ": of " << d.both;
  EXPECT_LE(d.differ, d.both / 200) << what << ": of " << d.both << ", by up to " << d.most_m << " m";
}

TEST_F(RadarPicturesTest, AreTheSameDepthsAsGls) {
  std::mt19937 random(3);
  const Mesh ground = shapes::bumpy_ground(60);
  const JudgedMesh scene(ground);
  const SceneTree in_scene{{&scene.tree, scene.T_world_mesh}, SurfaceKind::kStatic};
  for (const Mesh& mesh : {shapes::box({0.2F, 0.3F, 0.25F}), shapes::torus(60, 40, 0.12F, 0.05F, 0.02F),
                           shapes::cup(0.1F, 0.2F, 0.01F, 40), shapes::chair()}) {
    for (int i = 0; i < 8; ++i) {
      Eigen::Isometry3d T(shapes::random_rotation(random));
      T.pretranslate(Eigen::Vector3d(0.1, 0.05, 0.75) + 0.1 * shapes::random_point(random));
      const JudgedMesh object(mesh, T);
      const Eigen::Vector3d direction = kDown + 0.3 * shapes::random_point(random);
      const RadarPictures ours = radar_pictures(
          {.object = {&object.tree, T}, .direction_world = direction, .distance_m = kDistance_m},
          {.trees = {&in_scene, 1}, .depths = {}}, kResolution_px);
      const RadarPictures theirs = of_gl(mesh, T, direction, ground, scene.T_world_mesh);
      ASSERT_NEAR(ours.volume.pixel_m, theirs.volume.pixel_m, 1e-9);
      ASSERT_NEAR(ours.volume.depth_m, theirs.volume.depth_m, 1e-9);
      ASSERT_LT((ours.volume.origin_world - theirs.volume.origin_world).norm(), 1e-9);
      ASSERT_LT((ours.volume.x_world - theirs.volume.x_world).norm(), 1e-9);
      const auto nothing = static_cast<float>(theirs.volume.depth_m);
      expect_same(ours.mask_m, theirs.mask_m, nothing, "M");
      expect_same(ours.range_m, theirs.range_m, nothing, "R");
      expect_same(ours.lookat_m, theirs.lookat_m, nothing, "L");
    }
  }
}

TEST_F(RadarPicturesTest, ADepthImageIsDrawnLikeItsMesh) {
  DepthImage depth_m(160, 120);
  for (int y = 0; y < depth_m.height; ++y) {
    for (int x = 0; x < depth_m.width; ++x) {
      depth_m.at(x, y) =
          1.0F + (x > 90 ? 0.1F : 0.0F) + 0.05F * std::sin(0.1F * static_cast<float>(x + 2 * y));
    }
  }
  SceneDepth scene;
  scene.depth_m = &depth_m;
  scene.camera = {160, 120, 130.0, 131.0, 79.3, 60.2};
  scene.max_jump_m = 0.2F;
  const Mesh ball = shapes::ball(0.15F, 30, 40);
  const JudgedMesh object(ball, Eigen::Isometry3d(Eigen::Translation3d(0.05, 0.0, 0.6)));
  const Eigen::Vector3d direction(0.1, 0.05, 1.0);
  const RadarPictures ours = radar_pictures({.object = {&object.tree, object.T_world_mesh},
                                             .direction_world = direction,
                                             .distance_m = kDistance_m},
                                            {.trees = {}, .depths = {&scene, 1}}, kResolution_px);
  const RadarPictures theirs =
      of_gl(ball, object.T_world_mesh, direction, mesh_of(scene), scene.T_world_camera);
  const auto nothing = static_cast<float>(theirs.volume.depth_m);
  expect_same(ours.range_m, theirs.range_m, nothing, "R");
  expect_same(ours.lookat_m, theirs.lookat_m, nothing, "L");
}

TEST_F(RadarPicturesTest, MOfTheRadarIsNowhereLessThanGlsAndLessThanAPixelMore) {
  const Mesh mesh = shapes::torus(60, 40, 0.12F, 0.05F, 0.02F);
  const Mesh ground = shapes::bumpy_ground(60);
  std::mt19937 random(4);
  for (int i = 0; i < 6; ++i) {
    Eigen::Isometry3d T(shapes::random_rotation(random));
    T.pretranslate(Eigen::Vector3d(0.1, 0.05, 0.75));
    const JudgedMesh object(mesh, T);
    const RadarPictures theirs = of_gl(mesh, T, kDown, ground, Eigen::Isometry3d::Identity());
    TurnedTree turned;
    turned.tree = &object.tree;
    turned.R_frame_mesh = frame_along(T.linear().transpose() * kDown);
    ObjectHeightMap front;
    front.build(turned, kResolution_px);
    std::vector<PendingNode> pending;
    const Eigen::AlignedBox3d bounds = turned_bounds(turned, 0.0, pending);
    const double pixel_m = theirs.volume.pixel_m;
    const Eigen::Vector2d corner_m =
        bounds.center().head<2>() -
        0.5 * pixel_m * Eigen::Vector2d(theirs.volume.width_px, theirs.volume.height_px);
    std::vector<double> more_m;
    for (int y = 0; y < theirs.mask_m.height; ++y) {
      for (int x = 0; x < theirs.mask_m.width; ++x) {
        const float m = theirs.mask_m.at(x, y);
        if (m == static_cast<float>(theirs.volume.depth_m)) continue;
        const double front_m = bounds.max().z() + kDistance_m - m;
        const auto at_x = static_cast<float>(corner_m.x() + (x + kSampleX_px) * pixel_m);
        const auto at_y = static_cast<float>(corner_m.y() + (y + kSampleY_px) * pixel_m);
        more_m.push_back(front.max_under(at_x, at_x, at_y, at_y) - front_m);
      }
    }
    ASSERT_GT(more_m.size(), 500U);
    EXPECT_GE(*std::min_element(more_m.begin(), more_m.end()), -kRounding_m);
    std::nth_element(more_m.begin(), more_m.begin() + static_cast<std::ptrdiff_t>(more_m.size() / 2),
                     more_m.end());
    EXPECT_LT(more_m[more_m.size() / 2], 2.0 * pixel_m);
  }
}

TEST(RadarPictures, OfWhatCannotBeAskedAreEmpty) {
  const JudgedMesh object(shapes::box({0.2F, 0.2F, 0.2F}));
  RadarQuery query{
      .object = {&object.tree, object.T_world_mesh}, .direction_world = kDown, .distance_m = 1.0};
  EXPECT_EQ(radar_pictures(query, {}, 16).mask_m.width, 16);
  EXPECT_EQ(radar_pictures(query, {}, 1'000'000).mask_m.width, 4096) << "no more than the radar takes";
  query.direction_world.setZero();
  EXPECT_TRUE(radar_pictures(query, {}, 16).mask_m.empty());
}

}  // namespace
}  // namespace roomradar::radar_pictures_test
