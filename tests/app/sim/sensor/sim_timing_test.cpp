// sim_timing_test.cpp: rolling shutter, delay and exposure of the simulated sensor, and tracking with them.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "app/sim/sensor/simulated_source.hpp"
#include "mapping/odometry/odometry.hpp"
#include "mapping/types/trajectory.hpp"

namespace roomradar::sim_timing_test {
namespace {

Frame frame_of(const std::string& spec, std::int64_t index) {
  SimulatedSource source(parse_sim_spec(spec));
  Frame frame;
  EXPECT_TRUE(source.seek(index));
  EXPECT_EQ(source.next(frame).status, ReadStatus::kFrame);
  return frame;
}

double mean_difference(const Frame& a, const Frame& b, int begin, int end) {
  double sum = 0.0;
  for (int y = begin; y < end; ++y)
    for (int x = 0; x < a.depth_m.width; ++x)
      sum += std::abs(static_cast<double>(a.depth_m.at(x, y) - b.depth_m.at(x, y)));
  return sum / ((end - begin) * a.depth_m.width);
}

TEST(SimTiming, ShutterMovesTheOuterRowsAndNotTheMiddle) {
  const std::string spec = "sim:table?frames=2&width=160&noise=0&turn=90";
  const Frame still = frame_of(spec, 1), rolling = frame_of(spec + "&shutter=40", 1);
  EXPECT_EQ(still.T_world_camera->matrix(), rolling.T_world_camera->matrix());
  EXPECT_LT(mean_difference(still, rolling, 58, 62), 0.02);
  EXPECT_GT(mean_difference(still, rolling, 0, 20), 0.03);
  EXPECT_GT(mean_difference(still, rolling, 100, 120), 0.005);
}

TEST(SimTiming, DelayedColourIsThatOfALaterFrame) {
  const std::string spec = "sim:table?frames=3&width=160&noise=0&rate=20";
  EXPECT_EQ(frame_of(spec + "&delay=50", 1).colour.pixels, frame_of(spec, 2).colour.pixels);
  EXPECT_EQ(frame_of(spec + "&delay=-50", 1).colour.pixels, frame_of(spec, 0).colour.pixels);
  EXPECT_EQ(frame_of(spec + "&delay=50", 1).depth_m.pixels, frame_of(spec, 1).depth_m.pixels);
}

TEST(SimTiming, ExposureBlursColourAlone) {
  const std::string spec = "sim:table?frames=2&width=160&noise=0&turn=90";
  const auto edges = [](const Frame& frame) {
    double sum = 0.0;
    for (int y = 0; y < frame.colour.height; ++y)
      for (int x = 1; x < frame.colour.width; ++x)
        sum += std::abs(frame.colour.at(x, y).g - frame.colour.at(x - 1, y).g);
    return sum;
  };
  const Frame sharp = frame_of(spec, 0), blurred = frame_of(spec + "&exposure=40", 0);
  EXPECT_LT(edges(blurred), 0.9 * edges(sharp));
  EXPECT_EQ(sharp.depth_m.pixels, blurred.depth_m.pixels);
}

/// Trajectory error, m, of 60 frames of a camera that turns at 90 degrees/s.
double tracking_error_m(const std::string& faults, const SensorTiming& timing) {
  SimulatedSource source(parse_sim_spec("sim:table?seed=3&frames=60&width=320&turn=90" + faults));
  OdometryConfig config;
  config.timing = timing;
  config.estimate_timing = false;
  Odometry odometry(config);
  std::vector<TimedPose> truth, found;
  Frame frame;
  while (source.next(frame).status == ReadStatus::kFrame) {
    EXPECT_TRUE(odometry.track(frame)) << "frame " << frame.index;
    truth.push_back({frame.index, frame.stamp_s, *frame.T_world_camera});
  }
  for (const TrackedFrame& tracked : odometry.optimise())
    found.push_back({tracked.frame_index, tracked.stamp_s, tracked.T_world_camera});
  return absolute_trajectory_error(found, truth).rmse_m;
}

TEST(SimTiming, TrackingCorrectsAKnownShutter) {
  const double global_m = tracking_error_m("", {});
  const double corrected_m = tracking_error_m("&shutter=30", {0.03, 0.03, 0.0});
  EXPECT_LT(global_m, 0.003);
  EXPECT_LT(corrected_m, 0.004);
  EXPECT_GT(tracking_error_m("&shutter=30", {}), 3.0 * corrected_m);
}

}  // namespace
}  // namespace roomradar::sim_timing_test
