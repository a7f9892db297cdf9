// scannet_sens.cpp: lists the frames by adding up their sizes.
#include "app/sources/datasets/dataset_readers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "app/sources/containers/decompress.hpp"
#include "app/sources/containers/random_access_file.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/raw_pixels.hpp"
#include "app/sources/formats/time_tracks.hpp"
#include "mapping/types/serialize.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr std::uint32_t kSensVersion = 4;
using Matrix4 = std::array<float, 16>;  // row by row
enum class SensColour : std::int32_t { kRaw = 0, kPng = 1, kJpeg = 2 };
enum class SensDepth : std::int32_t { kRaw = 0, kZlib = 1 };

std::optional<Eigen::Isometry3d> transform_of(const Matrix4& m) {
  return rigid_transform(
      Eigen::Map<const Eigen::Matrix<float, 4, 4, Eigen::RowMajor>>(m.data()).topRows<3>().cast<double>());
}

Intrinsics sens_camera(const Matrix4& m, std::uint32_t width, std::uint32_t height,
                       const std::string& where) {
  if (width < 1 || height < 1 || width > 16384 || height > 16384)
    throw Error(where + ": its images' width or height is not in 1..16384 px");
  const auto at = [&](std::size_t i) { return static_cast<double>(m[i]); };
  return {static_cast<int>(width), static_cast<int>(height), at(0), at(5), at(2), at(6)};
}

/// What the file states before its first frame.
struct SensHeader {
  std::uint64_t bytes = 0;  ///< size of the header
  Matrix4 colour_matrix{}, colour_pose{}, depth_matrix{}, depth_pose{};
  SensColour colour_kind{};
  SensDepth depth_kind{};
  std::array<std::uint32_t, 4> sizes{};  ///< colour width and height, depth width and height
  double units_per_m = 0.0;
  std::uint64_t frames = 0;
};

/// Throws Error naming `where` if the version or the depth's compression is not supported, or a number is
/// impossible.
SensHeader read_sens_header(const RandomAccessFile& file, const std::string& where) {
  constexpr std::uint64_t kFixed_bytes = 4 * sizeof(Matrix4) + 2 * 4 + 4 * 4 + 4 + 8;
  constexpr std::uint64_t kMaxName_bytes = 4096;
  const std::string start = file.read(0, 12);
  ByteReader start_reader(start, where);
  if (start_reader.number<std::uint32_t>() != kSensVersion)
    throw Error(where + ": has an unsupported version; must be version 4");
  const auto name_bytes = start_reader.number<std::uint64_t>();
  if (name_bytes > kMaxName_bytes) throw Error(where + ": is damaged: the name of its sensor is too long");
  const std::string fixed = file.read(12 + name_bytes, kFixed_bytes);
  ByteReader reader(fixed, where);
  SensHeader header{.bytes = 12 + name_bytes + kFixed_bytes};
  for (Matrix4* matrix :
       {&header.colour_matrix, &header.colour_pose, &header.depth_matrix, &header.depth_pose})
    *matrix = reader.number<Matrix4>();
  header.colour_kind = static_cast<SensColour>(reader.number<std::int32_t>());
  header.depth_kind = static_cast<SensDepth>(reader.number<std::int32_t>());
  for (std::uint32_t& size : header.sizes) size = reader.number<std::uint32_t>();
  header.units_per_m = static_cast<double>(reader.number<float>());
  header.frames = reader.number<std::uint64_t>();
  if (header.depth_kind != SensDepth::kRaw && header.depth_kind != SensDepth::kZlib)
    throw Error(where + ": its depth compression is not supported; must be raw or zlib");
  if (!(header.units_per_m > 0.0 && std::isfinite(header.units_per_m)))
    throw Error(where + ": is damaged: its depth's units per m are not > 0");
  return header;
}

/// Returns the cameras and their relative pose.
CameraRig sens_rig(const SensHeader& header, const std::string& where) {
  const auto& sizes = header.sizes;
  CameraRig rig;
  rig.depth_camera = sens_camera(header.depth_matrix, sizes[2], sizes[3], where);
  if (sizes[0] > 0) rig.colour_camera = sens_camera(header.colour_matrix, sizes[0], sizes[1], where);
  const auto T_device_colour = transform_of(header.colour_pose),
             T_device_depth = transform_of(header.depth_pose);
  if (T_device_colour && T_device_depth) rig.T_colour_depth = T_device_colour->inverse() * *T_device_depth;
  return rig;
}

