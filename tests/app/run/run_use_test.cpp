// run_use_test.cpp: fractions, sums and reasons of the work done per frame.
#include "app/run/run_use.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "app/session/script/session_events.hpp"
#include "app/session/session.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::run_use_test {
namespace {

TEST(Shares, PercentilesAreTheirsWithinOnePercent) {
  Shares shares;
  EXPECT_EQ(shares.mean(), 0.0);
  EXPECT_EQ(shares.percentile(0.95), 0.0);
  for (std::size_t i = 1; i <= 1000; ++i) shares.add(i, 1000);
  EXPECT_NEAR(shares.mean(), 0.5005, 1e-9);
  for (const double p : {0.1, 0.5, 0.95, 1.0}) EXPECT_NEAR(shares.percentile(p), p, 0.01 * p) << p;
  Shares small;
  small.add(5, 100000);
  small.add(0, 0);
  EXPECT_NEAR(small.percentile(1.0), 5e-5, 1e-4);
}

/// A wall of 2 x 200 triangles 2 m in front of the camera, and the same behind it.
SavedMap two_walls() {
  SavedMap map;
  for (const float z : {2.0F, -2.0F}) {
    for (int column = 0; column < 200; ++column) {
      const auto i = static_cast<std::uint32_t>(map.mesh.vertices.size());
      const float x = -2.0F + 0.02F * static_cast<float>(column);
      for (const auto& [dx, y] : {std::pair{0.0F, -2.0F}, {0.02F, -2.0F}, {0.02F, 2.0F}, {0.0F, 2.0F}})
        map.mesh.vertices.emplace_back(x + dx, y, z);
      map.mesh.triangles.push_back({i, i + 2, i + 1});
      map.mesh.triangles.push_back({i, i + 3, i + 2});
    }
  }
  return map;
}

class FrameUseInASession : public ::testing::Test {
 protected:
  FrameUseInASession() : map_(two_walls()), session_(map_, config()) {
    frame_.depth_camera = {160, 120, 146.0, 146.0, 79.5, 59.5};
    frame_.depth_m.resize(160, 120, 2.0F);
    frame_.T_world_camera = Eigen::Isometry3d::Identity();
  }
  static SessionConfig config() {
    SessionConfig config;
    config.poses = PoseOrigin::kRecorded;
    config.make_picture = false;
    config.fine_mesh = true;
    return config;
  }
  FrameUse step() {
    frame_.index += 1;
    frame_.stamp_s += 1.0 / 30.0;
    return session_.step(frame_, times_).use;
  }
  std::string reasons(const FrameUse& use) const { return reasons_of(use, session_.objects()); }
  void put_a_hand(int width_px) {
    for (int y = 30; y < 90; ++y)
      for (int x = 40; x < 40 + width_px; ++x) frame_.depth_m.at(x, y) = 0.9F;
  }
  void put_a_pot(double z, double speed_mps) {
    apply(session_, {AddObject{.name = "pot", .source = {.mesh = "teapot"}}});
    apply(session_, {ThrowObject{"pot", {0.0, 0.0, z}, {0.0, 0.0, speed_mps}}});
  }

