// sim_source_test.cpp: frames of the simulated source: determinism, content, and ground truth against
// brute-force rays.
#include <gtest/gtest.h>

#include "app/sim/room/room.hpp"
#include "app/sim/sensor/camera_path.hpp"
#include "app/sim/sensor/movers.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "mapping/types/system/counter_random.hpp"

namespace roomradar::sim_source_test {
namespace {

using Eigen::Vector3d;

Frame frame_of(SimulatedSource& source, std::int64_t index) {
  Frame frame;
  EXPECT_TRUE(source.seek(index));
  EXPECT_EQ(source.next(frame).status, ReadStatus::kFrame);
  EXPECT_EQ(frame.index, index);
  return frame;
}

TEST(SimSource, FrameDependsOnOptionsAndIndexAlone) {
  const SimOptions options =
      parse_sim_spec("sim:table?frames=5&width=160&path=view&moving=hand,ball,person&seed=2");
  SimulatedSource first(options), second(options);
  Frame frame;
  std::vector<Frame> in_order;
  while (first.next(frame).status == ReadStatus::kFrame) in_order.push_back(frame);
  ASSERT_EQ(in_order.size(), 5U);
  EXPECT_EQ(first.next(frame).status, ReadStatus::kEnd);
  EXPECT_EQ(frame.index, 4) << "the end leaves the frame unchanged";
  for (const std::int64_t index : {3, 0, 4, 1}) {
    const Frame again = frame_of(second, index);
    const Frame& before = in_order[static_cast<std::size_t>(index)];
    EXPECT_EQ(again.depth_m.pixels, before.depth_m.pixels);
    EXPECT_EQ(again.colour.pixels, before.colour.pixels);
    EXPECT_EQ(again.T_world_camera->matrix(), before.T_world_camera->matrix());
    EXPECT_EQ(again.stamp_s, before.stamp_s);
  }
  EXPECT_TRUE(first.rewind());
  EXPECT_EQ(first.next(frame).status, ReadStatus::kFrame);
  EXPECT_EQ(frame.depth_m.pixels, in_order[0].depth_m.pixels);
  EXPECT_FALSE(first.seek(5));
  EXPECT_FALSE(first.seek(-1));
}

TEST(SimSource, FrameCarriesCameraPoseGravityAndStamp) {
  SimulatedSource source(parse_sim_spec("sim:wall?frames=4&width=160&rate=20"));
  const Frame frame = frame_of(source, 3);
  EXPECT_DOUBLE_EQ(frame.stamp_s, 0.15);
  EXPECT_EQ(frame.depth_m.width, 160);
  EXPECT_EQ(frame.depth_m.height, 120);
  EXPECT_EQ(frame.depth_camera.width_px, 160);
  EXPECT_EQ(frame.colour.width, 160);
  ASSERT_TRUE(frame.T_world_camera && frame.down_camera);
  EXPECT_LT((frame.T_world_camera->linear() * *frame.down_camera + Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_GT(frame.down_camera->y(), 0.5) << "held upright: gravity points down in the image";
  EXPECT_EQ(source.truth().T_world_camera.matrix(), frame.T_world_camera->matrix());
  EXPECT_EQ(source.frame_count(), 4);
  EXPECT_EQ(source.name(), "sim:wall?frames=4&rate=20&width=160");
}

TEST(SimSource, TruthAgreesWithSlowRaysThroughEverySolid) {
  const SimOptions options =
      parse_sim_spec("sim:table?frames=200&width=160&path=view&moving=hand,ball,person&seed=2");
  SimulatedSource source(options);
  CounterRandom random(1, 1);
  std::vector<Mover> movers;
  const double duration_s = 200.0 / 30.0;
  const Vector3d viewer_world =
      plan_camera_path(source.room(), CameraPathKind::kView, 2, duration_s).centre_world;
  for (const MoverKind kind : options.movers)
    movers.push_back(plan_mover(kind, source.room(), viewer_world, 2));
  int moved = 0;
  for (const std::int64_t index : {20, 75, 130}) {
    const Frame frame = frame_of(source, index);
    std::vector<Solid> solids = source.room().solids;
    std::vector<std::size_t> ends;
    for (const Mover& mover : movers) {
      append_solids(mover, frame.stamp_s, solids);
      ends.push_back(solids.size());
    }
    const SolidTree tree(solids);
    for (int i = 0; i < 4000; ++i) {
      const int x = static_cast<int>(random.uniform() * 160), y = static_cast<int>(random.uniform() * 120);
      const Vector3d direction = frame.T_world_camera->linear() * back_project(frame.depth_camera, x, y, 1.0);
      const auto hit = tree.cast(solids, frame.T_world_camera->translation(), direction, 100.0);
      ASSERT_TRUE(hit);
      std::uint8_t expected = 0;
      if (hit->solid >= static_cast<int>(source.room().solids.size()))
        for (expected = 1; hit->solid >= static_cast<int>(ends[expected - 1U]);) ++expected;
      const bool in_range = hit->range_m >= 0.5 && hit->range_m <= 8.0;
      EXPECT_NEAR(source.truth().depth_m.at(x, y), in_range ? hit->range_m : 0.0, 1e-5);
      EXPECT_EQ(source.truth().mover.at(x, y), expected);
      EXPECT_EQ(source.truth().moved.at(x, y), expected > 0 ? 255 : 0);
      moved += expected > 0;
    }
  }
  EXPECT_GT(moved, 300);
}

TEST(SimSource, ACrateThatComesOrGoesDoesSoAtHalfTimeAndTheMasksSayWhere) {
  const std::string view = "sim:table?frames=9&width=160&path=view&noise=0&crate=";
  SimulatedSource none(parse_sim_spec(view + "0")), there(parse_sim_spec(view + "1")),
      comes(parse_sim_spec(view + "comes")), goes(parse_sim_spec(view + "goes"));
  for (const std::int64_t index : {0, 4, 5, 8}) {
    const bool second_half = index >= 5;
    const DepthImage without = frame_of(none, index).depth_m, with = frame_of(there, index).depth_m;
    EXPECT_EQ(frame_of(comes, index).depth_m.pixels, (second_half ? with : without).pixels) << index;
    EXPECT_EQ(frame_of(goes, index).depth_m.pixels, (second_half ? without : with).pixels) << index;
    int crate_pixels = 0;
    for (std::size_t i = 0; i < with.pixels.size(); ++i) {
      const bool crate = with.pixels[i] != without.pixels[i];
      crate_pixels += crate ? 1 : 0;
      ASSERT_EQ(comes.truth().moved.pixels[i], crate && second_half ? 255 : 0) << index;
      ASSERT_EQ(comes.truth().mover.pixels[i], crate && second_half ? 1 : 0) << index;
      ASSERT_EQ(comes.truth().revealed.pixels[i], 0);
      ASSERT_EQ(goes.truth().moved.pixels[i], 0);
      ASSERT_EQ(goes.truth().revealed.pixels[i], crate && second_half ? 255 : 0) << index;
    }
    EXPECT_GT(crate_pixels, 300);
  }
}

TEST(SimSource, ACrateComesAtHalfTimeWhereTimesOfFramesAreNoExactNumbers) {
  SimulatedSource comes(
      parse_sim_spec("sim:table?frames=58&rate=25&width=160&path=view&noise=0&crate=comes"));
  (void)frame_of(comes, 28);
  EXPECT_EQ(std::count(comes.truth().moved.pixels.begin(), comes.truth().moved.pixels.end(), 255), 0);
  (void)frame_of(comes, 29);
  EXPECT_GT(std::count(comes.truth().moved.pixels.begin(), comes.truth().moved.pixels.end(), 255), 300);
}

TEST(SimSource, FaultsAreThereWithoutNoiseTooAndTheMasksLookThroughTheSameLens) {
  const std::string view = "sim:table?frames=9&width=160&path=view&noise=0&colour=none&faults=1&crate=";
  SimulatedSource goes(parse_sim_spec(view + "goes")), there(parse_sim_spec(view + "1")),
      none(parse_sim_spec(view + "0"));
  const Frame frame = frame_of(goes, 8);
  const DepthImage& truth = goes.truth().depth_m;
  double most_m = 0.0;
  for (std::size_t i = 0; i < truth.pixels.size(); ++i)
    if (truth.pixels[i] > 0.0F)
      most_m = std::max(most_m, std::abs(static_cast<double>(frame.depth_m.pixels[i] - truth.pixels[i])));
  EXPECT_GT(most_m, 0.003);
  EXPECT_LT(most_m, 0.15);
  const DepthImage with = frame_of(there, 8).depth_m, without = frame_of(none, 8).depth_m;
  int crate_pixels = 0;
  for (std::size_t i = 0; i < with.pixels.size(); ++i) {
    const bool crate = with.pixels[i] != without.pixels[i];
    crate_pixels += crate ? 1 : 0;
    ASSERT_EQ(goes.truth().revealed.pixels[i], crate ? 255 : 0) << i;
  }
  EXPECT_GT(crate_pixels, 300);
}

TEST(SimSource, HandPassesBeforeTheFocusAndWithdraws) {
  SimulatedSource source(parse_sim_spec("sim:table?frames=180&width=64&path=view&moving=hand&noise=0"));
  int hidden = 0, open = 0;
  for (std::int64_t index = 0; index < 180; index += 6) {
    const Frame frame = frame_of(source, index);
    const Eigen::Vector2d uv =
        project(frame.depth_camera, frame.T_world_camera->inverse() * source.room().focus_world);
    const bool is_hand = source.truth().moved.at(static_cast<int>(std::lround(uv.x())),
                                                 static_cast<int>(std::lround(uv.y()))) > 0;
    (is_hand ? hidden : open)++;
  }
  EXPECT_GE(hidden, 3);
  EXPECT_GE(open, 10);
}

TEST(SimSource, WithoutNoiseTheDepthIsTheTruth) {
  SimulatedSource source(parse_sim_spec("sim:shelf?frames=10&width=160&noise=0"));
  const Frame frame = frame_of(source, 5);
  EXPECT_EQ(frame.depth_m.pixels, source.truth().depth_m.pixels);
  std::size_t valid = 0;
  for (const float depth_m : frame.depth_m.pixels) valid += depth_m > 0.0F;
  EXPECT_GT(valid, frame.depth_m.pixels.size() * 99 / 100);
}

TEST(SimSource, NoisyDepthIsNearTheTruthForMostPixels) {
  SimulatedSource source(parse_sim_spec("sim:table?frames=10&path=view"));
  const Frame frame = frame_of(source, 5);
  std::size_t valid = 0, close = 0;
  for (std::size_t i = 0; i < frame.depth_m.pixels.size(); ++i) {
    const float measured_m = frame.depth_m.pixels[i], exact_m = source.truth().depth_m.pixels[i];
    ASSERT_TRUE(measured_m == 0.0F || (measured_m >= 0.5F && measured_m <= 8.0F));
    if (measured_m == 0.0F || exact_m == 0.0F) continue;
    ++valid;
    close += std::abs(measured_m - exact_m) < 0.02F + 0.01F * exact_m * exact_m;
  }
  EXPECT_GT(valid, frame.depth_m.pixels.size() * 85 / 100);
  EXPECT_LT(valid, frame.depth_m.pixels.size() * 99 / 100) << "a Kinect has shadows";
  EXPECT_GT(close, valid * 96 / 100);
}

TEST(SimSource, ASeparateColourCameraSeesTheSamePointsBesideTheDepthCamera) {
  SimulatedSource apart(parse_sim_spec("sim:table?frames=3&path=view&noise=0&width=320&colour=separate"));
  SimulatedSource together(parse_sim_spec("sim:table?frames=3&path=view&noise=0&width=320"));
  const Frame a = frame_of(apart, 1), b = frame_of(together, 1);
  EXPECT_NEAR(a.T_colour_depth.translation().x(), -0.025, 1e-12);
  EXPECT_EQ(a.depth_m.pixels, b.depth_m.pixels);
  // The colour camera's colour at the projection of a depth pixel's point equals that pixel's registered
  // colour.
  std::size_t alike = 0, compared = 0;
  for (int y = 40; y < 200; y += 3)
    for (int x = 40; x < 280; x += 3) {
      const double depth_m = a.depth_m.at(x, y);
      if (depth_m <= 0.0) continue;
      const Eigen::Vector2d uv =
          project(a.colour_camera, a.T_colour_depth * back_project(a.depth_camera, x, y, depth_m));
      const int u = static_cast<int>(std::lround(uv.x())), v = static_cast<int>(std::lround(uv.y()));
      if (!a.colour.contains(u, v)) continue;
      ++compared;
      const Rgb p = a.colour.at(u, v), q = b.colour.at(x, y);
      alike += std::abs(p.r - q.r) + std::abs(p.g - q.g) + std::abs(p.b - q.b) < 45;
    }
  ASSERT_GT(compared, 2000U);
  EXPECT_GT(alike, compared * 85 / 100);
}

}  // namespace
}  // namespace roomradar::sim_source_test