/// Positions of a frame's images in the file.
struct SensFrame {
  std::uint64_t colour_offset = 0, colour_bytes = 0, depth_bytes = 0;
};

/// Reads the heads of at most `count` frames from the offset `at` on, up to the last whole frame. Adds them
/// to `frames`, and returns where their images are.
std::vector<SensFrame> read_frames(const RandomAccessFile& file, const std::string& where, std::uint64_t at,
                                   std::uint64_t count, std::vector<StatedFrame>& frames) {
  constexpr std::uint64_t kFrameHead_bytes = sizeof(Matrix4) + 4 * 8;
  std::vector<SensFrame> places;
  for (std::uint64_t i = 0; i < count && file.has(at, kFrameHead_bytes); ++i) {
    const std::string bytes = file.read(at, kFrameHead_bytes);
    ByteReader frame_reader(bytes, where);
    const auto pose = frame_reader.number<Matrix4>();
    (void)frame_reader.number<std::uint64_t>();  // stamp of the colour image
    const auto stamp_us = frame_reader.number<std::uint64_t>();
    SensFrame place{at + kFrameHead_bytes, frame_reader.number<std::uint64_t>(),
                    frame_reader.number<std::uint64_t>()};
    if (!file.has(place.colour_offset, place.colour_bytes) ||
        !file.has(place.colour_offset + place.colour_bytes, place.depth_bytes))
      break;
    at = place.colour_offset + place.colour_bytes + place.depth_bytes;
    frames.push_back(
        {.time = {.stamp_s = 1e-6 * static_cast<double>(stamp_us)}, .T_world_camera = transform_of(pose)});
    if (place.colour_bytes > 0) frames.back().colour = places.size();
    if (!frames.back().T_world_camera) frames.back().pose_fault = "is no rigid transform";
    places.push_back(place);
  }
  return places;
}

}  // namespace

bool is_scannet_sens(const std::filesystem::path& path) {
  return path.extension() == ".sens" && begins_with(path, std::string_view("\x04\0\0\0", 4));
}

RecordingFacts index_scannet_sens(const std::filesystem::path& path) {
  const auto file = std::make_shared<const RandomAccessFile>(path);
  const std::string where = file->name();
  const SensHeader header = read_sens_header(*file, where);
  RecordingFacts facts{.name = std::filesystem::canonical(path).string()};
  facts.rig = sens_rig(header, where);
  const std::uint64_t count = header.frames;
  const std::vector<SensFrame> places = read_frames(*file, where, header.bytes, count, facts.frames);
  if (count > places.size())
    facts.notes.push_back(
        {"images",
         "the file is cut short: it states " + std::to_string(count) + " frames and holds " +
             std::to_string(places.size()),
         static_cast<std::int64_t>(std::min<std::uint64_t>(count, 1U << 30U) - places.size()), "", true});
  facts.camera_source = "its header";
  facts.depth_unit_m = 1.0 / header.units_per_m;
  facts.unit_origin = Origin::kRecording;
  facts.unit_source = "its header";
  const RawLayout depth_layout{facts.rig.depth_camera.width_px, facts.rig.depth_camera.height_px};
  facts.read_depth = [=, depth_kind = header.depth_kind](std::size_t frame, double unit_m,
                                                         DepthImage& depth_m) {
    const SensFrame& place = places[frame];
    std::string bytes = file->read(place.colour_offset + place.colour_bytes, place.depth_bytes);
    if (depth_kind == SensDepth::kZlib)
      bytes = decompress(Compression::kZlib, bytes,
                         std::uint64_t{2} * static_cast<std::uint64_t>(depth_layout.width_px) *
                             static_cast<std::uint64_t>(depth_layout.height_px),
                         where + ": a depth image");
    convert_depth(bytes, depth_layout, DepthPixels::kUint16, unit_m, where, depth_m);
  };
  const RawLayout colour_layout{static_cast<int>(header.sizes[0] & 0xFFFFU),
                                static_cast<int>(header.sizes[1] & 0xFFFFU)};
  facts.read_colour = [=, colour_kind = header.colour_kind](std::size_t frame, ColourImage& image) {
    const std::string bytes = file->read(places[frame].colour_offset, places[frame].colour_bytes);
    if (colour_kind == SensColour::kRaw)
      convert_colour(bytes, colour_layout, ColourPixels::kRgb8, where, image);
    else
      decode_colour(bytes, where + ": a colour image", image);
  };
  return facts;
}

}  // namespace roomradar
