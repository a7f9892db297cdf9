// timing_evidence.cpp: normal equations of pose and parameters, with the pose eliminated.
#include "mapping/alignment/timing_evidence.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/alignment/point_to_plane.hpp"
#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

using Eigen::Vector3d;

constexpr int kPose = 6, kAll = kPose + kTimingParameters;
constexpr int kDepthReadout = kPose, kColourReadout = kPose + 1, kColourDelay = kPose + 2,
              kOffset = kPose + 3;
constexpr int kOffsets = kTimingParameters - 3;
using Row = Eigen::Matrix<double, kAll, 1>;
using Offsets = Eigen::Matrix<double, kOffsets, 1>;

constexpr double kSoft = 2.5;             // scale of the robust kernel, in standard deviations
constexpr double kGate_m = 0.06;          // max distance of a correspondence
constexpr double kIntensitySigma = 16.0;  // as for tracking: grey levels

Offsets offsets_at(const Intrinsics& camera, const Eigen::Vector2d& pixel) {
  const double half_px = 0.5 * camera.width_px;
  const double x = (pixel.x() - half_px) / half_px;
  const double y = (pixel.y() - 0.5 * camera.height_px) / half_px;
  return (Offsets() << x, y, x * x, x * y, y * y).finished();
}

double row_fraction(const Intrinsics& camera, double v_px) {
  return (v_px - 0.5 * (camera.height_px - 1)) / camera.height_px;
}

Vector3d motion_of(const Vector3d& p_camera, const CameraVelocity& velocity) {
  return velocity.linear_mps + velocity.angular_radps.cross(p_camera);
}

/// Parts of the Jacobians of a point's residuals.
struct Correspondence {
  const TargetPixel* pixel = nullptr;
  int x = 0, y = 0;
  Vector3d p_camera, p_view;
  Eigen::Vector2d live_px, view_px;
  Vector3d live_mps,
      view_mps;  ///< motion of the point in the camera frame, by the live image and by the view
  Vector3d live_steady_mps, view_steady_mps;  ///< the same by the steady velocities
  /// Time by which the view's intensity would be registered later with the current times.
  double colour_late_s = 0.0;
};

struct Sums {
  Eigen::Matrix<double, kAll, kAll> H = Eigen::Matrix<double, kAll, kAll>::Zero();
  Row g = Row::Zero();
  void add(const Row& J, double residual, double weight) {
    H.noalias() += weight * J * J.transpose();
    g += weight * residual * J;
  }
};

Row pose_part(const Correspondence& c, const Vector3d& m) {
  Row J = Row::Zero();
  J.head<3>() = m;
  J.segment<3>(3) = c.p_camera.cross(m);
  return J;
}

/// The live image's camera and that of the view it is compared with.
struct CameraPair {
  const Eigen::Matrix3d& R_view_camera;
  const Intrinsics& live;
  const Intrinsics& view;
};

/// Adds the distance to the plane; returns its robust weight, 0 beyond the gate.
double add_depth(const Correspondence& c, const CameraPair& cameras, Sums& sums) {
  const auto& [R_view_camera, live_camera, view_camera] = cameras;
  const Vector3d normal = c.pixel->normal.cast<double>();
  const double r_m = normal.dot(c.p_view) - static_cast<double>(c.pixel->offset_m);
  if (!(std::abs(r_m) < kGate_m)) return 0.0;
  const auto inverse_sigma = static_cast<double>(c.pixel->inverse_sigma_per_m);
  const double residual = r_m * inverse_sigma;
  const double weight = robust_weight(residual / kSoft);
  const Vector3d m = inverse_sigma * (R_view_camera.transpose() * normal);
  Row J = pose_part(c, m);
  J(kDepthReadout) = m.dot(c.live_mps) * row_fraction(live_camera, c.live_px.y()) -
                     m.dot(c.view_mps) * row_fraction(view_camera, c.view_px.y());
  J.segment<kOffsets>(kOffset) = m.dot(c.p_camera) * c.p_camera.z() * offsets_at(live_camera, c.live_px) -
                                 inverse_sigma * static_cast<double>(c.pixel->offset_m) * c.p_view.z() *
                                     offsets_at(view_camera, c.view_px);
  sums.add(J, residual, weight);
  return weight;
}

