// ros_recording.cpp: stamps, extrinsics, poses and gravity of a ROS recording.
#include "app/sources/datasets/ros_recording.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/sources/containers/ros2_bag.hpp"
#include "app/sources/containers/ros_bag.hpp"
#include "app/sources/datasets/ros_images.hpp"
#include "app/sources/datasets/ros_transforms.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "app/sources/formats/time_tracks.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr double kImuWithin_s = 0.05;

/// Returns the stamp of a message's header; nullopt if the message is damaged.
std::optional<double> header_stamp_s(const MessageLog& log, const MessageEntry& entry) {
  constexpr std::uint64_t kHeader_bytes = 512;
  try {
    const std::string bytes = log.read_up_to(entry, kHeader_bytes);
    return read_header({log.encoding, bytes, log.name}).stamp_s;
  } catch (const Error&) {
    return std::nullopt;
  }
}

/// Returns the stamps of messages with a header, and their difference to the time of reception in offset_s.
std::vector<double> stamps_of(const MessageLog& log, const std::vector<MessageEntry>& entries,
                              double& offset_s) {
  constexpr std::size_t kSamples = 5;
  std::vector<double> offsets_s;
  for (std::size_t i = 0; i < std::min(entries.size(), kSamples); ++i)
    if (const auto stamp_s = header_stamp_s(log, entries[i]))
      offsets_s.push_back(*stamp_s - entries[i].stamp_s);
  std::sort(offsets_s.begin(), offsets_s.end());
  offset_s = offsets_s.empty() ? 0.0 : offsets_s[offsets_s.size() / 2];
  std::vector<double> stamps_s;
  for (const MessageEntry& entry : entries) {
    const auto stamp_s = log.reads_starts ? header_stamp_s(log, entry) : std::nullopt;
    stamps_s.push_back(stamp_s.value_or(entry.stamp_s + offset_s));
  }
  return stamps_s;
}

/// Sorts messages and their stamps by stamp.
void sort_both(std::vector<MessageEntry>& entries, std::vector<double>& stamps_s) {
  std::vector<std::pair<double, MessageEntry>> both;
  for (std::size_t i = 0; i < entries.size(); ++i) both.emplace_back(stamps_s[i], entries[i]);
  std::stable_sort(both.begin(), both.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < both.size(); ++i) std::tie(stamps_s[i], entries[i]) = both[i];
}

/// Returns the extrinsics that a RealSense states for a stream such as /device_0/sensor_1/Color_0: a
/// transform from the reference stream, the same for all streams, to this one.
std::optional<Eigen::Isometry3d> realsense_T_stream_reference(const MessageLog& log,
                                                              const std::string& topic) {
  for (std::size_t slash = topic.rfind('/'); slash != std::string::npos && slash > 0;
       slash = topic.rfind('/', slash - 1)) {
    const std::string prefix = topic.substr(0, slash) + "/tf/";
    for (const MessageEntry& entry : log.messages) {
      const MessageTopic& each = log.topics[entry.topic];
      if (each.type != "geometry_msgs/Transform" || !each.name.starts_with(prefix)) continue;
      try {
        const std::string bytes = log.read(entry);
        const RosTransform transform = read_transform({log.encoding, bytes, log.name + ": " + each.name});
        return rigid_pose(transform.t_m, transform.q_xyzw);
      } catch (const Error&) {
        return std::nullopt;
      }
    }
  }
  return std::nullopt;
}

/// Topics and frames of two sensors.
struct Sensor {
  std::string topic, frame_id;
};

/// Returns the fixed transform between two sensors from tf, or from a RealSense's extrinsics.
std::optional<Eigen::Isometry3d> T_between(const MessageLog& log, const RosTransforms& transforms,
                                           const Sensor& to, const Sensor& from) {
  const auto T_to_reference = realsense_T_stream_reference(log, to.topic);
  const auto T_from_reference = realsense_T_stream_reference(log, from.topic);
  if (T_to_reference && T_from_reference) return *T_to_reference * T_from_reference->inverse();
  // The frames of a RealSense file all have the same name.
  if (to.frame_id.empty() || from.frame_id.empty()) return std::nullopt;
  return transforms.T_a_b(to.frame_id, from.frame_id);
}

