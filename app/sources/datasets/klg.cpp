// klg.cpp: lists the frames by adding up their sizes.
#include "app/sources/datasets/dataset_readers.hpp"

#include <memory>

#include "app/sources/containers/decompress.hpp"
#include "app/sources/containers/random_access_file.hpp"
#include "app/sources/datasets/numbered_files.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/image_header.hpp"
#include "app/sources/formats/raw_pixels.hpp"
#include "mapping/types/serialize.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

struct KlgFrame {
  std::uint64_t depth_offset = 0, depth_bytes = 0, colour_bytes = 0;
};

bool is_jpeg(const std::string& bytes) { return bytes.starts_with("\xff\xd8"); }

/// Returns the size of the images: that of a JPEG, else 640 x 480.
ImageSize klg_size(const RandomAccessFile& file, const std::vector<KlgFrame>& places) {
  constexpr ImageSize kUsual{640, 480};
  if (places.empty()) return kUsual;
  const KlgFrame& first = places.front();
  const std::string bytes = file.read(first.depth_offset + first.depth_bytes, first.colour_bytes);
  if (!is_jpeg(bytes)) return kUsual;
  const ImageHeader header = read_image_header(bytes, file.name());
  return {header.width_px, header.height_px};
}

}  // namespace

bool is_klg(const std::filesystem::path& path) {
  std::error_code ignored;
  return path.extension() == ".klg" && std::filesystem::is_regular_file(path, ignored);
}

RecordingFacts index_klg(const std::filesystem::path& path) {
  const auto file = std::make_shared<const RandomAccessFile>(path);
  const std::string where = file->name();
  constexpr std::uint64_t kFrameHead_bytes = 16;
  const std::string count_bytes = file->read(0, 4);
  ByteReader count_reader(count_bytes, where);
  const auto count = count_reader.number<std::int32_t>();
  if (count < 0) throw Error(where + ": is damaged: it states " + std::to_string(count) + " frames");

  RecordingFacts facts{.name = std::filesystem::canonical(path).string()};
  std::vector<KlgFrame> places;
  std::uint64_t at = 4;
  for (std::int32_t i = 0; i < count && file->has(at, kFrameHead_bytes); ++i) {
    const std::string head = file->read(at, kFrameHead_bytes);
    ByteReader reader(head, where);
    const auto stamp_us = reader.number<std::int64_t>();
    const auto depth_bytes = reader.number<std::int32_t>(), colour_bytes = reader.number<std::int32_t>();
    if (depth_bytes < 0 || colour_bytes < 0)
      throw Error(where + ": is damaged: frame " + std::to_string(i) + " states a size below 0");
    const KlgFrame place{at + kFrameHead_bytes, static_cast<std::uint64_t>(depth_bytes),
                         static_cast<std::uint64_t>(colour_bytes)};
    if (!file->has(place.depth_offset, place.depth_bytes + place.colour_bytes)) break;
    at = place.depth_offset + place.depth_bytes + place.colour_bytes;
    facts.frames.push_back({.time = {.stamp_s = 1e-6 * static_cast<double>(stamp_us)}});
    if (colour_bytes > 0) facts.frames.back().colour = places.size();
    places.push_back(place);
  }
  if (static_cast<std::size_t>(count) > places.size())
    facts.notes.push_back({"images",
                           "the file is cut short: it states " + std::to_string(count) +
                               " frames and holds " + std::to_string(places.size()),
                           count - static_cast<std::int64_t>(places.size()), "", true});

  constexpr Intrinsics kElasticFusion{640, 480, 528.0, 528.0, 320.0, 240.0};
  const ImageSize size = klg_size(*file, places);
  facts.rig.depth_camera = scaled_to_depth(kElasticFusion, size, where);
  facts.rig.colour_camera = facts.rig.depth_camera;
  facts.camera_origin = Origin::kAssumed;
  facts.camera_source = "ElasticFusion (528 px at a width of 640)";
  facts.is_depth_registered = true;
  const RawLayout layout{size.width_px, size.height_px};
  const auto raw_bytes = std::uint64_t{2} * static_cast<std::uint64_t>(size.width_px) *
                         static_cast<std::uint64_t>(size.height_px);
  facts.read_depth = [=](std::size_t frame, double unit_m, DepthImage& depth_m) {
    std::string bytes = file->read(places[frame].depth_offset, places[frame].depth_bytes);
    if (bytes.size() != raw_bytes)
      bytes = decompress(Compression::kZlib, bytes, raw_bytes, where + ": a depth image");
    convert_depth(bytes, layout, DepthPixels::kUint16, unit_m, where, depth_m);
  };
  facts.read_colour = [=](std::size_t frame, ColourImage& image) {
    const KlgFrame& place = places[frame];
    const std::string bytes = file->read(place.depth_offset + place.depth_bytes, place.colour_bytes);
    if (is_jpeg(bytes))
      decode_colour(bytes, where + ": a colour image", image);
    else
      convert_colour(bytes, layout, ColourPixels::kRgb8, where, image);
  };
  return facts;
}

}  // namespace roomradar
