// ros_messages.hpp: messages of ROS 1 and ROS 2 that describe images, cameras and motion.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "app/sources/containers/message_log.hpp"

namespace roomradar {

/// Bytes of a message and how they are encoded.
struct MessageBytes {
  MessageEncoding encoding = MessageEncoding::kRos1;
  std::string_view bytes{};
  std::string where{};  ///< for error messages
};

struct RosHeader {
  double stamp_s = 0.0;
  std::string frame_id{};  ///< without a leading slash
};

/// sensor_msgs/Image. `data` refers to the message's bytes.
struct RosImage {
  RosHeader header;
  std::uint32_t height = 0, width = 0, step = 0;
  std::string encoding;
  bool is_big_endian = false;
  std::string_view data;
};

/// sensor_msgs/CompressedImage. `data` refers to the message's bytes.
struct RosCompressedImage {
  RosHeader header;
  std::string format;
  std::string_view data;
};

/// The used fields of sensor_msgs/CameraInfo.
struct RosCameraInfo {
  RosHeader header;
  std::uint32_t height = 0, width = 0;
  std::string distortion_model;
  std::vector<double> D;
  std::array<double, 9> K{};   ///< row-major
  std::array<double, 12> P{};  ///< projection matrix of the rectified image, row-major
};

/// sensor_msgs/Imu, its acceleration only.
struct RosAcceleration {
  RosHeader header;
  Eigen::Vector3d acceleration_m_s2 = Eigen::Vector3d::Zero();
};

/// geometry_msgs/TransformStamped: transforms points from the frame `child` to the frame header.frame_id.
struct RosTransform {
  RosHeader header;
  std::string child;
  Eigen::Vector3d t_m = Eigen::Vector3d::Zero();
  Eigen::Vector4d q_xyzw = Eigen::Vector4d::Zero();
};

/// Decode messages. All functions throw Error naming `where` if the message is truncated or damaged.
RosHeader read_header(const MessageBytes& message);
RosImage read_image(const MessageBytes& message);
RosCompressedImage read_compressed_image(const MessageBytes& message);
RosCameraInfo read_camera_info(const MessageBytes& message);
RosAcceleration read_acceleration(const MessageBytes& message);
/// tf2_msgs/TFMessage and tf/tfMessage.
std::vector<RosTransform> read_transforms(const MessageBytes& message);
/// geometry_msgs/Transform. In the result, `header` and `child` are empty.
RosTransform read_transform(const MessageBytes& message);
/// std_msgs/Float32.
float read_float(const MessageBytes& message);
/// std_msgs/Float64MultiArray, its numbers only.
std::vector<double> read_numbers(const MessageBytes& message);

}  // namespace roomradar
