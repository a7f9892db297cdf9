// live_model_test.cpp: anchors, knowledge, picture and mesh of a running scan, against exact scenes.
#include "app/scan/live/live_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "app/scan/live/anchors.hpp"
#include "app/scan/live/knowledge_grid.hpp"
#include "app/scan/scan_picture.hpp"
#include "tests/support/exact_depth.hpp"

namespace roomradar::live_model_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr Intrinsics kCamera{160, 120, 146.0, 146.0, 79.5, 59.5};

/// The floor z = 0 and the wall y = 2, seen from 2 m above the floor.
Frame seen(const Isometry3d& T_world_camera) {
  return test::exact_frame(test::nearest_of(test::plane({0, 0, 1}, 0.0), test::plane({0, 1, 0}, 2.0)),
                           kCamera, T_world_camera);
}
Isometry3d at(double x) { return test::looking_at({x, 0.0, 1.5}, {x, 2.0, 0.3}); }

TEST(Anchors, MoveWithTheirKeyframe) {
  OdometrySnapshot odometry;
  odometry.graph.keyframes.resize(2);
  odometry.graph.keyframes[0].T_world_camera = at(0.0);
  odometry.graph.keyframes[1].T_world_camera = at(1.0);
  Anchors anchors;
  odometry.current = 0;
  EXPECT_EQ(anchor_for(0, at(0.1), odometry, anchors), 0U);
  odometry.current = 1;
  EXPECT_EQ(anchor_for(0, at(1.1), odometry, anchors), 1U);
  EXPECT_EQ(anchor_for(0, at(0.3), odometry, anchors), 0U);  // nearer to the first than to the second
  EXPECT_FALSE(correct(odometry, anchors));

  const Isometry3d before = *anchors.T_world_anchor[1];
  odometry.graph.keyframes[1].T_world_camera.pretranslate(Vector3d(0.0, 0.0, 0.05));
  EXPECT_TRUE(correct(odometry, anchors));
  EXPECT_NEAR((anchors.T_world_anchor[1]->translation() - before.translation() - Vector3d(0, 0, 0.05)).norm(),
              0.0, 1e-12);
  EXPECT_TRUE(anchors.T_world_anchor[0]->isApprox(Isometry3d(Eigen::Translation3d(at(0.1).translation()))));
}

TEST(Anchors, OfForgottenFramesAreGone) {
  OdometrySnapshot odometry;
  odometry.graph.keyframes.resize(1);
  Anchors anchors;
  EXPECT_EQ(anchor_for(3, at(0.0), odometry, anchors), 0U);
  EXPECT_EQ(anchor_for(8, at(5.0), odometry, anchors), 1U);
  forget_frames_from(8, anchors);
  EXPECT_TRUE(anchors.T_world_anchor[0]);
  EXPECT_FALSE(anchors.T_world_anchor[1]);
  odometry.graph.keyframes.clear();  // tracking began again
  EXPECT_TRUE(correct(odometry, anchors));
  EXPECT_FALSE(anchors.T_world_anchor[0]);
  EXPECT_FALSE(correct(odometry, anchors));
  EXPECT_EQ(anchor_for(9, at(5.0), odometry, anchors), 2U);  // a new one
}

TEST(Anchors, WithoutKeyframesStay) {
  const OdometrySnapshot odometry;
  Anchors anchors;
  EXPECT_EQ(anchor_for(0, at(0.0), odometry, anchors), 0U);
  EXPECT_EQ(anchor_for(0, at(5.0), odometry, anchors), 1U);
  EXPECT_FALSE(correct(odometry, anchors));
}

TEST(KnowledgeGrid, GrowsFromNewToWell) {
  KnowledgeGrid grid;
  const Frame frame = seen(at(0.0));
  const auto share_of = [&](Knowledge wanted) {
    const Image<Knowledge> knowledge = grid.knowledge_of(frame, at(0.0));
    std::size_t measured = 0, matching = 0;
    for (const Knowledge k : knowledge.pixels) {
      measured += k != Knowledge::kNone ? 1 : 0;
      matching += k == wanted ? 1 : 0;
    }
    return static_cast<double>(matching) / static_cast<double>(measured);
  };
  EXPECT_EQ(share_of(Knowledge::kNew), 1.0);
  EXPECT_EQ(grid.well_known_fraction(), 0.0);
  for (int i = 0; i < 200; ++i) grid.add(frame, 0, at(0.0), Isometry3d::Identity());
  EXPECT_GT(share_of(Knowledge::kWell), 0.95);
  EXPECT_GT(grid.well_known_fraction(), 0.9);
}