void add_colour(const Correspondence& c, float live_intensity, const CameraPair& cameras,
                const Exposure& exposure, double depth_weight, Sums& sums) {
  const auto& [R_view_camera, live_camera, view_camera] = cameras;
  const double inverse_z = 1.0 / c.p_view.z();
  const auto gradient_u = static_cast<double>(c.pixel->gradient_u);
  const auto gradient_v = static_cast<double>(c.pixel->gradient_v);
  const double gu = gradient_u * view_camera.fx_px * inverse_z,
               gv = gradient_v * view_camera.fy_px * inverse_z;
  const double expected = static_cast<double>(c.pixel->intensity) + gradient_u * (c.view_px.x() - c.x) +
                          gradient_v * (c.view_px.y() - c.y);
  const Vector3d h(gu, gv, -(gu * c.p_view.x() + gv * c.p_view.y()) * inverse_z);
  const Vector3d m = (1.0 / kIntensitySigma) * (R_view_camera.transpose() * h);
  const double residual =
      (expected - static_cast<double>(exposure.gain * live_intensity + exposure.offset)) / kIntensitySigma -
      m.dot(c.view_steady_mps) * c.colour_late_s;
  Row J = pose_part(c, m);
  J(kColourReadout) = m.dot(c.live_mps) * row_fraction(live_camera, c.live_px.y()) -
                      m.dot(c.view_mps) * row_fraction(view_camera, c.view_px.y());
  J(kColourDelay) = m.dot(c.live_steady_mps - c.view_steady_mps);
  sums.add(J, residual, depth_weight * robust_weight(residual / kSoft));
}

TimingEvidence without_pose(const Sums& sums) {
  const Matrix6d regular = sums.H.topLeftCorner<kPose, kPose>() + 1e-3 * Matrix6d::Identity();
  const Matrix6d inverse_pose = inverse(regular);
  TimingEvidence evidence;
  if (!inverse_pose.allFinite()) return evidence;
  const Eigen::Matrix<double, kTimingParameters, kPose> coupling =
      sums.H.bottomLeftCorner<kTimingParameters, kPose>();
  evidence.H = sums.H.bottomRightCorner<kTimingParameters, kTimingParameters>() -
               coupling * inverse_pose * coupling.transpose();
  evidence.b = coupling * inverse_pose * sums.g.head<kPose>() - sums.g.tail<kTimingParameters>();
  return evidence;
}

}  // namespace

TimingEvidence timing_evidence(const SourcePoints& live, const MovingView& camera,
                               const TargetView& reference, const MovingView& view) {
  constexpr std::size_t kEvery = 4;
  const std::size_t level = std::min(live.levels.size(), reference.levels.size()) > 1 ? 1 : 0;
  if (level >= live.cameras.size() || level >= reference.levels.size()) return {};
  const std::vector<SourcePoint>& points = live.levels[level];
  const TargetLevel& target = reference.levels[level];
  const Intrinsics &live_camera = live.cameras[level], &view_camera = target.camera;
  const RowMotion motion = row_motion(live_camera, camera.velocity, camera.timing.depth_readout_s);
  const Eigen::Isometry3d T_view_camera = view.T_world_camera.inverse() * camera.T_world_camera;
  const Eigen::Matrix3d R = T_view_camera.linear();
  PointMatches matches;
  match_points({.points = points, .motion = motion}, target, {.T_view_camera = T_view_camera, .exposure = {}},
               {static_cast<float>(kGate_m), static_cast<float>(1.0 / kSoft),
                static_cast<float>(1.0 / kIntensitySigma)},
               matches);
  const Exposure exposure = match_exposure(matches);
  const CameraPair cameras{.R_view_camera = R, .live = live_camera, .view = view_camera};
  Sums sums;
  for (std::size_t i = 0; i < points.size(); i += kEvery) {
    Correspondence c;
    c.live_px = project(live_camera, points[i].p_camera.cast<double>());
    c.p_camera = motion.at_middle(points[i].p_camera).cast<double>();
    c.p_view = T_view_camera * c.p_camera;
    if (c.p_view.z() < 0.1) continue;
    c.view_px = project(view_camera, c.p_view);
    c.x = static_cast<int>(std::floor(c.view_px.x() + 0.5)),
    c.y = static_cast<int>(std::floor(c.view_px.y() + 0.5));
    if (!target.pixels.contains(c.x, c.y)) continue;
    c.pixel = &target.pixels.at(c.x, c.y);
    if (c.pixel->inverse_sigma_per_m <= 0.0F) continue;
    c.live_mps = motion_of(c.p_camera, camera.velocity);
    c.view_mps = R.transpose() * motion_of(c.p_view, view.velocity);
    c.live_steady_mps = motion_of(c.p_camera, camera.steady_velocity);
    c.view_steady_mps = R.transpose() * motion_of(c.p_view, view.steady_velocity);
    c.colour_late_s = camera.timing.colour_delay_s - view.timing.colour_delay_s +
                      (camera.timing.colour_readout_s - view.timing.colour_readout_s) *
                          row_fraction(view_camera, c.view_px.y());
    const double weight = add_depth(c, cameras, sums);
    const bool is_textured = c.pixel->gradient_u != 0.0F || c.pixel->gradient_v != 0.0F;
    if (weight > 0.0 && exposure.known && is_textured && points[i].intensity >= 0.0F)
      add_colour(c, points[i].intensity, cameras, exposure, weight, sums);
  }
  return without_pose(sums);
}

}  // namespace roomradar
