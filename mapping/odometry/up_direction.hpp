// up_direction.hpp: which way is up in a recording, from the accelerometer or from the planes seen.
#pragma once
#include <Eigen/Geometry>
#include <string_view>
#include <vector>

#include "mapping/types/frame.hpp"

namespace roomradar {

enum class UpSource {
  kNone,           ///< nothing usable was seen: the mean of the cameras' -y is taken
  kAccelerometer,  ///< gravity measured by the device
  kPlane,          ///< normal of the dominant plane that lies roughly level for a camera held upright
};
std::string_view to_string(UpSource source);

struct UpDirection {
  UpSource source = UpSource::kNone;
  Eigen::Vector3d up_world = Eigen::Vector3d::UnitZ();  ///< unit
  double support = 0.0;  ///< kPlane: part of all measured normals within 5 degrees of up_world; else 1 or 0
};

/// Collects evidence frame by frame; frames whose pose is not trusted are not to be added.
class UpEstimator {
 public:
  /// Takes the frame's gravity, and the normals of its depth at a grid of 20 across, both turned into the
  /// world.
  void add(const Frame& frame, const Eigen::Isometry3d& T_world_camera);

  /// Gravity's mean where at least half of the frames had one, else the strongest normal direction within 60
  /// degrees of the cameras' mean -y (a hand-held camera may look down at a table, but is seldom on its
  /// head), if at least 5 % of the normals support it; else that mean itself with kNone.
  [[nodiscard]] UpDirection estimate() const;

  /// All of its state, to or from a ByteWriter or ByteReader.
  template <typename Archive>
  void transfer_fields(Archive& archive) {
    transfer(archive, normals_world_);
    transfer(archive, normals_seen_);
    transfer(archive, keep_every_);
    transfer(archive, down_sum_world_);
    transfer(archive, camera_up_sum_world_);
    transfer(archive, frames_);
    transfer(archive, frames_with_gravity_);
    if constexpr (Archive::kReads) {
      if (keep_every_ == 0) archive.fail("is damaged: no normal is kept");
    }
  }

 private:
  /// Keeps the first of each keep_every_ normals. Full, it gives up every second one and takes half as many
  /// from then on, so that all frames keep an equal say, however many there are.
  void keep(const Eigen::Vector3f& normal_world);

  std::vector<Eigen::Vector3f> normals_world_;
  std::size_t normals_seen_ = 0;
  std::size_t keep_every_ = 1;
  Eigen::Vector3d down_sum_world_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d camera_up_sum_world_ = Eigen::Vector3d::Zero();
  std::size_t frames_ = 0;
  std::size_t frames_with_gravity_ = 0;
};

/// The rotation that takes `up_world` to +z by the shortest way; up_world = -z turns about x.
Eigen::Isometry3d level_rotation(const Eigen::Vector3d& up_world);

}  // namespace roomradar
