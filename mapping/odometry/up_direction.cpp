// up_direction.cpp: mean gravity, or the mode of the surface normals near the cameras' up direction.
#include "mapping/odometry/up_direction.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

// Normals are computed from pixels 1/20 of the width apart, about 10 cm. From closer pixels they are mostly
// noise, which leans towards the camera.
constexpr int kStepsAcross = 20;
constexpr double kMaxSlope = 4.0;  // depth change / lateral distance: 76 degrees; steeper is a discontinuity
constexpr std::size_t kMaxNormals = 400'000;  // 5 MB; must be even, see keep()
constexpr double kConeAboutCameraUp_deg = 60.0;
constexpr double kModeWindow_deg = 5.0;
constexpr double kMinSupport = 0.05;

double cos_deg(double angle_deg) { return std::cos(angle_deg * std::numbers::pi / 180.0); }

/// Returns the mean of the normals within window_deg of `axis`, and their number in `count`.
Eigen::Vector3d mean_near(const std::vector<Eigen::Vector3f>& normals, const Eigen::Vector3d& axis,
                          double window_deg, std::size_t& count) {
  const auto cos_window = static_cast<float>(cos_deg(window_deg));
  const Eigen::Vector3f axis_f = axis.cast<float>();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  count = 0;
  for (const Eigen::Vector3f& normal : normals) {
    if (normal.dot(axis_f) < cos_window) continue;
    sum += normal.cast<double>();
    ++count;
  }
  return count > 0 ? Eigen::Vector3d(sum.normalized()) : axis;
}

}  // namespace

std::string_view to_string(UpSource source) {
  switch (source) {
    case UpSource::kAccelerometer:
      return "accelerometer";
    case UpSource::kPlane:
      return "plane";
    case UpSource::kGiven:
      return "given";
    case UpSource::kNone:
      break;
  }
  return "none";
}

void UpEstimator::add(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  ++frames_;
  const Eigen::Matrix3d R_world_camera = T_world_camera.linear();
  camera_up_sum_world_ -= R_world_camera.col(1);
  if (frame.down_camera) {
    down_sum_world_ += R_world_camera * *frame.down_camera;
    ++frames_with_gravity_;
  }
  const Eigen::Matrix3f R = R_world_camera.cast<float>();
  const auto point = [&](int x, int y) -> Eigen::Vector3f {
    return back_project(frame.depth_camera, x, y, static_cast<double>(frame.depth_m.at(x, y))).cast<float>();
  };
  const int step_px = std::max(1, frame.depth_m.width / kStepsAcross);
  const auto jump_per_m = static_cast<float>(kMaxSlope * step_px / frame.depth_camera.fx_px);
  for (int y = 0; y + step_px < frame.depth_m.height; y += step_px) {
    for (int x = 0; x + step_px < frame.depth_m.width; x += step_px) {
      const float here_m = frame.depth_m.at(x, y);
      const float right_m = frame.depth_m.at(x + step_px, y);
      const float below_m = frame.depth_m.at(x, y + step_px);
      const float jump_m = jump_per_m * here_m;
      if (here_m <= 0 || right_m <= 0 || below_m <= 0 || std::abs(right_m - here_m) > jump_m ||
          std::abs(below_m - here_m) > jump_m)
        continue;
      const Eigen::Vector3f p = point(x, y);
      const Eigen::Vector3f towards_camera = (point(x, y + step_px) - p).cross(point(x + step_px, y) - p);
      const float length = towards_camera.norm();
      if (length > 0) keep(R * (towards_camera / length));
    }
  }
}

void UpEstimator::keep(const Eigen::Vector3f& normal_world) {
  if (normals_seen_++ % keep_every_ != 0) return;
  normals_world_.push_back(normal_world);
  if (normals_world_.size() < kMaxNormals) return;
  for (std::size_t i = 0; i < kMaxNormals / 2; ++i) normals_world_[i] = normals_world_[2 * i];
  normals_world_.resize(kMaxNormals / 2);
  keep_every_ *= 2;
}

Eigen::Vector3d UpEstimator::camera_up() const {
  const bool is_known = camera_up_sum_world_.norm() > 1e-6;
  return is_known ? Eigen::Vector3d(camera_up_sum_world_.normalized())
                  : Eigen::Vector3d(-Eigen::Vector3d::UnitY());
}

UpDirection UpEstimator::take(const GivenUp& given) const {
  return {UpSource::kGiven, given.up_world.value_or(camera_up()), 1.0};
}

UpDirection UpEstimator::estimate() const {
  if (frames_ == 0) return {};
  if (2 * frames_with_gravity_ >= frames_ && down_sum_world_.norm() > 1e-6)
    return {UpSource::kAccelerometer, -down_sum_world_.normalized(), 1.0};

  const Eigen::Vector3d camera_up = this->camera_up();
  // Try each of a subset of the normals as the mode, then refine the best to the mean of its window.
  const double cos_cone = cos_deg(kConeAboutCameraUp_deg);
  const std::size_t stride = std::max<std::size_t>(1, normals_world_.size() / 400);
  Eigen::Vector3d best = camera_up;
  std::size_t best_count = 0;
  for (std::size_t i = 0; i < normals_world_.size(); i += stride) {
    const Eigen::Vector3d candidate = normals_world_[i].cast<double>();
    if (candidate.dot(camera_up) < cos_cone) continue;
    std::size_t count = 0;
    mean_near(normals_world_, candidate, kModeWindow_deg, count);
    if (count > best_count) {
      best_count = count;
      best = candidate;
    }
  }
  for (int pass = 0; pass < 3; ++pass) best = mean_near(normals_world_, best, kModeWindow_deg, best_count);
  const double support = normals_world_.empty()
                             ? 0.0
                             : static_cast<double>(best_count) / static_cast<double>(normals_world_.size());
  if (support < kMinSupport) return {UpSource::kNone, camera_up, 0.0};
  return {UpSource::kPlane, best, support};
}

Eigen::Isometry3d level_rotation(const Eigen::Vector3d& up_world) {
  return Eigen::Isometry3d(rotation_between(up_world, Eigen::Vector3d::UnitZ()));
}

}  // namespace roomradar
