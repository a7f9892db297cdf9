// ros_recording.cpp: stamps, extrinsics, poses and gravity of a ROS recording.
#include "app/sources/datasets/dataset_readers.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/sources/containers/message_log.hpp"
#include "app/sources/containers/ros2_bag.hpp"
#include "app/sources/containers/ros_bag.hpp"
#include "app/sources/containers/ros_messages.hpp"
#include "app/sources/containers/rvl_depth.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/lens_correction.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "app/sources/formats/raw_pixels.hpp"
#include "app/sources/formats/time_tracks.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// A topic of images, and the intrinsics and lens of its camera.
struct RosStream {
  std::uint32_t topic = 0;
  bool is_compressed = false;
  bool is_float = false;       ///< depth in 32FC1 or 64FC1, m
  bool is_registered = false;  ///< depth that its topic's name calls aligned or registered to colour
  std::string frame_id{};      ///< coordinate frame of the camera
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

constexpr std::string_view kCompressedDepth = "compressedDepth";

MessageBytes message(const MessageLog& log, const std::string& bytes, std::uint32_t topic) {
  return {log.encoding, bytes, log.name + ": a message of " + log.topics[topic].name};
}

std::optional<ColourPixels> colour_pixels_of(const std::string& encoding) {
  static const std::map<std::string, ColourPixels> kKnown = {
      {"rgb8", ColourPixels::kRgb8},   {"bgr8", ColourPixels::kBgr8},        {"8UC3", ColourPixels::kBgr8},
      {"rgba8", ColourPixels::kRgba8}, {"bgra8", ColourPixels::kBgra8},      {"mono8", ColourPixels::kMono8},
      {"8UC1", ColourPixels::kMono8},  {"yuv422", ColourPixels::kUyvy},      {"uyvy", ColourPixels::kUyvy},
      {"yuyv", ColourPixels::kYuyv},   {"yuv422_yuy2", ColourPixels::kYuyv}, {"YUYV", ColourPixels::kYuyv}};
  const auto found = kKnown.find(encoding);
  return found == kKnown.end() ? std::nullopt : std::optional(found->second);
}

/// Of ASCII, whatever the locale.
std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// Depth in metres; the others are of 16 bit.
bool is_float_encoding(const std::string& encoding) { return encoding == "32FC1" || encoding == "64FC1"; }

bool is_depth_encoding(const std::string& encoding) {
  return encoding == "16UC1" || encoding == "16SC1" || encoding == "mono16" || lower(encoding) == "z16" ||
         is_float_encoding(encoding);
}

bool names(const std::string& topic, std::initializer_list<std::string_view> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view word) { return topic.find(word) != std::string::npos; });
}

/// A topic of images, described by its first message.
struct Candidate {
  RosStream stream;
  bool is_depth = false;
  int score = 0;
};

/// Decode a message of the stream. `unit_m` is the length of a unit of the stored depth, 1 for 32FC1. Throw
/// Error if it is damaged or its encoding is not supported.
void decode_ros_depth(const MessageLog& log, const RosStream& stream, const MessageEntry& entry,
                      double unit_m, DepthImage& depth_m);
void decode_ros_colour(const MessageLog& log, const RosStream& stream, const MessageEntry& entry,
                       ColourImage& colour);