/// The accelerometer, and the rotation of its readings to the depth camera's frame.
struct Gravity {
  std::vector<MessageEntry> messages;
  double offset_s = 0.0;
  std::uint32_t topic = 0;
  Eigen::Matrix3d R_depth_imu = Eigen::Matrix3d::Identity();
};

std::optional<Gravity> find_gravity(const MessageLog& log, const RosTransforms& transforms,
                                    const Sensor& depth) {
  for (std::uint32_t topic = 0; topic < log.topics.size(); ++topic) {
    const std::string& name = log.topics[topic].name;
    if (log.topics[topic].type != "sensor_msgs/Imu" || name.find("yro") != std::string::npos) continue;
    Gravity gravity{messages_of(log, topic), 0.0, topic, Eigen::Matrix3d::Identity()};
    if (gravity.messages.empty()) continue;
    try {
      const std::string bytes = log.read(gravity.messages.front());
      const RosAcceleration first = read_acceleration({log.encoding, bytes, log.name + ": " + name});
      const auto T_depth_imu = T_between(log, transforms, depth, {name, first.header.frame_id});
      if (!T_depth_imu) continue;
      gravity.R_depth_imu = T_depth_imu->linear();
      gravity.offset_s = first.header.stamp_s - gravity.messages.front().stamp_s;
      return gravity;
    } catch (const Error&) {  // another IMU may be whole
    }
  }
  return std::nullopt;
}

std::optional<Eigen::Vector3d> gravity_at(const MessageLog& log, const Gravity& gravity, double stamp_s) {
  const double received_s = stamp_s - gravity.offset_s;
  std::vector<StampedAcceleration> near;
  auto entry = std::lower_bound(gravity.messages.begin(), gravity.messages.end(), received_s - kImuWithin_s,
                                [](const MessageEntry& each, double s) { return each.stamp_s < s; });
  for (; entry != gravity.messages.end() && entry->stamp_s <= received_s + kImuWithin_s; ++entry) {
    try {
      const std::string bytes = log.read(*entry);
      const RosAcceleration reading = read_acceleration({log.encoding, bytes, log.name});
      if (reading.header.stamp_s == stamp_s) near.clear();  // measured with the image, as by roomradar
      if (reading.acceleration_m_s2.allFinite()) near.push_back({entry->stamp_s, reading.acceleration_m_s2});
      if (reading.header.stamp_s == stamp_s) break;
    } catch (const Error&) {  // one reading less
    }
  }
  const auto down_imu = down_at(near, received_s, kImuWithin_s);
  if (!down_imu) return std::nullopt;
  return Eigen::Vector3d(gravity.R_depth_imu * *down_imu);
}

/// Returns the messages of kPoseTopic, by time of reception.
std::vector<MessageEntry> exact_poses(const MessageLog& log) {
  for (std::uint32_t topic = 0; topic < log.topics.size(); ++topic)
    if (log.topics[topic].name == kPoseTopic && log.topics[topic].type == "std_msgs/Float64MultiArray")
      return messages_of(log, topic);
  return {};
}

