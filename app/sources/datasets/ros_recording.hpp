// ros_recording.hpp: recordings of ROS as frames.
#pragma once
#include <filesystem>
#include <memory>

#include "app/sources/containers/message_log.hpp"
#include "app/sources/datasets/indexed_source.hpp"

namespace roomradar {

/// Topic on which roomradar writes T_world_camera as the 16 numbers of a matrix, row by row, without loss of
/// bits.
inline constexpr const char* kPoseTopic = "/roomradar/T_world_camera";

/// Lists the frames of a recording of ROS: depth and colour images with their camera_info, each in its own
/// camera. Poses come from roomradar's topic, else from tf, if the depth camera's frame moves in it. Gravity
/// comes from an IMU whose frame tf, or a RealSense's extrinsics, relate to the depth camera. Stamps are
/// those of the message headers. For compressed files, whose headers cannot be read at once, they are the
/// times of reception, shifted by the median difference of the first messages.
/// @throws Error naming the file and its topics if it holds no depth images or no camera_info
IndexedRecording index_ros_recording(const std::shared_ptr<const MessageLog>& log);

/// Opens a bag of ROS 1.
IndexedRecording index_ros1_bag(const std::filesystem::path& path);
/// Opens a bag of ROS 2.
IndexedRecording index_ros2_bag(const std::filesystem::path& path);

}  // namespace roomradar
