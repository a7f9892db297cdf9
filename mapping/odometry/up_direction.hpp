// up_direction.hpp: estimates a recording's up direction from the accelerometer or from dominant planes.
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <string_view>
#include <vector>

#include "mapping/types/frame.hpp"
#include "mapping/types/serialize.hpp"

namespace roomradar {

enum class UpSource {
  kNone,           ///< neither gravity nor a plane was usable; up_world: mean camera -y axis (no frames: +z)
  kAccelerometer,  ///< mean gravity measured by the device
  kPlane,          ///< most frequent normal within 60 degrees of the cameras' mean -y axis
  kGiven,          ///< stated by the user
};
std::string_view to_string(UpSource source);

struct UpDirection {
  UpSource source = UpSource::kNone;
  Eigen::Vector3d up_world = Eigen::Vector3d::UnitZ();  ///< unit vector
  /// Fraction of all normals that are within 5 degrees of up_world, for kPlane. 1 for kAccelerometer and
  /// kGiven, 0 for kNone.
  double support = 0.0;
};

/// Up direction that a user states.
struct GivenUp {
  /// Unit vector in the poses' world frame; unset: the cameras' mean -y axis.
  std::optional<Eigen::Vector3d> up_world;
};

/// Estimates the up direction from measurements, which it accumulates frame by frame. Callers should add only
/// frames with trusted poses.
class UpEstimator {
 public:
  /// Adds the frame's gravity, if measured. Adds normals of its depth image, sampled on a grid of 20 columns.
  /// Both are rotated into the world frame.
  void add(const Frame& frame, const Eigen::Isometry3d& T_world_camera);

  /// Returns the up direction from the first usable source:
  /// (1) mean gravity, if at least half of the frames have gravity,
  /// (2) the most frequent normal within 60 degrees of the cameras' mean -y axis, if at least 5 % of all
  /// normals are within 5 degrees of it,
  /// (3) the mean -y axis, with kNone.
  /// The limit of 60 degrees allows for a hand-held camera that looks down at a table. It assumes that
  /// cameras are rarely upside down.
  [[nodiscard]] UpDirection estimate() const;
  /// Returns the direction that the user stated, with kGiven.
  [[nodiscard]] UpDirection take(const GivenUp& given) const;

  /// The complete state.
  template <typename Archive>
  friend void serialize(Archive& archive, Ref<Archive, UpEstimator> up) {
    archive(up.normals_world_, up.normals_seen_, up.keep_every_, up.down_sum_world_, up.camera_up_sum_world_,
            up.frames_, up.frames_with_gravity_);
    if constexpr (Archive::kReads) {
      if (up.keep_every_ == 0) archive.fail("is damaged: no normal is kept");
    }
  }

 private:
  /// Returns the cameras' mean -y axis.
  [[nodiscard]] Eigen::Vector3d camera_up() const;
  /// Stores every keep_every_-th normal. When the buffer is full, drops every second stored normal and
  /// doubles keep_every_, so early and late frames have equal weight.
  void keep(const Eigen::Vector3f& normal_world);

  std::vector<Eigen::Vector3f> normals_world_;
  std::size_t normals_seen_ = 0;
  std::size_t keep_every_ = 1;
  Eigen::Vector3d down_sum_world_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d camera_up_sum_world_ = Eigen::Vector3d::Zero();
  std::size_t frames_ = 0;
  std::size_t frames_with_gravity_ = 0;
};

/// Returns the rotation by the smallest angle that maps `up_world` to +z. If up_world is -z, rotates about x.
Eigen::Isometry3d level_rotation(const Eigen::Vector3d& up_world);

}  // namespace roomradar
