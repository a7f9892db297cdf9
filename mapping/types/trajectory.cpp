// trajectory.cpp: reads, writes and scores poses over time.
#include "mapping/types/trajectory.hpp"

#include <array>
#include <cmath>
#include <locale>
#include <map>
#include <sstream>
#include <string>

#include "mapping/types/linear_algebra.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

struct MatchedPoints {
  Eigen::Matrix3Xd estimated, expected;
};

/// Transforms points of the camera by both trajectories, for the frames that both contain.
MatchedPoints matched_points(const std::vector<TimedPose>& estimate, const std::vector<TimedPose>& reference,
                             const Eigen::Matrix3Xd& points_camera) {
  std::map<std::int64_t, const Eigen::Isometry3d*> T_reference_camera;
  for (const TimedPose& pose : reference) T_reference_camera[pose.frame_index] = &pose.T_world_camera;
  const Eigen::Index points = points_camera.cols();
  Eigen::Matrix3Xd estimated(3, points * static_cast<Eigen::Index>(estimate.size()));
  Eigen::Matrix3Xd expected(3, estimated.cols());
  Eigen::Index matched = 0;
  for (const TimedPose& pose : estimate) {
    const auto found = T_reference_camera.find(pose.frame_index);
    if (found == T_reference_camera.end()) continue;
    estimated.middleCols(matched, points) = pose.T_world_camera * points_camera;
    expected.middleCols(matched, points) = *found->second * points_camera;
    matched += points;
  }
  return {estimated.leftCols(matched), expected.leftCols(matched)};
}

}  // namespace

std::string trajectory_line(const TimedPose& pose) {
  const Eigen::Vector3d t = pose.T_world_camera.translation();
  const Eigen::Quaterniond q(pose.T_world_camera.linear());
  std::string line = format_fixed(pose.stamp_s, 9);
  for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()})
    line += ' ' + format_general(value, 12);
  return line + '\n';
}

void write_trajectory(const std::filesystem::path& path, const std::vector<TimedPose>& trajectory) {
  std::string text = kTrajectoryHeader;
  for (const TimedPose& pose : trajectory) text += trajectory_line(pose);
  write_bytes(path, text);
}

std::vector<TimedPose> read_trajectory(const std::filesystem::path& path) {
  std::istringstream file(read_bytes(path, "a trajectory"));
  std::vector<TimedPose> trajectory;
  std::string line;
  for (int line_number = 1; std::getline(file, line); ++line_number) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    words.imbue(std::locale::classic());
    std::array<double, 8> v{};
    for (double& value : v) {
      if (!(words >> value) || !std::isfinite(value))
        throw Error(path.string() + ":" + std::to_string(line_number) +
                    ": expected 8 numbers `stamp tx ty tz qx qy qz qw`, got \"" + line.substr(0, 100) + "\"");
    }
    const Eigen::Quaterniond q_xyzw(v[7], v[4], v[5], v[6]);
    if (std::abs(q_xyzw.norm() - 1.0) > 0.01)
      throw Error(path.string() + ":" + std::to_string(line_number) + ": the quaternion's length is " +
                  format_fixed(q_xyzw.norm(), 6) + ", not 1");
    TimedPose pose;
    pose.frame_index = static_cast<std::int64_t>(trajectory.size());
    pose.stamp_s = v[0];
    pose.T_world_camera.linear() = q_xyzw.normalized().toRotationMatrix();
    pose.T_world_camera.translation() = Eigen::Vector3d(v[1], v[2], v[3]);
    trajectory.push_back(pose);
  }
  return trajectory;
}

TrajectoryError absolute_trajectory_error(const std::vector<TimedPose>& estimate,
                                          const std::vector<TimedPose>& reference) {
  const auto [estimated, expected] = matched_points(estimate, reference, Eigen::Vector3d::Zero());
  if (estimated.cols() < 3) return {};
  TrajectoryError error;
  error.poses = static_cast<std::size_t>(estimated.cols());
  error.T_reference_estimate = fit_rigid(estimated, expected);
  const Eigen::RowVectorXd squared_m2 =
      ((error.T_reference_estimate * estimated).eval() - expected).colwise().squaredNorm();
  error.rmse_m = std::sqrt(squared_m2.mean());
  error.max_m = std::sqrt(squared_m2.maxCoeff());
  return error;
}

std::optional<Eigen::Isometry3d> pose_alignment(const std::vector<TimedPose>& estimate,
                                                const std::vector<TimedPose>& reference) {
  Eigen::Matrix3Xd points_camera = Eigen::Matrix3Xd::Zero(3, 4);
  points_camera.rightCols<3>().setIdentity();
  const auto [estimated, expected] = matched_points(estimate, reference, points_camera);
  if (estimated.cols() == 0) return std::nullopt;
  return fit_rigid(estimated, expected);
}

double end_gap_m(const std::vector<TimedPose>& estimate, const std::vector<TimedPose>& reference) {
  if (estimate.empty() || reference.empty()) return 0.0;
  const auto end = [](const std::vector<TimedPose>& poses) -> Eigen::Vector3d {
    return poses.front().T_world_camera.inverse() * poses.back().T_world_camera.translation();
  };
  return (end(estimate) - end(reference)).norm();
}

}  // namespace roomradar