TEST(KnowledgeGrid, MovesWithItsAnchors) {
  KnowledgeGrid grid;
  const Frame frame = seen(at(0.0));
  for (int i = 0; i < 200; ++i) grid.add(frame, 1, at(0.0), Isometry3d::Identity());
  const Isometry3d away(Eigen::Translation3d(10.0, 0.0, 0.0));
  grid.move({std::nullopt, away});
  const auto well = [&](const Isometry3d& T_world_camera) {
    std::size_t count = 0;
    for (const Knowledge k : grid.knowledge_of(frame, T_world_camera).pixels)
      count += k == Knowledge::kWell ? 1 : 0;
    return count;
  };
  EXPECT_EQ(well(at(0.0)), 0U);
  EXPECT_GT(well(away * at(0.0)), 200U);
}

TEST(ScanPicture, TintsKnownPlacesOnly) {
  Frame frame = seen(at(0.0));
  frame.depth_m.at(4, 4) = 0.0F;
  Image<Knowledge> knowledge(20, 15, Knowledge::kNew);
  knowledge.at(3, 2) = Knowledge::kWell;
  knowledge.at(5, 2) = Knowledge::kThin;
  const Image<std::uint32_t> tint = make_tint(frame, knowledge);
  ASSERT_EQ(tint.width, 20);
  ASSERT_EQ(tint.height, 15);
  const auto alpha = [&](int x, int y) { return tint.at(x, y) >> 24U; };
  EXPECT_GT(alpha(3, 2), 0U);
  EXPECT_GT(alpha(5, 2), 0U);
  EXPECT_NE(tint.at(3, 2), tint.at(5, 2));
  EXPECT_EQ(alpha(4, 2), 0U);

  ColourImage picture;
  make_picture(frame, picture);  // no colour: depth as grey
  EXPECT_EQ(picture.at(4, 4), Rgb{});
  EXPECT_GT(picture.at(80, 100).r, 0);
  ColourImage other(160, 120, {200, 0, 0});
  mix_half(other, picture);
  EXPECT_EQ(picture.at(4, 4), (Rgb{100, 0, 0}));
  mix_half(ColourImage(3, 3), picture);  // another size: nothing is mixed
  EXPECT_EQ(picture.at(4, 4), (Rgb{100, 0, 0}));
}

TEST(LiveModel, IsTheSceneInTheAnchorsFrame) {
  const Isometry3d T_world_anchor(Eigen::Translation3d(0.0, 0.0, 1.5));
  LiveModel model;
  for (int i = 0; i < 12; ++i) {
    const Isometry3d T_world_camera = at(0.02 * i);
    while (!model.offer(std::make_shared<const Frame>(seen(T_world_camera)), 3,
                        T_world_anchor.inverse() * T_world_camera,
                        /*shows_new=*/true)) {
    }
  }
  model.finish();
  const std::vector<LiveModelPart> parts = model.parts();
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].anchor, 3U);
  const Mesh& mesh = *parts[0].mesh_anchor;
  ASSERT_GT(mesh.triangles.size(), 100U);
  double worst_m = 0.0;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Vector3d p_world = T_world_anchor * (mesh.origin + vertex.cast<double>());
    worst_m = std::max(worst_m, std::min(std::abs(p_world.z()), std::abs(p_world.y() - 2.0)));
  }
  EXPECT_LT(worst_m, 0.02);
}

TEST(LiveModel, LeavesOutFramesOfKnownPlacesWithoutAnOctree) {
  LiveModel model;
  ASSERT_TRUE(model.offer(std::make_shared<const Frame>(seen(at(0.0))), 0, at(0.0), /*shows_new=*/false));
  model.finish();
  EXPECT_TRUE(model.parts().empty());
}

TEST(LiveModel, KeepsThePartsOfAnchorsThatWereLeft) {
  LiveModel model;
  for (std::size_t anchor = 0; anchor < 7; ++anchor) {
    while (!model.offer(std::make_shared<const Frame>(seen(at(0.0))), anchor, at(0.0), /*shows_new=*/true)) {
    }
    model.finish();
  }
  const std::vector<LiveModelPart> parts = model.parts();
  ASSERT_EQ(parts.size(), 7U);
  for (const LiveModelPart& part : parts) EXPECT_GT(part.mesh_anchor->triangles.size(), 50U);
}

}  // namespace
}  // namespace roomradar::live_model_test
