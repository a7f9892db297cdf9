// bag_frame_writer.hpp: writes frames as messages of ROS 1.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "app/sources/containers/ros_bag_writer.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Writes a bag with the topics that ROS drivers of depth cameras have: depth in m (32FC1), colour (rgb8),
/// their camera_info, gravity as the acceleration of an IMU at rest, poses and the pose of the colour camera
/// in tf. Poses are written a second time as matrices (kPoseTopic), since conversion to the quaternions of tf
/// loses the last bits.
class BagFrameWriter {
 public:
  /// Throws Error if the file cannot be written.
  explicit BagFrameWriter(const std::filesystem::path& path);

  /// Appends a frame. Throws Error if it cannot be written or its stamp cannot be stored.
  void write(const Frame& frame);
  /// Completes the bag. Throws Error if it cannot be written.
  void close() { bag_.close(); }

 private:
  RosBagWriter bag_;
  std::uint32_t depth_, depth_info_, colour_, colour_info_, tf_, tf_static_, imu_, pose_;
  std::uint32_t sequence_ = 0;
};

}  // namespace roomradar