std::optional<Candidate> candidate_of(const MessageLog& log, std::uint32_t topic) {
  const std::string& type = log.topics[topic].type;
  const bool is_image = type == "sensor_msgs/Image", is_packed = type == "sensor_msgs/CompressedImage";
  if (!is_image && !is_packed) return std::nullopt;
  Candidate candidate;
  candidate.stream.topic = topic;
  candidate.stream.is_compressed = is_packed;
  candidate.stream.messages = messages_of(log, topic);
  if (candidate.stream.messages.empty()) return std::nullopt;
  const std::string name = lower(log.topics[topic].name);
  try {
    const std::string bytes = log.read(candidate.stream.messages.front());
    if (is_image) {
      const RosImage image = read_image(message(log, bytes, topic));
      candidate.is_depth = is_depth_encoding(image.encoding);
      candidate.stream.is_float = is_float_encoding(image.encoding);
      if (!candidate.is_depth && !colour_pixels_of(image.encoding)) return std::nullopt;
      candidate.stream.frame_id = image.header.frame_id;
      candidate.stream.width_px = static_cast<int>(std::min(image.width, 100'000U));
      candidate.stream.height_px = static_cast<int>(std::min(image.height, 100'000U));
    } else {
      const RosCompressedImage image = read_compressed_image(message(log, bytes, topic));
      candidate.is_depth = image.format.find(kCompressedDepth) != std::string::npos;
      candidate.stream.frame_id = image.header.frame_id;
      candidate.stream.is_float = candidate.is_depth && image.format.starts_with("32FC1");
      if (candidate.is_depth) {
        DepthImage depth_m;
        decode_ros_depth(log, candidate.stream, candidate.stream.messages.front(), 0.001, depth_m);
        candidate.stream.width_px = depth_m.width;
        candidate.stream.height_px = depth_m.height;
      } else {
        ColourImage colour;
        decode_colour(image.data, log.name + ": " + log.topics[topic].name, colour);
        candidate.stream.width_px = colour.width;
        candidate.stream.height_px = colour.height;
      }
    }
  } catch (const Error&) {
    return std::nullopt;
  }
  candidate.score = is_image ? 1 : 0;
  if (candidate.is_depth) {
    if (names(name, {"depth"})) candidate.score += 8;
    candidate.stream.is_registered = names(name, {"aligned", "registered"});
    if (candidate.stream.is_registered) candidate.score += 2;
    if (names(name, {"infra", "/ir"})) candidate.score -= 16;
  } else {
    if (names(name, {"color", "colour", "rgb"})) candidate.score += 8;
    if (names(name, {"infra", "/ir", "fisheye", "depth"})) candidate.score -= 16;
  }
  return candidate;
}

/// Returns the number of whole components, such as "/camera", that two names share at their begin.
std::size_t shared_components(const std::string& a, const std::string& b) {
  std::size_t components = 0;
  for (std::size_t i = 0; i < a.size() && i < b.size() && a[i] == b[i]; ++i)
    if (i > 0 && a[i] == '/') ++components;
  return components;
}

/// Sets camera and lens from the first camera_info of the same size whose topic is nearest by name.
bool set_camera(const MessageLog& log, RosStream& stream) {
  std::optional<RosCameraInfo> best;
  std::size_t best_shared = 0;
  const std::string& name = log.topics[stream.topic].name;
  for (std::uint32_t topic = 0; topic < log.topics.size(); ++topic) {
    if (log.topics[topic].type != "sensor_msgs/CameraInfo") continue;
    const std::size_t shared = shared_components(name, log.topics[topic].name);
    if (best && shared <= best_shared) continue;
    const auto first = std::find_if(log.messages.begin(), log.messages.end(),
                                    [topic](const MessageEntry& entry) { return entry.topic == topic; });
    if (first == log.messages.end()) continue;
    try {
      const std::string bytes = log.read(*first);
      const RosCameraInfo info = read_camera_info(message(log, bytes, topic));
      if (info.width != static_cast<std::uint32_t>(stream.width_px) ||
          info.height != static_cast<std::uint32_t>(stream.height_px) || !(info.K[0] > 0.0))
        continue;
      best = info;
      best_shared = shared;
    } catch (const Error&) {  // another message may be whole
    }
  }
  if (!best) return false;
  stream.camera = {stream.width_px, stream.height_px, best->K[0], best->K[4], best->K[2], best->K[5]};
  const bool is_rectified = names(name, {"_rect"}) && best->P[0] > 0.0;
  if (is_rectified) {
    stream.camera = {stream.width_px, stream.height_px, best->P[0], best->P[5], best->P[2], best->P[6]};
    return true;
  }
  const std::string model = lower(best->distortion_model);
  const std::vector<double>& D = best->D;
  if (model != "plumb_bob" && model != "rational_polynomial" && model != "brown conrady") return true;
  const auto coefficient = [&](std::size_t i) { return i < D.size() ? D[i] : 0.0; };
  stream.lens = {coefficient(0), coefficient(1), coefficient(2), coefficient(3),
                 coefficient(4), coefficient(5), coefficient(6), coefficient(7)};
  return true;
}

/// Returns the topics of images, the best first.
std::vector<Candidate> candidates_of(const MessageLog& log) {
  std::vector<Candidate> candidates;
  for (std::uint32_t topic = 0; topic < log.topics.size(); ++topic)
    if (auto candidate = candidate_of(log, topic)) candidates.push_back(std::move(*candidate));
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  return candidates;
}

[[noreturn]] void fail_without_depth(const MessageLog& log) {
  std::string topics;
  for (const MessageTopic& topic : log.topics)
    if (topics.size() < 400) topics += (topics.empty() ? "" : ", ") + topic.name;
  throw Error(log.name +
              ": contains no depth images (16UC1, 16SC1, Z16, mono16, 32FC1, 64FC1 or compressedDepth); its "
              "topics are " +
              (topics.empty() ? "none" : topics));
}

/// Removes all topics of depth except this one. Throws Error naming those that there are if it is none.
void keep_depth_topic(const MessageLog& log, const std::string& depth_topic,
                      std::vector<Candidate>& candidates) {
  const auto name_of = [&](const Candidate& candidate) { return log.topics[candidate.stream.topic].name; };
  std::string known;
  for (const Candidate& candidate : candidates)
    if (candidate.is_depth) known += (known.empty() ? "" : ", ") + name_of(candidate);
  if (known.empty()) fail_without_depth(log);
  std::erase_if(candidates, [&](const Candidate& candidate) {
    return candidate.is_depth && name_of(candidate) != depth_topic;
  });
  if (std::none_of(candidates.begin(), candidates.end(),
                   [](const Candidate& candidate) { return candidate.is_depth; }))
    throw Error(log.name + ": has no depth images on the topic " + depth_topic +
                "; --depth-topic must be one of " + known);
}

/// Returns the best topics of depth and colour, with assumed cameras.
RosStreams streams_without_cameras(const MessageLog& log, const std::vector<Candidate>& candidates) {
  RosStreams streams;
  streams.are_cameras_assumed = true;
  bool has_depth = false;
  for (const Candidate& candidate : candidates) {
    if (candidate.is_depth && std::exchange(has_depth, true))
      streams.other_depth.push_back(log.topics[candidate.stream.topic].name);
    else if (candidate.is_depth)
      streams.depth = candidate.stream;
    else if (!streams.colour && candidate.score >= 0)
      streams.colour = candidate.stream;
  }
  if (!has_depth) fail_without_depth(log);
  const auto size_of = [](const RosStream& stream) { return ImageSize{stream.width_px, stream.height_px}; };
  const std::optional<ImageSize> colour_size =
      streams.colour ? std::optional(size_of(*streams.colour)) : std::nullopt;
  const CameraRig rig = nominal_rig(NominalRig::kNumbered, size_of(streams.depth), colour_size);
  streams.depth.camera = rig.depth_camera;
  if (streams.colour)
    streams.colour->camera = streams.depth.is_registered ? fitted_to(rig.depth_camera, *colour_size)
                                                         : rig.colour_camera.value_or(rig.depth_camera);
  return streams;
}

/// Decodes compressedDepth: the kind of compression and two floats, then 16 bit as PNG or RVL. 32FC1 holds a
/// / (depth + b) - quantised inverse depth; a and b are the floats. Source: ROS, image_transport_plugins,
/// compressed_depth_image_transport/src/codec.cpp, decodeCompressedDepthImage().
void decode_compressed_depth(const RosCompressedImage& image, const RosStream& stream, double unit_m,
                             const std::string& where, DepthImage& depth_m) {
  constexpr std::size_t kHead_bytes = 12;
  if (image.data.size() < kHead_bytes) throw Error(where + ": is cut short");
  float a = 0.0F, b = 0.0F;
  std::memcpy(&a, image.data.data() + 4, sizeof a);
  std::memcpy(&b, image.data.data() + 8, sizeof b);
  const std::string_view packed = image.data.substr(kHead_bytes);
  const bool is_float = image.format.starts_with("32FC1");
  const double float_unit_m = stream.is_float ? unit_m : 1.0;
  if (is_float) unit_m = 1.0;
  if (image.format.find("compressedDepth rvl") != std::string::npos) {
    Image<std::uint16_t> units;
    decode_rvl(packed, {stream.width_px, stream.height_px}, where, units);
    convert_depth(units, unit_m, where, depth_m);
  } else {
    decode_depth_png(packed, static_cast<float>(1.0 / unit_m), where, depth_m);
  }
  if (!is_float) return;
  convert_inverse_depth(a, b, depth_m);
  scale_depth(float_unit_m, depth_m);
}

RawLayout layout_of(const RosImage& image) {
  constexpr std::uint32_t kTooMany = 100'000;  // convert_*() refuse it
  return {static_cast<int>(std::min(image.width, kTooMany)),
          static_cast<int>(std::min(image.height, kTooMany)), image.step};
}

/// Returns a topic of depth images (16UC1, 16SC1, Z16, mono16, 32FC1, 64FC1 or compressedDepth) and, if there
/// is one, a topic of colour images. Of several depth topics, returns `depth_topic` if it is not empty, else
/// one that is registered to colour and has a camera_info, if there is one.
/// @throws Error naming the topics that were found if there is no depth topic, or none of that name
RosStreams find_streams(const MessageLog& log, const std::string& depth_topic) {
  std::optional<RosStream> depth, colour;
  std::vector<std::string> others;
  std::vector<Candidate> candidates = candidates_of(log);
  if (!depth_topic.empty()) keep_depth_topic(log, depth_topic, candidates);
  for (Candidate& candidate : candidates) {
    std::optional<RosStream>& wanted = candidate.is_depth ? depth : colour;
    const bool is_colour_of_infrared = !candidate.is_depth && candidate.score < 0;
    if (!wanted && !is_colour_of_infrared && set_camera(log, candidate.stream))
      wanted = candidate.stream;
    else if (candidate.is_depth)
      others.push_back(log.topics[candidate.stream.topic].name);
  }
  if (!depth) return streams_without_cameras(log, candidates);
  return {std::move(*depth), std::move(colour), false, std::move(others)};
}

/// Returns the length of a unit of 16 bit depth, m, that the option Depth Units of a RealSense states.
std::optional<double> stated_depth_unit_m(const MessageLog& log, const RosStream& depth) {
  const std::string& name = log.topics[depth.topic].name;
  for (const MessageEntry& entry : log.messages) {
    const MessageTopic& topic = log.topics[entry.topic];
    if (topic.type != "std_msgs/Float32" || !topic.name.ends_with("/option/Depth Units/value") ||
        shared_components(name, topic.name) < 2)
      continue;
    try {
      const std::string bytes = log.read(entry);
      const auto unit_m = static_cast<double>(read_float(message(log, bytes, entry.topic)));
      if (unit_m > 0.0 && unit_m < 1.0) return std::round(unit_m * 1e9) / 1e9;  // stored as a float
    } catch (const Error&) {                                                    // the default unit then
    }
    break;
  }
  return std::nullopt;
}

void decode_ros_depth(const MessageLog& log, const RosStream& stream, const MessageEntry& entry,
                      double unit_m, DepthImage& depth_m) {
  const std::string bytes = log.read(entry);
  const MessageBytes from = message(log, bytes, stream.topic);
  if (stream.is_compressed)
    return decode_compressed_depth(read_compressed_image(from), stream, unit_m, from.where, depth_m);
  const RosImage image = read_image(from);
  if (!is_depth_encoding(image.encoding))
    throw Error(from.where + ": its encoding is '" + image.encoding.substr(0, 40) + "', not depth");
  if (is_float_encoding(image.encoding)) {
    if (image.is_big_endian) throw Error(from.where + ": its floats are big-endian, which is not read");
    const DepthPixels pixels = image.encoding == "64FC1" ? DepthPixels::kFloat64 : DepthPixels::kFloat32;
    return convert_depth(image.data, layout_of(image), pixels, stream.is_float ? unit_m : 1.0, from.where,
                         depth_m);
  }
  convert_depth(image.data, layout_of(image),
                image.is_big_endian ? DepthPixels::kUint16BigEndian : DepthPixels::kUint16, unit_m,
                from.where, depth_m);
  if (image.encoding == "16SC1")  // negative: no measurement
    for (float& depth : depth_m.pixels)
      if (depth >= static_cast<float>(32768 * unit_m)) depth = 0.0F;
}

void decode_ros_colour(const MessageLog& log, const RosStream& stream, const MessageEntry& entry,
                       ColourImage& colour) {
  const std::string bytes = log.read(entry);
  const MessageBytes from = message(log, bytes, stream.topic);
  if (stream.is_compressed) return decode_colour(read_compressed_image(from).data, from.where, colour);
  const RosImage image = read_image(from);
  const auto pixels = colour_pixels_of(image.encoding);
  if (!pixels) throw Error(from.where + ": its encoding '" + image.encoding.substr(0, 40) + "' is not read");
  convert_colour(image.data, layout_of(image), *pixels, from.where, colour);
}

/// Stores the tree and its static transforms. Transforms that vary with time are not stored: each query reads
/// the messages around its time again.
class RosTransforms {
 public:
  /// Reads all messages of tf_static and the first 500 of tf, fewer in a compressed file. Ignores damaged
  /// messages.
  /// @param log  must outlive this object
  explicit RosTransforms(const MessageLog& log);

  /// Returns the constant transform from frame `b` to frame `a`. Returns nullopt if the tree does not connect
  /// the frames, or if a transform on the path between them varies with time.
  [[nodiscard]] std::optional<Eigen::Isometry3d> T_a_b(const std::string& a, const std::string& b) const;

  /// Returns true if `frame` moves relative to the root of its tree.
  [[nodiscard]] bool moves(const std::string& frame) const;

  /// Returns the pose of `frame` in the root frame of its tree. `stamp_s` is a time on the clock of the
  /// message headers. Returns nullopt if `frame` does not move relative to the root. Also returns nullopt
  /// unless each varying transform up to the root has a message within 0.15 s before stamp_s and one within
  /// 0.15 s after.
  [[nodiscard]] std::optional<Eigen::Isometry3d> T_root_frame(const std::string& frame, double stamp_s) const;

 private:
  struct Edge {
    std::string parent;
    Eigen::Isometry3d T_parent_child = Eigen::Isometry3d::Identity();
    bool moves = false;
  };
  void add(const RosTransform& transform);
  /// Returns the frames from `frame` up to, not including, the root.
  [[nodiscard]] std::vector<std::string> chain(const std::string& frame) const;

  const MessageLog& log_;
  std::map<std::string, Edge> edges_;  // by child
  std::vector<MessageEntry> moving_;   // messages of tf, by time of reception
  double header_offset_s_ = 0.0;       // stamp of the headers minus time of reception
};

constexpr std::size_t kFirstMessages = 500;
constexpr std::uint32_t kFirstBlocks = 16;  // of a compressed file; some MB
constexpr std::size_t kMaxChain = 64;
constexpr double kTfWithin_s = 0.15;

std::vector<RosTransform> transforms_in(const MessageLog& log, const MessageEntry& entry) {
  try {
    const std::string bytes = log.read(entry);
    return read_transforms({log.encoding, bytes, log.name + ": a transform"});
  } catch (const Error&) {
    return {};
  }
}

RosTransforms::RosTransforms(const MessageLog& log) : log_(log) {
  for (std::uint32_t topic = 0; topic < log.topics.size(); ++topic) {
    const auto& [name, type] = log.topics[topic];
    if (type != "tf2_msgs/TFMessage" && type != "tf/tfMessage") continue;
    const std::vector<MessageEntry> entries = messages_of(log, topic);
    const bool is_static = name.ends_with("tf_static");
    const std::size_t count = is_static ? entries.size() : std::min(entries.size(), kFirstMessages);
    for (std::size_t i = 0; i < count; ++i) {
      if (!is_static && !log.reads_starts && entries[i].block > entries[0].block + kFirstBlocks) break;
      for (const RosTransform& transform : transforms_in(log, entries[i])) {
        if (!is_static && i == 0) header_offset_s_ = transform.header.stamp_s - entries[i].stamp_s;
        add(transform);
      }
    }
    if (!is_static) moving_.insert(moving_.end(), entries.begin(), entries.end());
  }
  std::stable_sort(moving_.begin(), moving_.end(),
                   [](const MessageEntry& a, const MessageEntry& b) { return a.stamp_s < b.stamp_s; });
}

void RosTransforms::add(const RosTransform& transform) {
  const auto T = rigid_pose(transform.t_m, transform.q_xyzw);
  if (!T || transform.child.empty() || transform.child == transform.header.frame_id) return;
  const auto [edge, is_new] = edges_.try_emplace(transform.child, Edge{transform.header.frame_id, *T, false});
  if (!is_new && edge->second.parent == transform.header.frame_id &&
      !edge->second.T_parent_child.isApprox(*T, 1e-9))
    edge->second.moves = true;
}

std::vector<std::string> RosTransforms::chain(const std::string& frame) const {
  std::vector<std::string> frames;
  for (auto edge = edges_.find(frame); edge != edges_.end() && frames.size() < kMaxChain;
       edge = edges_.find(edge->second.parent))
    frames.push_back(edge->first);
  return frames;
}

std::optional<Eigen::Isometry3d> RosTransforms::T_a_b(const std::string& a, const std::string& b) const {
  if (a == b) return Eigen::Isometry3d::Identity();
  // Both chains without the part that they share at the root.
  std::vector<std::string> from_a = chain(a), from_b = chain(b);
  const auto root_of = [&](const std::string& frame, const std::vector<std::string>& frames) {
    return frames.empty() ? frame : edges_.at(frames.back()).parent;
  };
  if (root_of(a, from_a) != root_of(b, from_b)) return std::nullopt;
  while (!from_a.empty() && !from_b.empty() && from_a.back() == from_b.back()) {
    from_a.pop_back();
    from_b.pop_back();
  }
  const auto T_top = [&](const std::vector<std::string>& frames) -> std::optional<Eigen::Isometry3d> {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    for (const std::string& frame : frames) {
      const Edge& edge = edges_.at(frame);
      if (edge.moves) return std::nullopt;
      T = edge.T_parent_child * T;
    }
    return T;
  };
  const auto T_top_a = T_top(from_a), T_top_b = T_top(from_b);
  if (!T_top_a || !T_top_b) return std::nullopt;
  return T_top_a->inverse() * *T_top_b;
}

bool RosTransforms::moves(const std::string& frame) const {
  const std::vector<std::string> frames = chain(frame);
  return std::any_of(frames.begin(), frames.end(),
                     [this](const std::string& each) { return edges_.at(each).moves; });
}

std::optional<Eigen::Isometry3d> RosTransforms::T_root_frame(const std::string& frame, double stamp_s) const {
  if (!moves(frame)) return std::nullopt;
  std::map<std::string, std::vector<StampedPose>> tracks;
  const double received_s = stamp_s - header_offset_s_;
  const auto first = std::lower_bound(moving_.begin(), moving_.end(), received_s - kTfWithin_s,
                                      [](const MessageEntry& entry, double s) { return entry.stamp_s < s; });
  for (auto entry = first; entry != moving_.end() && entry->stamp_s <= received_s + kTfWithin_s; ++entry)
    for (const RosTransform& transform : transforms_in(log_, *entry)) {
      const auto T = rigid_pose(transform.t_m, transform.q_xyzw);
      const auto edge = edges_.find(transform.child);
      if (T && edge != edges_.end() && edge->second.parent == transform.header.frame_id)
        tracks[transform.child].push_back({transform.header.stamp_s, *T});
    }
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (const std::string& each : chain(frame)) {
    const Edge& edge = edges_.at(each);
    if (!edge.moves) {
      T = edge.T_parent_child * T;
      continue;
    }
    std::vector<StampedPose>& track = tracks[each];
    sort_by_stamp(track);
    const auto T_parent_child = pose_at(track, stamp_s, 2 * kTfWithin_s);
    if (!T_parent_child) return std::nullopt;
    T = *T_parent_child * T;
  }
  return T;
}

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
