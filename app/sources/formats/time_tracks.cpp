// time_tracks.cpp: binary search in sorted tracks.
#include "app/sources/formats/time_tracks.hpp"

#include <algorithm>
#include <cmath>

#include "app/sources/formats/camera_rig.hpp"
#include "app/sources/formats/kinect_units.hpp"
#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

constexpr double kSameStamp_s = 2e-6;  // text files state stamps to 1 us

template <typename Stamped>
void sort_stamped(std::vector<Stamped>& items) {
  std::stable_sort(items.begin(), items.end(),
                   [](const Stamped& a, const Stamped& b) { return a.stamp_s < b.stamp_s; });
}

/// Returns the first item at or after the stamp.
template <typename Stamped>
auto first_from(const std::vector<Stamped>& items, double stamp_s) {
  return std::lower_bound(items.begin(), items.end(), stamp_s,
                          [](const Stamped& item, double s) { return item.stamp_s < s; });
}

}  // namespace

void sort_by_stamp(std::vector<StampedPose>& poses) { sort_stamped(poses); }
void sort_by_stamp(std::vector<StampedAcceleration>& accelerations) { sort_stamped(accelerations); }

std::optional<Eigen::Isometry3d> pose_at(const std::vector<StampedPose>& poses, double stamp_s,
                                         double max_gap_s) {
  const auto after = first_from(poses, stamp_s - kSameStamp_s);
  if (after == poses.end()) return std::nullopt;
  if (after->stamp_s <= stamp_s + kSameStamp_s) return after->T;
  if (after == poses.begin()) return std::nullopt;
  const auto before = after - 1;
  const double gap_s = after->stamp_s - before->stamp_s;
  if (!(gap_s <= max_gap_s)) return std::nullopt;
  const double fraction = (stamp_s - before->stamp_s) / gap_s;
  const Eigen::Quaterniond q_before(before->T.linear()), q_after(after->T.linear());
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = q_before.slerp(fraction, q_after).toRotationMatrix();
  T.translation() = before->T.translation() + fraction * (after->T.translation() - before->T.translation());
  return T;
}

std::optional<Eigen::Vector3d> down_at(const std::vector<StampedAcceleration>& accelerations, double stamp_s,
                                       double within_s) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (auto each = first_from(accelerations, stamp_s - within_s);
       each != accelerations.end() && each->stamp_s <= stamp_s + within_s; ++each, ++count)
    sum += each->acceleration_m_s2;
  if (count == 0) return std::nullopt;
  const double g = (sum / count).norm() / kStandardGravity_m_s2;
  if (!(g > 0.8 && g < 1.2)) return std::nullopt;
  return Eigen::Vector3d(-sum.normalized());
}

std::optional<Eigen::Isometry3d> rigid_pose(const Eigen::Vector3d& t_m, const Eigen::Vector4d& q_xyzw) {
  const double norm = q_xyzw.norm();
  if (!t_m.allFinite() || !(norm > 0.9 && norm < 1.1)) return std::nullopt;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Quaterniond(q_xyzw).normalized().toRotationMatrix();
  T.translation() = t_m;
  return T;
}

std::optional<Eigen::Isometry3d> rigid_transform(const Eigen::Matrix<double, 3, 4>& matrix) {
  if (!matrix.allFinite()) return std::nullopt;
  const auto rotation = nearest_rotation(matrix.leftCols<3>());
  if (!rotation) return std::nullopt;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = *rotation;
  T.translation() = matrix.col(3);
  return T;
}

}  // namespace roomradar
