// ros_recording.hpp: recordings of ROS as frames.
#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "app/sources/containers/message_log.hpp"
#include "app/sources/datasets/recording_facts.hpp"

namespace roomradar {

/// Topic on which roomradar writes T_world_camera as a row-major 4 x 4 matrix of doubles, without rounding.
inline constexpr const char* kPoseTopic = "/roomradar/T_world_camera";

/// Lists the frames of a recording of ROS: depth and colour images with their camera_info, each with its own
/// intrinsics. Poses come from kPoseTopic, else from tf if the depth camera's frame moves in tf. Gravity
/// comes from an IMU with known extrinsics to the depth camera (from tf or a RealSense's topics). Stamps are
/// those of the message headers, except in compressed files, where reading all headers takes too long. There,
/// a stamp is the message's time of reception plus the median of (header stamp - time of reception) over the
/// first five messages. Times of reception are stated beside the stamps.
/// @param depth_topic  name of the topic with depth images; empty: see find_streams()
/// @throws Error naming the file and its topics if it contains no depth images (on that topic)
RecordingFacts index_ros_recording(const std::shared_ptr<const MessageLog>& log,
                                   const std::string& depth_topic);

/// Opens a bag of ROS 1.
RecordingFacts index_ros1_bag(const std::filesystem::path& path, const std::string& depth_topic);
/// Opens a bag of ROS 2.
RecordingFacts index_ros2_bag(const std::filesystem::path& path, const std::string& depth_topic);

}  // namespace roomradar
