// where_bench_tracking.cpp: a hand-held camera, a stationary one, and one that is carried away.
#include "where_bench_tracking.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/sim/room/room.hpp"
#include "app/sim/sensor/camera_path.hpp"
#include "bench_times.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/system/counter_random.hpp"
#include "mapping/types/trajectory.hpp"

namespace roomradar {
namespace {

using Eigen::Vector3d;

/// Puts a ball into the frame, as the sensor would measure it; returns the number of pixels it covers.
int put_ball(const Vector3d& centre_camera, double radius_m, Frame& frame) {
  int covered = 0;
  for (int y = 0; y < frame.depth_m.height; ++y) {
    for (int x = 0; x < frame.depth_m.width; ++x) {
      const Vector3d ray = back_project(frame.depth_camera, x, y, 1.0);
      const double along = ray.dot(centre_camera), a = ray.squaredNorm();
      const double inside = along * along - a * (centre_camera.squaredNorm() - radius_m * radius_m);
      if (inside < 0.0) continue;
      const auto depth_m = static_cast<float>((along - std::sqrt(inside)) / a);
      float& measured_m = frame.depth_m.at(x, y);
      ++covered;
      const auto pixel = static_cast<std::uint64_t>(frame.depth_m.index(x, y));
      const float noise = gaussian(hash_of(static_cast<std::uint64_t>(frame.index), pixel));
      measured_m = depth_m + depth_sigma_m(DepthNoise{}, depth_m) * noise;
      if (frame.colour.width == frame.depth_m.width)
        frame.colour.at(x, y) = {static_cast<std::uint8_t>(120.0 + 100.0 * std::sqrt(inside) / radius_m), 90,
                                 40};
    }
  }
  return covered;
}

/// Processes one frame like the command `run`: localises it, then marks its foreground for the next frame.
Tracking step(SearchedRoom& mapped, Locator& locator, const Frame& frame, test::Times& locate_ms) {
  const double start_ms = test::thread_ms(), drawn_ms = mapped.drawing_ms;
  const Tracking tracking = mapped.find(locator, frame, mapped.scene.foreground().dynamic_mask);
  locate_ms.samples_ms.push_back(test::thread_ms() - start_ms - (mapped.drawing_ms - drawn_ms));
  if (has_pose(tracking))
    mapped.scene.find_dynamic(frame,
                              mapped.scene.render_expected(frame.depth_camera, tracking.T_world_camera));
  return tracking;
}

}  // namespace

nlohmann::json follow_behind_ball(const std::string& name, const SimOptions& scan, SearchedRoom& mapped,
                                  std::int64_t frames) {
  SimOptions options = scan;
  options.path = CameraPathKind::kView;
  options.frames = frames;
  options.rate_hz = 30.0;
  options.movers = {MoverKind::kPerson, MoverKind::kHand};
  SimulatedSource source(options);
  Locator locator;
  Frame frame;
  test::Times locate_ms;
  std::vector<TimedPose> truth, estimate;
  double squares = 0.0, moving = 0.0;
  const double drawn_ms = mapped.drawing_ms;
  while (source.next(frame).status == ReadStatus::kFrame) {
    const double swing = std::sin(2.0 * std::numbers::pi * 0.4 * frame.stamp_s);
    if (frame.index > 0) put_ball({0.2 * swing, 0.05 - 0.05 * swing, 0.85 + 0.1 * swing}, 0.27, frame);
    int nearer = 0;  // pixels nearer than the room
    for (std::size_t i = 0; i < frame.depth_m.pixels.size(); ++i)
      nearer += source.truth().moved.pixels[i] != 0 ||
                (frame.depth_m.pixels[i] > 0.0F &&
                 frame.depth_m.pixels[i] < source.truth().depth_m.pixels[i] - 0.1F);
    moving += static_cast<double>(nearer) / static_cast<double>(frame.depth_m.pixels.size());
    const Tracking tracking = step(mapped, locator, frame, locate_ms);
    const Eigen::Isometry3d T_world_true = mapped.map.info.T_world_recorded * *frame.T_world_camera;
    truth.push_back({frame.index, frame.stamp_s, T_world_true});
    if (!has_pose(tracking)) continue;
    estimate.push_back({frame.index, frame.stamp_s, tracking.T_world_camera});
    squares += (tracking.T_world_camera.translation() - T_world_true.translation()).squaredNorm();
  }
  const TrajectoryError ate = absolute_trajectory_error(estimate, truth);
  return {{"row", name},
          {"frames", frames},
          {"located", estimate.size()},
          {"moving_mean", moving / static_cast<double>(frames)},
          {"ate_rmse_mm", 1e3 * ate.rmse_m},
          {"ate_max_mm", 1e3 * ate.max_m},
          {"in_map_rmse_mm",
           1e3 * std::sqrt(squares / static_cast<double>(std::max<std::size_t>(estimate.size(), 1)))},
          {"thread_median_ms", locate_ms.percentile(0.5)},
          {"drawing_mean_ms", (mapped.drawing_ms - drawn_ms) / static_cast<double>(frames)}};
}

nlohmann::json stand_still(const std::string& name, const SimOptions& scan, SearchedRoom& mapped,
                           std::int64_t frames) {
  SimOptions options = scan;
  options.path = CameraPathKind::kView;
  SimulatedSource source(options);
  Locator locator;
  Frame frame;
  test::Times locate_ms;
  (void)source.next(frame);
  const Eigen::Isometry3d T_room_camera = *frame.T_world_camera;
  const Eigen::Isometry3d T_world_true = mapped.map.info.T_world_recorded * T_room_camera;
  std::int64_t located = 0;
  std::vector<Eigen::Matrix<double, 6, 1>> errors;  // errors after the first four frames
  for (std::int64_t i = 0; i < frames; ++i) {
    source.look(i, T_room_camera, frame);
    const Tracking tracking = step(mapped, locator, frame, locate_ms);
    if (!has_pose(tracking)) continue;
    ++located;
    if (i > 3) errors.push_back(local(T_world_true.inverse() * tracking.T_world_camera));
  }
  Eigen::Matrix<double, 6, 1> mean = Eigen::Matrix<double, 6, 1>::Zero();
  for (const auto& error : errors) mean += error / static_cast<double>(errors.size());
  double shake_m2 = 0.0, shake_rad2 = 0.0;
  for (const auto& error : errors) {
    shake_m2 += (error - mean).head<3>().squaredNorm() / static_cast<double>(errors.size());
    shake_rad2 += (error - mean).tail<3>().squaredNorm() / static_cast<double>(errors.size());
  }
  const auto none_if_empty = [&](double value) {
    return errors.empty() ? nlohmann::json() : nlohmann::json(value);
  };
  return {{"row", name},
          {"frames", frames},
          {"located", located},
          {"off_mm", none_if_empty(1e3 * mean.head<3>().norm())},
          {"shake_mm", none_if_empty(1e3 * std::sqrt(shake_m2))},
          {"shake_deg", none_if_empty(std::sqrt(shake_rad2) * 180.0 / std::numbers::pi)},
          {"thread_median_ms", locate_ms.percentile(0.5)}};
}

nlohmann::json carry_away(const std::string& name, const SimOptions& scan, SearchedRoom& mapped,
                          std::int64_t jumps) {
  constexpr int kStay_frames = 15, kBlack_frames = 2;
  SimulatedSource source(scan);
  const std::vector<Eigen::Isometry3d> stops =
      draw_free_views(source.room(), mapped.map, poses_of(scan), static_cast<std::size_t>(jumps), 9);
  Locator locator;
  Frame frame;
  test::Times locate_ms;
  int longest = 0, wrong = 0, never = 0, frames = 0;
  std::int64_t index = 0;
  for (std::size_t k = 0; k < stops.size(); ++k) {
    const Eigen::Isometry3d T_world_true = mapped.map.info.T_world_recorded * stops[k];
    int until_right = -1;
    for (int i = 0; i < kStay_frames; ++i, ++frames) {
      source.look(index++, stops[k], frame);
      if (k % 2 == 1 && i < kBlack_frames) {
        frame.depth_m.resize(frame.depth_m.width, frame.depth_m.height);
        frame.colour.resize(frame.colour.width, frame.colour.height);
      }
      const Tracking tracking = step(mapped, locator, frame, locate_ms);
      const bool is_right =
          has_pose(tracking) &&
          (tracking.T_world_camera.translation() - T_world_true.translation()).norm() < 0.05;
      wrong += has_pose(tracking) && !is_right;
      if (is_right && until_right < 0) until_right = i - (k % 2 == 1 ? kBlack_frames : 0);
    }
    never += until_right < 0;
    longest = std::max(longest, until_right);
  }
  return {{"row", name},    {"jumps", stops.size()},     {"frames", frames},
          {"never", never}, {"longest_frames", longest}, {"wrong_frames", wrong}};
}

}  // namespace roomradar