/// Returns the pose whose time of reception is that of the depth image.
std::optional<Eigen::Isometry3d> exact_pose_at(const MessageLog& log, const std::vector<MessageEntry>& poses,
                                               double received_s) {
  const auto entry = std::lower_bound(poses.begin(), poses.end(), received_s,
                                      [](const MessageEntry& each, double s) { return each.stamp_s < s; });
  if (entry == poses.end() || entry->stamp_s != received_s) return std::nullopt;
  const std::string bytes = log.read(*entry);
  const std::vector<double> m = read_numbers({log.encoding, bytes, log.name + ": a pose"});
  if (m.size() != 16) throw Error(log.name + ": a pose has " + std::to_string(m.size()) + " numbers, not 16");
  Eigen::Isometry3d T_world_camera;
  T_world_camera.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(m.data());
  if (!nearest_rotation(T_world_camera.linear()) || !T_world_camera.matrix().allFinite())
    throw Error(log.name + ": a pose is not a rigid transform");
  return T_world_camera;
}

}  // namespace

IndexedRecording index_ros_recording(const std::shared_ptr<const MessageLog>& log) {
  auto [depth, colour] = find_streams(*log);
  const auto transforms = std::make_shared<const RosTransforms>(*log);
  const Sensor depth_sensor{log->topics[depth.topic].name, depth.frame_id};

  IndexedRecording recording{.name = log->name, .depth_lens = depth.lens};
  recording.rig.depth_camera = depth.camera;
  if (depth_sensor.topic.starts_with("/device_")) recording.rig.depth_noise = kRealSenseNoise;
  double depth_offset_s = 0.0, colour_offset_s = 0.0;
  std::vector<double> depth_s = stamps_of(*log, depth.messages, depth_offset_s);
  sort_both(depth.messages, depth_s);
  std::vector<double> colour_s;
  if (colour) {
    recording.rig.colour_camera = colour->camera;
    recording.colour_lens = colour->lens;
    const auto T_colour_depth =
        T_between(*log, *transforms, {log->topics[colour->topic].name, colour->frame_id}, depth_sensor);
    if (T_colour_depth) recording.rig.T_colour_depth = *T_colour_depth;
    colour_s = stamps_of(*log, colour->messages, colour_offset_s);
    sort_both(colour->messages, colour_s);
    // Some devices stamp depth and colour by different clocks.
    if (!depth_s.empty() && (colour_s.back() < depth_s.front() || colour_s.front() > depth_s.back()))
      for (double& stamp_s : colour_s) stamp_s += depth_offset_s - colour_offset_s;
  }
  for (const double stamp_s : depth_s) recording.frames.push_back({.stamp_s = stamp_s});
  const auto colour_of = pair_colours(colour_s, kPairWithin_s, recording.frames);

  const double unit_m = depth_unit_m(*log, depth);
  recording.read_depth = [log, depth = depth, unit_m](std::size_t frame, DepthImage& depth_m) {
    decode_ros_depth(*log, depth, depth.messages[frame], unit_m, depth_m);
  };
  if (colour)
    recording.read_colour = [log, colour = *colour, colour_of](std::size_t frame, ColourImage& image) {
      decode_ros_colour(*log, colour, colour.messages[*colour_of[frame]], image);
    };
  if (const auto poses = exact_poses(*log); !poses.empty())
    recording.read_pose = [log, poses, messages = depth.messages](std::size_t frame) {
      return exact_pose_at(*log, poses, messages[frame].stamp_s);
    };
  else if (transforms->moves(depth.frame_id))
    recording.read_pose = [log, transforms, id = depth.frame_id, depth_s](std::size_t frame) {
      return transforms->T_root_frame(id, depth_s[frame]);
    };
  if (const auto gravity = find_gravity(*log, *transforms, depth_sensor))
    recording.read_down = [log, gravity = *gravity, depth_s](std::size_t frame) {
      return gravity_at(*log, gravity, depth_s[frame]);
    };
  return recording;
}

IndexedRecording index_ros1_bag(const std::filesystem::path& path) {
  return index_ros_recording(std::make_shared<const MessageLog>(open_ros_bag(path)));
}

IndexedRecording index_ros2_bag(const std::filesystem::path& path) {
  return index_ros_recording(std::make_shared<const MessageLog>(open_ros2_bag(path)));
}

}  // namespace roomradar
