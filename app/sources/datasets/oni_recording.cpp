// oni_facts.cpp: nodes of a .oni file as depth and colour.
#include "app/sources/datasets/dataset_readers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>

#include "app/sources/containers/oni_file.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "app/sources/formats/raw_pixels.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// Formats of pixels, as the property oniPixelFormat states them.
constexpr std::uint64_t kOniDepth100um = 101, kOniRgb888 = 200, kOniYuv422 = 201, kOniGray8 = 202,
                        kOniYuyv = 205;

using OniNodes = std::map<std::uint32_t, OniNode>;

/// Returns the first node of a kind that has frames; it shares the ownership of all nodes. Null: there is
/// none.
std::shared_ptr<const OniNode> node_of(const std::shared_ptr<const OniNodes>& nodes, OniNodeKind kind) {
  for (const auto& [id, node] : *nodes)
    if (node.kind == kind && !node.frames.empty()) return {nodes, &node};
  return nullptr;
}

/// Returns the size of a node's images, from the property xnMapOutputMode: width, height, rate.
ImageSize oni_size(const OniNode& node, const std::string& where) {
  const auto mode = node.values.find("xnMapOutputMode");
  std::array<std::uint32_t, 2> size{};
  if (mode == node.values.end() || mode->second.size() < sizeof size)
    throw Error(where + ": is damaged: it does not state the size of its images");
  std::memcpy(size.data(), mode->second.data(), sizeof size);
  if (size[0] < 1 || size[1] < 1 || size[0] > 16384 || size[1] > 16384)
    throw Error(where + ": its images' width or height is not in 1..16384 px");
  return {static_cast<int>(size[0]), static_cast<int>(size[1])};
}

/// Returns the horizontal field of view, from the property xnFOV (two doubles, rad); 0: not stated.
double stated_fov_rad(const OniNode& node) {
  double fov_rad = 0.0;
  const auto stated = node.values.find("xnFOV");
  if (stated != node.values.end() && stated->second.size() >= sizeof fov_rad)
    std::memcpy(&fov_rad, stated->second.data(), sizeof fov_rad);
  return fov_rad;
}

std::uint64_t integer_of(const OniNode& node, const char* name) {
  const auto found = node.integers.find(name);
  return found == node.integers.end() ? 0 : found->second;
}

template <typename Pixel>
void mirror(Image<Pixel>& image) {
  for (int y = 0; y < image.height; ++y) std::reverse(image.row(y), image.row(y) + image.width);
}

double oni_depth_unit_m(const OniNode& node) {
  return integer_of(node, "oniPixelFormat") == kOniDepth100um ? 0.0001 : 0.001;
}

void decode_oni_depth(const std::string& bytes, const OniNode& node, ImageSize size, double unit_m,
                      const std::string& where, DepthImage& depth_m) {
  const RawLayout layout{size.width_px, size.height_px};
  if (node.codec == "NONE") return convert_depth(bytes, layout, DepthPixels::kUint16, unit_m, where, depth_m);
  const auto pixels = static_cast<std::size_t>(size.width_px) * static_cast<std::size_t>(size.height_px);
  const std::vector<std::uint16_t> units = decompress_oni_depth(bytes, node.codec == "16zT", pixels, where);
  convert_depth({reinterpret_cast<const char*>(units.data()), units.size() * sizeof(std::uint16_t)}, layout,
                DepthPixels::kUint16, unit_m, where, depth_m);
}

void decode_oni_colour(const std::string& bytes, const OniNode& node, ImageSize size,
                       const std::string& where, ColourImage& colour) {
  if (node.codec == "JPEG") return decode_colour(bytes, where, colour);
  // OpenNI 1 states xnPixelFormat only: RGB, YUV, grey.
  std::uint64_t format = integer_of(node, "oniPixelFormat");
  const std::uint64_t old_format = integer_of(node, "xnPixelFormat");
  if (format == 0 && old_format >= 1 && old_format <= 3) format = kOniRgb888 + old_format - 1;
  const ColourPixels pixels = format == kOniYuv422  ? ColourPixels::kUyvy
                              : format == kOniGray8 ? ColourPixels::kMono8
                              : format == kOniYuyv  ? ColourPixels::kYuyv
                                                    : ColourPixels::kRgb8;
  convert_colour(bytes, {size.width_px, size.height_px}, pixels, where, colour);
}

}  // namespace

RecordingFacts index_oni_recording(const std::filesystem::path& path) {
  const auto file = std::make_shared<const RandomAccessFile>(path);
  const std::string where = file->name();
  const auto nodes = std::make_shared<const OniNodes>(index_oni(*file));
  const auto depth = node_of(nodes, OniNodeKind::kDepth), colour = node_of(nodes, OniNodeKind::kImage);
  if (!depth) throw Error(where + ": contains no depth images");
  if (depth->codec != "16zT" && depth->codec != "16zP" && depth->codec != "NONE")
    throw Error(where + ": its depth is compressed by '" + depth->codec + "', which is not read");

  RecordingFacts facts{.name = std::filesystem::canonical(path).string()};
  const ImageSize depth_size = oni_size(*depth, where);
  const ImageSize colour_size = colour ? oni_size(*colour, where) : ImageSize{};
  const auto seconds = [](const OniFrame& frame) { return 1e-6 * static_cast<double>(frame.stamp_us); };
  for (const OniFrame& frame : depth->frames) facts.frames.push_back({.time = {.stamp_s = seconds(frame)}});
  facts.rig.depth_camera = openni_camera(depth_size, stated_fov_rad(*depth));
  const bool states_camera = stated_fov_rad(*depth) > 0.0;
  facts.camera_origin = states_camera ? Origin::kRecording : Origin::kAssumed;
  facts.camera_source = states_camera ? "its field of view" : "a PrimeSense";
  facts.is_depth_registered = integer_of(*depth, "RegistrationType") != 0;
  facts.depth_unit_m = oni_depth_unit_m(*depth);
  facts.unit_origin = Origin::kRecording;
  facts.unit_source = "its pixel format";
  if (colour) {
    facts.rig.colour_camera = openni_camera(colour_size, stated_fov_rad(*colour));
    if (!facts.is_depth_registered) facts.rig.T_colour_depth.translation().x() = -kPrimeSenseBaseline_m;
    for (const OniFrame& frame : colour->frames) facts.colours.push_back({.stamp_s = seconds(frame)});
  }
  facts.read_depth = [=](std::size_t frame, double unit_m, DepthImage& depth_m) {
    const OniFrame& at = depth->frames[frame];
    decode_oni_depth(file->read(at.offset, at.bytes), *depth, depth_size, unit_m, where + ": a depth image",
                     depth_m);
    if (integer_of(*depth, "xnMirror") != 0) mirror(depth_m);
  };
  facts.read_colour = [=](std::size_t frame, ColourImage& image) {
    const OniFrame& at = colour->frames[frame];
    decode_oni_colour(file->read(at.offset, at.bytes), *colour, colour_size, where + ": a colour image",
                      image);
    if (integer_of(*colour, "xnMirror") != 0) mirror(image);
  };
  return facts;
}

}  // namespace roomradar
