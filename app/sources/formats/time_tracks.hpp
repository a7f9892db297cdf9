// time_tracks.hpp: poses and accelerations over time, looked up at the time of a frame.
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace roomradar {

struct StampedPose {
  double stamp_s = 0.0;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
};

struct StampedAcceleration {
  double stamp_s = 0.0;
  Eigen::Vector3d acceleration_m_s2 = Eigen::Vector3d::Zero();
};

/// Sort by stamp, as pose_at() and down_at() require.
void sort_by_stamp(std::vector<StampedPose>& poses);
void sort_by_stamp(std::vector<StampedAcceleration>& accelerations);

/// Returns the pose at a stamp, interpolated (linear and slerp) between the poses before and after it. A pose
/// within 2 us of the stamp is returned unchanged. Returns nullopt outside the track, and in gaps of more
/// than max_gap_s.
[[nodiscard]] std::optional<Eigen::Isometry3d> pose_at(const std::vector<StampedPose>& poses, double stamp_s,
                                                       double max_gap_s);

/// Returns the unit direction of gravity in the accelerometer's frame: opposite to the mean of the readings
/// within `within_s` of the stamp. A wider window averages out more of a hand-held camera's own acceleration.
/// Returns nullopt without readings, and if the mean's magnitude is outside 0.8 to 1.2 g.
[[nodiscard]] std::optional<Eigen::Vector3d> down_at(const std::vector<StampedAcceleration>& accelerations,
                                                     double stamp_s, double within_s);

/// Returns the pose of a translation (m) and a quaternion x y z w. Returns nullopt if a number is not finite
/// or the quaternion's norm is outside 0.9 to 1.1; some trackers write zeros when tracking is lost.
[[nodiscard]] std::optional<Eigen::Isometry3d> rigid_pose(const Eigen::Vector3d& t_m,
                                                          const Eigen::Vector4d& q_xyzw);

/// Returns the pose of a rotation and a translation (m). Returns nullopt if a number is not finite or the
/// left 3 x 3 block is not a rotation, see nearest_rotation().
[[nodiscard]] std::optional<Eigen::Isometry3d> rigid_transform(const Eigen::Matrix<double, 3, 4>& matrix);

}  // namespace roomradar