  SavedMap map_;
  Session session_;
  StageTimes times_;
  Frame frame_;
};

TEST_F(FrameUseInASession, AStandingCameraDrawsOnceAndAMovingOneEachTime) {
  const FrameUse first = step();
  EXPECT_EQ(first.room_triangles, 800U);
  EXPECT_EQ(first.views_drawn, 1U);
  EXPECT_EQ(reasons(first), "the camera moved; nothing moved");
  const FrameUse second = step();
  EXPECT_EQ(second.views_drawn, 0U);
  EXPECT_EQ(second.room_drawn, 0U);
  EXPECT_EQ(reasons(second), "the camera is stationary, the last view is reused; nothing moved");
  frame_.T_world_camera->translation().x() += 0.01;
  EXPECT_EQ(step().views_drawn, 1U);
}

TEST_F(FrameUseInASession, WhatMovedIsCountedByPixelsAndCellsAndWhyItIsFine) {
  static_cast<void>(step());
  put_a_hand(40);
  static_cast<void>(step());
  const FrameUse hand = step();
  EXPECT_EQ(hand.valid_px, 160U * 120U);
  EXPECT_EQ(hand.meshed_px, 40U * 60U);
  EXPECT_GT(hand.mesh_triangles, 0U);
  EXPECT_GT(hand.cells.flat + hand.cells.cut, 100U);
  EXPECT_LT(hand.cells.full, 10U);
  EXPECT_EQ(reasons(hand), "the camera is stationary, the last view is reused; 12 % of the depth moved");
  FrameUse use = hand;
  use.meshed_px = use.valid_px;
  EXPECT_EQ(reasons(use), "the camera is stationary, the last view is reused; 100 % of the depth moved");
  use.meshed_px = 1;
  EXPECT_EQ(reasons(use), "the camera is stationary, the last view is reused; 0.01 % of the depth moved");
  use.knows_moved = false;
  EXPECT_NE(reasons(use).find("without the map's surfaces"), std::string::npos);

  put_a_pot(0.8, 0.0);
  const FrameUse fine = step();
  EXPECT_GT(fine.cells.full, 50U);
  EXPECT_EQ(session_.objects().front()->fine_cells, fine.cells.full);
  EXPECT_NE(reasons(fine).find("full resolution near pot ("), std::string::npos) << reasons(fine);
  RunUse run;
  run.add(fine, session_.objects());
  run.add(FrameUse{}, {});
  const nlohmann::json json = to_json(run);
  EXPECT_EQ(json["why"]["frames_fine_near"], 1);
  EXPECT_EQ(json["why"]["fine_near"], nlohmann::json::parse(R"([{"object": "pot", "frames": 1}])"));
  EXPECT_EQ(json["why"]["frames_nothing_moved"], 1);
  EXPECT_NEAR(json["meshed_share"]["mean"], 0.5 * 0.125, 1e-9);
}

TEST_F(FrameUseInASession, TheRadarAsksOnlyWhatIsInAnObjectsWay) {
  EXPECT_EQ(step().room_asked, 0U);
  put_a_pot(-1.8, 0.0);  // for the pot, the wall behind the camera is a floor
  std::size_t asked = 0;
  for (int i = 0; i < 30; ++i) asked = std::max(asked, step().room_asked);
  // At its place again: what physics has not moved there is looked at for overlaps.
  session_.place("pot", {.position_world = session_.objects().front()->body.T_world_object.translation()});
  asked = std::max(asked, step().room_asked);
  EXPECT_GT(asked, 0U);
  EXPECT_LT(asked, 400U) << "the wall ahead is not asked";
}

TEST_F(FrameUseInASession, WithoutTheMapsSurfacesAllOfTheDepthIsMeshed) {
  session_.set_surfaces(SurfacePolicy::kSkirt);
  EXPECT_EQ(step().meshed_px, 160U * 120U);
}

TEST(FrameUseFile, HasALineAFrameAndAFolderThatIsNotThereIsSaid) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "frames.csv") << "yesterday's\n";
  FrameUseFile(folder.path() / "frames.csv").close();  // for a run without a frame
  std::string kept;
  std::getline(std::ifstream(folder.path() / "frames.csv"), kept);
  EXPECT_EQ(kept, "yesterday's");
  FrameUseFile file(folder.path() / "frames.csv");
  FrameUse use;
  use.room_triangles = 10;
  use.views_drawn = 1;
  use.room_drawn = 4;
  file.write(7, use, {});
  file.close();
  std::ifstream text(folder.path() / "frames.csv");
  std::string header, line;
  std::getline(text, header);
  std::getline(text, line);
  EXPECT_EQ(line, "7,10,1,4,0,0,0,0,0,0,0,\"the camera moved; nothing moved\"");
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(line.begin(), line.end(), ','));
  EXPECT_THROW(FrameUseFile(folder.path() / "none" / "frames.csv").write(7, use, {}), Error);
}

}  // namespace
}  // namespace roomradar::run_use_test
