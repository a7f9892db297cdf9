// feature_flow.cpp: corners, their flow, and the pose that explains it.
#include "mapping/alignment/feature_flow.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "mapping/alignment/point_to_plane.hpp"
#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

Intrinsics camera_of(const Frame& frame, const Image<float>& grey) {
  Intrinsics camera =
      scaled(frame.colour_camera, static_cast<double>(grey.width) / frame.colour_camera.width_px);
  camera.width_px = grey.width;
  camera.height_px = grey.height;
  return camera;
}

Image<std::uint8_t> bytes_of(const Image<float>& grey) {
  Image<std::uint8_t> bytes(grey.width, grey.height);
  std::transform(grey.pixels.begin(), grey.pixels.end(), bytes.pixels.begin(), [](float level) {
    return static_cast<std::uint8_t>(std::clamp(level + 0.5F, 0.0F, 255.0F));
  });
  return bytes;
}

cv::Mat view_of(const Image<std::uint8_t>& image) {
  return {image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.pixels.data())};
}

/// Returns the nearest measured point per pixel of the grey image, in the depth camera's frame; z = 0: none.
Image<Eigen::Vector3f> points_seen(const Frame& frame, const Image<float>& grey) {
  constexpr int kStep_px = 2;
  Image<Eigen::Vector3f> points(grey.width, grey.height, Eigen::Vector3f::Zero());
  const Intrinsics camera = camera_of(frame, grey);
  for (int y = 0; y < frame.depth_m.height; y += kStep_px) {
    for (int x = 0; x < frame.depth_m.width; x += kStep_px) {
      const float depth_m = frame.depth_m.at(x, y);
      if (!(depth_m > 0.0F)) continue;
      const Eigen::Vector3d p = back_project(frame.depth_camera, x, y, static_cast<double>(depth_m));
      const Eigen::Vector3d p_colour = frame.T_colour_depth * p;
      if (!(p_colour.z() > 0.05)) continue;
      const Eigen::Vector2d at = project(camera, p_colour);
      const int u = static_cast<int>(std::lround(at.x())), v = static_cast<int>(std::lround(at.y()));
      if (!(at.x() >= 0.0 && at.y() >= 0.0) || u >= grey.width || v >= grey.height) continue;
      Eigen::Vector3f& point = points.at(u, v);
      if (point.z() == 0.0F || p.z() < static_cast<double>(point.z())) point = p.cast<float>();
    }
  }
  return points;
}

/// Returns the point nearest to the camera within one pixel: an edge belongs to the surface in front.
Eigen::Vector3f nearest_around(const Image<Eigen::Vector3f>& points, int u, int v) {
  Eigen::Vector3f nearest = Eigen::Vector3f::Zero();
  for (int y = std::max(v - 1, 0); y <= std::min(v + 1, points.height - 1); ++y) {
    for (int x = std::max(u - 1, 0); x <= std::min(u + 1, points.width - 1); ++x) {
      const Eigen::Vector3f& point = points.at(x, y);
      if (point.z() > 0.0F && (nearest.z() == 0.0F || point.z() < nearest.z())) nearest = point;
    }
  }
  return nearest;
}

/// One followed corner: a point of the reference, in the world, and where the frame shows it.
struct Followed {
  Eigen::Vector3d p_world;
  Eigen::Vector2d at_px;
};

struct Reprojection {
  NormalEquations equations;
  int inliers = 0;
};

/// Sums the reprojection errors at a pose, linearised with respect to the camera's twist in the camera frame.
Reprojection reproject(const std::vector<Followed>& followed, const Frame& frame, const Intrinsics& camera,
                       const Eigen::Isometry3d& T_world_camera, double scale_px) {
  constexpr double kSigma_px = 0.7, kInlier_px = 2.0;
  constexpr double kIndependent = 0.25;  // neighbouring corners share errors of depth
  Reprojection sum;
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  const Eigen::Matrix3d& R = frame.T_colour_depth.linear();
  for (const Followed& corner : followed) {
    const Eigen::Vector3d p = T_camera_world * corner.p_world, c = frame.T_colour_depth * p;
    if (!(c.z() > 0.05)) continue;
    const Eigen::Vector2d error = project(camera, c) - corner.at_px;
    sum.inliers += error.norm() < kInlier_px ? 1 : 0;
    Eigen::Matrix<double, 2, 3> by_point;
    by_point << camera.fx_px / c.z(), 0.0, -camera.fx_px * c.x() / (c.z() * c.z()), 0.0, camera.fy_px / c.z(),
        -camera.fy_px * c.y() / (c.z() * c.z());
    Eigen::Matrix<double, 3, 6> by_twist;  // the point moves against the camera
    by_twist.leftCols<3>() = -Eigen::Matrix3d::Identity();
    for (int k = 0; k < 3; ++k) by_twist.col(3 + k) = -Eigen::Vector3d::Unit(k).cross(p);
    const Eigen::Matrix<double, 2, 6> J = by_point * R * by_twist;
    const double weight = kIndependent * robust_weight(error.norm() / scale_px) / (kSigma_px * kSigma_px);
    sum.equations.H += weight * J.transpose() * J;
    sum.equations.g += weight * J.transpose() * error;
  }
  return sum;
}

}  // namespace

