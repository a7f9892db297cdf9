// bag_frame_writer.hpp: writes frames to a ROS 1 bag.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "app/sources/containers/ros_bag.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Writes a bag with the topics that ROS drivers of depth cameras publish: depth in m (32FC1), colour (rgb8),
/// and their camera_info. Gravity is written as the acceleration of an IMU at rest. Camera poses and the
/// extrinsics of the colour camera are written to tf. Camera poses are also written as matrices (kPoseTopic),
/// since conversion to tf's quaternions rounds.
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
