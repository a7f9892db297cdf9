// up_direction.hpp: estimates the up direction of a recording, from the accelerometer or from planes.
#pragma once
#include <Eigen/Geometry>
#include <string_view>
#include <vector>

#include "mapping/types/frame.hpp"

namespace roomradar {

enum class UpSource {
  kNone,           ///< nothing usable: mean of the cameras' -y
  kAccelerometer,  ///< gravity measured by the device
  kPlane,          ///< normal of the dominant plane that is roughly level for an upright camera
};
std::string_view to_string(UpSource source);

struct UpDirection {
  UpSource source = UpSource::kNone;
  Eigen::Vector3d up_world = Eigen::Vector3d::UnitZ();  ///< unit
  double support = 0.0;  ///< kPlane: fraction of all normals within 5 degrees of up_world; else 1 or 0
};

/// Accumulates measurements frame by frame; callers add only frames with trusted poses.
class UpEstimator {
 public:
  /// Adds the frame's gravity, and normals of its depth on a grid 20 columns wide, both rotated into the
  /// world.
  void add(const Frame& frame, const Eigen::Isometry3d& T_world_camera);

  /// Returns the mean of gravity if at least half of the frames have it. Otherwise returns the most frequent
  /// normal within 60 degrees of the cameras' mean -y, if at least 5 % of the normals support it. A hand-held
  /// camera may look down at a table, but is rarely upside down. Otherwise returns the mean -y with kNone.
  [[nodiscard]] UpDirection estimate() const;

  /// Serialises the complete state to a ByteWriter, or from a ByteReader.
  template <typename Archive>
  void serialize_fields(Archive& archive) {
    serialize(archive, normals_world_);
    serialize(archive, normals_seen_);
    serialize(archive, keep_every_);
    serialize(archive, down_sum_world_);
    serialize(archive, camera_up_sum_world_);
    serialize(archive, frames_);
    serialize(archive, frames_with_gravity_);
    if constexpr (Archive::kReads) {
      if (keep_every_ == 0) archive.fail("is damaged: no normal is kept");
    }
  }

 private:
  /// Keeps the first of each keep_every_ normals. When full, drops every second one and doubles keep_every_,
  /// so all frames keep equal weight, however many there are.
  void keep(const Eigen::Vector3f& normal_world);

  std::vector<Eigen::Vector3f> normals_world_;
  std::size_t normals_seen_ = 0;
  std::size_t keep_every_ = 1;
  Eigen::Vector3d down_sum_world_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d camera_up_sum_world_ = Eigen::Vector3d::Zero();
  std::size_t frames_ = 0;
  std::size_t frames_with_gravity_ = 0;
};

/// Returns the shortest rotation from `up_world` to +z; if up_world = -z, a rotation about x.
Eigen::Isometry3d level_rotation(const Eigen::Vector3d& up_world);

}  // namespace roomradar
