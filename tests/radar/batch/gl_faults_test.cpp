// gl_faults_test.cpp: a renderer that provides less than required causes an error message or no answer, never
// a crash.
#include <gtest/gtest.h>

#include "mapping/types/system/error.hpp"
#include "radar/batch/gl_radar.hpp"
#include "radar/depth/depth_pass.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar::gl_faults_test {
namespace {

class GlFaults : public testing::Test {
 protected:
  GlFaults() {
    cube.upload(shapes::box({0.2F, 0.2F, 0.2F}), MeshUsage::kStatic);
    floor.upload(shapes::floor(2.0F, 0.0F), MeshUsage::kStatic);
  }
  Contact ask(GlRadar& radar) {
    const MeshInstance object{&cube, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.8))};
    const GpuSceneMesh scene{{&floor, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic};
    return radar.query(object, {0, 0, -1}, 2.0, {&scene, 1});
  }

  GlContext context;
  GpuMesh cube{context}, floor{context};
};

TEST_F(GlFaults, WithoutTheContextThereIsNoAnswerAndWithItAgainThereIs) {
  for (const GlMinimum minimum : {GlMinimum::kReadBack, GlMinimum::kOnRenderer}) {
    GlRadar radar(context, {.resolution_px = 64, .minimum = minimum});
    // Without a current context, GL calls do nothing and queries report it: before the first query, and after
    // one.
    for (int i = 0; i < 2; ++i) {
      context.release();
      const Contact contact = ask(radar);
      context.make_current();
      EXPECT_EQ(contact.status, ContactStatus::kNoAnswer);
      EXPECT_EQ(contact.lower_m, 0.0) << "nothing is known to be free";
      const Contact again = ask(radar);
      EXPECT_EQ(again.status, ContactStatus::kContact);
      EXPECT_NEAR(again.contact_distance_m, 0.7, 1e-6);
    }
  }
}

TEST_F(GlFaults, DepthThatWasNotDrawnIsNoDepth) {
  constexpr Intrinsics camera{64, 48, 60.0, 60.0, 31.5, 23.5};
  DepthPass pass(context, {.renderer = DepthRenderer::kOpenGl});
  DepthImage depth_m;
  const MeshInstance instance{&cube, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 2))};
  const auto render = [&] { pass.render({&instance, 1}, camera, Eigen::Isometry3d::Identity(), depth_m); };
  for (int i = 0; i < 2; ++i) {  // before its texture is created, and after
    context.release();
    EXPECT_THROW(render(), Error);
    context.make_current();
    render();
    EXPECT_GT(depth_m.at(32, 24), 1.0F);
  }
}

TEST_F(GlFaults, AMeshThatTheRendererDidNotTakeIsSaidAndNotDrawn) {
  GlRadar radar(context, {.resolution_px = 64});
  for (const MeshUsage usage : {MeshUsage::kStreamed, MeshUsage::kStatic}) {
    context.release();
    EXPECT_THROW(floor.upload(shapes::floor(3.0F, 0.0F), usage), Error);
    context.make_current();
    EXPECT_EQ(floor.triangle_count(), 0U);
    EXPECT_EQ(ask(radar).status, ContactStatus::kNoTarget);
    floor.upload(shapes::floor(3.0F, 0.0F), usage);
    EXPECT_NEAR(ask(radar).contact_distance_m, 0.7, 1e-6);
  }
}

TEST_F(GlFaults, TextureThatIsNotGivenIsSaid) {
  TileAtlas atlas(context);
  EXPECT_FALSE(atlas.resize(1000, 1000, 4096));
  EXPECT_EQ(atlas.tile_count(), 0U);
  EXPECT_TRUE(atlas.resize(2, 3, 8));
  EXPECT_EQ(atlas.tile_count(), 6U);
  EXPECT_EQ(atlas.corner_px(5), (std::array<int, 2>{8, 16}));
}

TEST_F(GlFaults, AtlasSmallerThanATileGrowsToIt) {
  GlRadar radar(context, {.resolution_px = 300, .atlas_px = 1});
  EXPECT_NEAR(ask(radar).contact_distance_m, 0.7, 1e-6);
}

TEST_F(GlFaults, AMillionTriangles) {
  const Mesh ground = shapes::bumpy_ground(708);
  ASSERT_GT(ground.triangles.size(), 1'000'000U);
  GpuMesh ground_gpu(context);
  ground_gpu.upload(ground, MeshUsage::kStatic);
  const GpuSceneMesh scene{{&ground_gpu, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic};
  GlRadar radar(context, {.resolution_px = 64});
  const Contact contact = radar.query({&cube, Eigen::Isometry3d(Eigen::Translation3d(0.3, 0.1, 0.5))},
                                      {0, 0, -1}, 1.0, {&scene, 1});
  ASSERT_EQ(contact.status, ContactStatus::kContact);
  EXPECT_LE(contact.lower_m, contact.contact_distance_m);
  EXPECT_LE(contact.contact_distance_m, contact.upper_m);
  EXPECT_LT(contact.upper_m - contact.lower_m, 0.01);
}

}  // namespace
}  // namespace roomradar::gl_faults_test
