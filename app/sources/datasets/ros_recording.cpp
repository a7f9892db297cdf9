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

/// Returns the times of messages with a header, by reception. Reading all headers of a compressed file takes
/// too long: there, a stamp is the time of reception plus the median difference of the first five.
std::vector<StatedTime> times_of(const MessageLog& log, const std::vector<MessageEntry>& entries) {
  constexpr std::size_t kSamples = 5;
  std::vector<double> offsets_s;
  for (std::size_t i = 0; i < std::min(entries.size(), kSamples); ++i)
    if (const auto stamp_s = header_stamp_s(log, entries[i]); stamp_s && *stamp_s != 0.0)
      offsets_s.push_back(*stamp_s - entries[i].stamp_s);
  std::sort(offsets_s.begin(), offsets_s.end());
  const double offset_s = offsets_s.empty() ? kNoStamp : offsets_s[offsets_s.size() / 2];
  std::vector<StatedTime> times;
  for (const MessageEntry& entry : entries) {
    const auto stamp_s = log.reads_starts ? header_stamp_s(log, entry) : std::nullopt;
    times.push_back({stamp_s.value_or(entry.stamp_s + offset_s), entry.stamp_s});
  }
  return times;
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
StatedPose exact_pose_at(const MessageLog& log, const std::vector<MessageEntry>& poses, double received_s) {
  const auto entry = std::lower_bound(poses.begin(), poses.end(), received_s,
                                      [](const MessageEntry& each, double s) { return each.stamp_s < s; });
  if (entry == poses.end() || entry->stamp_s != received_s) return {};
  const std::string bytes = log.read(*entry);
  const std::vector<double> m = read_numbers({log.encoding, bytes, log.name + ": a pose"});
  if (m.size() != 16) return {{}, "has " + std::to_string(m.size()) + " numbers, not 16"};
  Eigen::Isometry3d T_world_camera;
  T_world_camera.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(m.data());
  if (!nearest_rotation(T_world_camera.linear()) || !T_world_camera.matrix().allFinite())
    return {{}, "is no rigid transform"};
  return {T_world_camera};
}

}  // namespace

RecordingFacts index_ros_recording(const std::shared_ptr<const MessageLog>& log,
                                   const std::string& depth_topic) {
  auto [depth, colour, are_cameras_assumed, other_depth] = find_streams(*log, depth_topic);
  const auto transforms = std::make_shared<const RosTransforms>(*log);
  const Sensor depth_sensor{log->topics[depth.topic].name, depth.frame_id};

  RecordingFacts facts{.name = log->name, .depth_lens = depth.lens};
  facts.rig.depth_camera = depth.camera;
  facts.camera_source = "its camera_info";
  if (are_cameras_assumed) {
    facts.camera_origin = Origin::kAssumed;
    facts.camera_source = nominal_name(NominalRig::kNumbered);
    facts.is_registered_if_given = depth.is_registered;
  }
  if (depth_sensor.topic.starts_with("/device_")) facts.rig.depth_noise = kRealSenseNoise;
  for (const StatedTime& time : times_of(*log, depth.messages)) facts.frames.push_back({.time = time});
  if (colour) {
    const Sensor colour_sensor{log->topics[colour->topic].name, colour->frame_id};
    facts.rig.colour_camera = colour->camera;
    facts.colour_lens = colour->lens;
    facts.is_depth_registered = depth.is_registered;
    if (const auto T_colour_depth = T_between(*log, *transforms, colour_sensor, depth_sensor))
      facts.rig.T_colour_depth = *T_colour_depth;
    else if (!depth.is_registered)
      facts.colour_pose_origin = Origin::kAssumed;
    facts.colours = times_of(*log, colour->messages);
  }
  if (!other_depth.empty())
    facts.notes.push_back({"images",
                           "of " + std::to_string(other_depth.size() + 1) + " topics with depth, " +
                               depth_sensor.topic + " is used" +
                               (depth.is_registered ? ", which is registered to colour" : "") + "; not " +
                               other_depth.front() + (other_depth.size() > 1 ? ", ..." : ""),
                           static_cast<std::int64_t>(other_depth.size()), "--depth-topic NAME"});

  facts.depth_unit_m = depth.is_float ? 1.0 : 0.001;
  facts.unit_source = depth.is_float ? "metres, by its encoding" : "millimetres, by its encoding";
  if (const auto unit_m = stated_depth_unit_m(*log, depth); unit_m && !depth.is_float) {
    facts.depth_unit_m = *unit_m;
    facts.unit_origin = Origin::kRecording;
    facts.unit_source = "its option Depth Units";
  }
  facts.read_depth = [log, depth = depth](std::size_t frame, double unit_m, DepthImage& depth_m) {
    decode_ros_depth(*log, depth, depth.messages[frame], unit_m, depth_m);
  };
  if (colour)
    facts.read_colour = [log, colour = *colour](std::size_t image, ColourImage& pixels) {
      decode_ros_colour(*log, colour, colour.messages[image], pixels);
    };
  if (const auto poses = exact_poses(*log); !poses.empty())
    facts.read_pose = [log, poses, messages = depth.messages](std::size_t frame, double) {
      return exact_pose_at(*log, poses, messages[frame].stamp_s);
    };
  else if (transforms->moves(depth.frame_id))
    facts.read_pose = [log, transforms, id = depth.frame_id](std::size_t, double stamp_s) {
      return StatedPose{transforms->T_root_frame(id, stamp_s)};
    };
  if (const auto gravity = find_gravity(*log, *transforms, depth_sensor)) {
    facts.gravity_source = "its accelerometer";
    facts.read_down = [log, gravity = *gravity](std::size_t, double stamp_s) {
      return gravity_at(*log, gravity, stamp_s);
    };
  }
  return facts;
}

RecordingFacts index_ros1_bag(const std::filesystem::path& path, const std::string& depth_topic) {
  return index_ros_recording(std::make_shared<const MessageLog>(open_ros_bag(path)), depth_topic);
}

RecordingFacts index_ros2_bag(const std::filesystem::path& path, const std::string& depth_topic) {
  return index_ros_recording(std::make_shared<const MessageLog>(open_ros2_bag(path)), depth_topic);
}

}  // namespace roomradar
