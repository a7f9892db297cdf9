// ros_images.cpp: classifies topics by the encoding of their first image, then by their name.
#include "app/sources/datasets/ros_images.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

#include "app/sources/containers/rvl_depth.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "app/sources/formats/raw_pixels.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

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

}  // namespace

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

}  // namespace roomradar
