// ros_images.hpp: finds the topics of a ROS recording with depth and colour images, and decodes them.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/sources/containers/message_log.hpp"
#include "app/sources/containers/ros_messages.hpp"
#include "app/sources/formats/lens_correction.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// A topic of images, and the intrinsics and lens of its camera.
struct RosStream {
  std::uint32_t topic = 0;
  bool is_compressed = false;
  bool is_float = false;       ///< depth in 32FC1 or 64FC1, m
  bool is_registered = false;  ///< depth that its topic's name calls aligned or registered to colour
  std::string frame_id{};  ///< coordinate frame of the camera
  int width_px = 0, height_px = 0;
  Intrinsics camera{};
  RationalLens lens{};
  std::vector<MessageEntry> messages{};  ///< sorted by time of reception
};

struct RosStreams {
  RosStream depth;
  std::optional<RosStream> colour;  ///< unset: no colour topic has a camera_info
  /// True: no depth topic has a camera_info. The cameras are those of NominalRig::kNumbered.
  bool are_cameras_assumed = false;
  std::vector<std::string> other_depth{};  ///< names of further topics of depth images
};

/// Returns a topic of depth images (16UC1, 16SC1, Z16, mono16, 32FC1, 64FC1 or compressedDepth) and, if there
/// is one, a topic of colour images. Of several depth topics, returns `depth_topic` if it is not empty, else
/// one that is registered to colour and has a camera_info, if there is one.
/// @throws Error naming the topics that were found if there is no depth topic, or none of that name
RosStreams find_streams(const MessageLog& log, const std::string& depth_topic);

/// Returns the length of a unit of 16 bit depth, m, that the option Depth Units of a RealSense states.
std::optional<double> stated_depth_unit_m(const MessageLog& log, const RosStream& depth);

/// Decode a message of the stream. `unit_m` is the length of a unit of the stored depth, 1 for 32FC1. Throw Error if it is damaged or its encoding is not supported.
void decode_ros_depth(const MessageLog& log, const RosStream& stream, const MessageEntry& entry,
                      double unit_m, DepthImage& depth_m);
void decode_ros_colour(const MessageLog& log, const RosStream& stream, const MessageEntry& entry,
                       ColourImage& colour);

}  // namespace roomradar