FlowReference make_flow_reference(const Frame& frame, const Image<float>& grey) {
  constexpr int kMost = 250;
  constexpr double kQuality = 0.005, kApart_px = 6.0;
  FlowReference reference;
  if (grey.empty() || frame.colour.empty()) return reference;
  reference.grey = bytes_of(grey);
  std::vector<cv::Point2f> corners;
  cv::goodFeaturesToTrack(view_of(reference.grey), corners, kMost, kQuality, kApart_px);
  const Image<Eigen::Vector3f> points = points_seen(frame, grey);
  for (const cv::Point2f& corner : corners) {
    const Eigen::Vector3f point = nearest_around(points, static_cast<int>(std::lround(corner.x)),
                                                 static_cast<int>(std::lround(corner.y)));
    if (point.z() == 0.0F) continue;
    reference.corners_px.emplace_back(corner.x, corner.y);
    reference.p_camera.push_back(point.cast<double>());
  }
  return reference;
}

bool is_weak(const Tracking& aligned) {
  constexpr double kLeast = 1.0 / (0.02 * 0.02);  // 2 cm, or rad times 1 m
  const SymmetricEigen<6> known = symmetric_eigen(aligned.clear_information);
  return !known.converged || known.values(0) < kLeast;
}

FlowPose constrain_by_flow(const FlowReference& reference, const Eigen::Isometry3d& T_world_reference,
                           const Frame& frame, const Image<float>& grey, const Tracking& aligned,
                           const AlignConfig& config) {
  constexpr std::size_t kFewest = 20;
  constexpr int kWindow_px = 15, kLevels = 3;
  constexpr float kMostError = 25.0F;  // mean difference of grey levels in the window
  FlowPose result{aligned};
  if (reference.corners_px.size() < kFewest || grey.width != reference.grey.width ||
      grey.height != reference.grey.height || frame.colour.empty() || !has_pose(aligned))
    return result;
  const Intrinsics camera = camera_of(frame, grey);
  std::vector<cv::Point2f> before, now;
  std::vector<std::size_t> index;
  const Eigen::Isometry3d T_camera_reference = aligned.T_world_camera.inverse() * T_world_reference;
  for (std::size_t i = 0; i < reference.corners_px.size(); ++i) {
    const Eigen::Vector3d c = frame.T_colour_depth * (T_camera_reference * reference.p_camera[i]);
    if (!(c.z() > 0.05)) continue;
    const Eigen::Vector2d at = project(camera, c);
    if (!(at.x() >= 0.0 && at.y() >= 0.0 && at.x() < grey.width && at.y() < grey.height)) continue;
    before.emplace_back(reference.corners_px[i].x(), reference.corners_px[i].y());
    now.emplace_back(static_cast<float>(at.x()), static_cast<float>(at.y()));
    index.push_back(i);
  }
  if (before.size() < kFewest) return result;
  const Image<std::uint8_t> bytes = bytes_of(grey);
  std::vector<std::uint8_t> is_found;
  std::vector<float> errors;
  cv::calcOpticalFlowPyrLK(view_of(reference.grey), view_of(bytes), before, now, is_found, errors,
                           {kWindow_px, kWindow_px}, kLevels, {}, cv::OPTFLOW_USE_INITIAL_FLOW);
  std::vector<Followed> followed;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (is_found[i] == 0 || errors[i] > kMostError) continue;
    followed.push_back({T_world_reference * reference.p_camera[index[i]],
                        {static_cast<double>(now[i].x), static_cast<double>(now[i].y)}});
  }
  Eigen::Isometry3d T_world_camera = aligned.T_world_camera;
  Matrix6d information = Matrix6d::Zero();
  int inliers = 0;
  for (const double scale_px : {8.0, 8.0, 8.0, 4.0, 4.0, 2.0, 2.0, 2.0}) {
    const Reprojection sum = reproject(followed, frame, camera, T_world_camera, scale_px);
    information = aligned.clear_information + sum.equations.H;
    const Vector6d from_aligned = local(aligned.T_world_camera.inverse() * T_world_camera);
    const Vector6d step =
        solve_symmetric(information, Vector6d(aligned.clear_information * from_aligned + sum.equations.g));
    if (!step.allFinite() || step.norm() > 0.5) return result;
    T_world_camera = T_world_camera * retract(-step);
  }
  inliers = reproject(followed, frame, camera, T_world_camera, 2.0).inliers;
  result.followed = static_cast<double>(inliers) / static_cast<double>(reference.corners_px.size());
  if (inliers < static_cast<int>(kFewest) || 2 * inliers < static_cast<int>(followed.size())) return result;
  // Where both agree, the alignment is more accurate.
  constexpr double kDisagree_m = 0.03, kLever_m = 1.5;
  const Vector6d apart = local(aligned.T_world_camera.inverse() * T_world_camera);
  if (aligned && apart.head<3>().norm() + kLever_m * apart.tail<3>().norm() < kDisagree_m) return result;
  result.is_used = true;
  result.tracking.T_world_camera = T_world_camera;
  result.tracking.T_world_camera.linear() =
      Eigen::Quaterniond(T_world_camera.linear()).normalized().toRotationMatrix();
  result.tracking.information = information;
  const double most_m = static_cast<double>(config.max_uncertainty_m);
  const SymmetricEigen<6> known = symmetric_eigen(information);
  result.tracking.unconstrained_dofs =
      static_cast<int>((known.values.array() < 1.0 / (most_m * most_m)).count());
  result.tracking.status =
      result.tracking.unconstrained_dofs > 0 ? TrackStatus::kDegenerate : TrackStatus::kTracked;
  return result;
}

}  // namespace roomradar
