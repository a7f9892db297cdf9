// azure_recording.cpp: tracks of a Matroska file as frames.
#include "app/sources/datasets/azure_recording.hpp"

#include <algorithm>
#include <cstring>
#include <memory>

#include "app/sources/containers/matroska.hpp"
#include "app/sources/datasets/azure_calibration.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/raw_pixels.hpp"
#include "app/sources/formats/time_tracks.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr double kGravityWithin_s = 0.150;
constexpr std::uint64_t kMaxCalibration_bytes = 1U << 20U;

const MatroskaTrack* track_named(const MatroskaIndex& index, const char* name) {
  for (const MatroskaTrack& track : index.tracks)
    if (track.name == name) return &track;
  return nullptr;
}

std::vector<MatroskaBlock> blocks_of(const MatroskaIndex& index, const MatroskaTrack& track) {
  std::vector<MatroskaBlock> blocks;
  for (const MatroskaBlock& block : index.blocks)
    if (block.track == track.number) blocks.push_back(block);
  std::stable_sort(blocks.begin(), blocks.end(),
                   [](const auto& a, const auto& b) { return a.stamp_s < b.stamp_s; });
  return blocks;
}

/// Returns the track's image size and four-character code, from the bitmap header of the codec's data.
std::string four_characters_of(const MatroskaTrack& track) {
  constexpr std::size_t kCompressionAt = 16;
  return track.codec_private.size() < kCompressionAt + 4 ? "" : track.codec_private.substr(kCompressionAt, 4);
}

ImageSize size_of(const MatroskaTrack& track, const std::string& where) {
  if (track.width_px < 1 || track.height_px < 1 || track.width_px > 16384 || track.height_px > 16384)
    throw Error(where + ": track " + track.name + ": its size is not in 1..16384 px");
  return {static_cast<int>(track.width_px), static_cast<int>(track.height_px)};
}

/// Reads the samples of the IMU track: time of the acceleration (u64, ns), acceleration (3 floats, m/s^2),
/// time and value of the rotation rate. Their clock differs from the file's by a constant.
std::vector<StampedAcceleration> accelerations_of(const RandomAccessFile& file,
                                                  const std::vector<MatroskaBlock>& blocks) {
  constexpr std::size_t kSample_bytes = 40;
  std::vector<StampedAcceleration> accelerations;
  std::optional<double> offset_s;
  for (const MatroskaBlock& block : blocks) {
    const std::string samples = file.read(block.offset, block.size);
    for (std::size_t at = 0; at + kSample_bytes <= samples.size(); at += kSample_bytes) {
      std::uint64_t stamp_ns = 0;
      Eigen::Vector3f acceleration;
      std::memcpy(&stamp_ns, samples.data() + at, sizeof stamp_ns);
      std::memcpy(acceleration.data(), samples.data() + at + sizeof stamp_ns, 3 * sizeof(float));
      const double stamp_s = 1e-9 * static_cast<double>(stamp_ns);
      if (!offset_s) offset_s = block.stamp_s - stamp_s;
      if (acceleration.allFinite())
        accelerations.push_back({stamp_s + *offset_s, acceleration.cast<double>()});
    }
  }
  sort_by_stamp(accelerations);
  return accelerations;
}

void decode_colour_block(const std::string& bytes, const std::string& code, ImageSize size,
                         const std::string& where, ColourImage& colour) {
  if (code == "MJPG") return decode_colour(bytes, where, colour);
  const RawLayout layout{size.width_px, size.height_px};
  if (code == "NV12") return convert_colour(bytes, layout, ColourPixels::kNv12, where, colour);
  if (code == "YUY2") return convert_colour(bytes, layout, ColourPixels::kYuyv, where, colour);
  if (code == "BGRA") return convert_colour(bytes, layout, ColourPixels::kBgra8, where, colour);
  throw Error(where + ": colour of the kind '" + code + "' is not read; record MJPG, NV12, YUY2 or BGRA");
}

}  // namespace

RecordingFacts index_azure_recording(const std::filesystem::path& path) {
  const auto file = std::make_shared<const RandomAccessFile>(path);
  const std::string where = file->name();
  const MatroskaIndex index = index_matroska(*file);
  const MatroskaTrack* depth = track_named(index, "DEPTH");
  const MatroskaTrack* colour = track_named(index, "COLOR");
  const MatroskaTrack* imu = track_named(index, "IMU");
  if (!depth)
    throw Error(where + ": contains no track DEPTH; must be a depth camera's recording by k4arecorder");
  if (four_characters_of(*depth) != "b16g")
    throw Error(where + ": its track DEPTH is of the kind '" + four_characters_of(*depth) + "', not b16g");
  const ImageSize depth_size = size_of(*depth, where);
  const ImageSize colour_size = colour ? size_of(*colour, where) : ImageSize{};

  const MatroskaAttachment* attachment = nullptr;
  for (const MatroskaAttachment& each : index.attachments)
    if (each.file_name == "calibration.json") attachment = &each;
  if (!attachment || attachment->size > kMaxCalibration_bytes)
    throw Error(where + ": its attachment calibration.json is missing or too large");
  const AzureCalibration calibration =
      read_azure_calibration(file->read(attachment->offset, attachment->size), depth_size,
                             colour ? &colour_size : nullptr, where + ", calibration.json");

  RecordingFacts facts{.name = std::filesystem::canonical(path).string(),
                       .rig = calibration.rig,
                       .depth_lens = calibration.depth_lens,
                       .colour_lens = calibration.colour_lens};
  facts.camera_source = "its calibration.json";
  facts.unit_source = "millimetres, by k4arecorder's format";
  facts.acceleration_track = std::make_shared<std::vector<StampedAcceleration>>(
      imu ? accelerations_of(*file, blocks_of(index, *imu)) : std::vector<StampedAcceleration>());
  if (!facts.acceleration_track->empty()) facts.gravity_source = "its accelerometer";
  const auto depth_blocks = blocks_of(index, *depth);
  for (const MatroskaBlock& block : depth_blocks) facts.frames.push_back({.time = {.stamp_s = block.stamp_s}});
  std::vector<MatroskaBlock> colour_blocks;
  if (colour) colour_blocks = blocks_of(index, *colour);
  for (const MatroskaBlock& block : colour_blocks) facts.colours.push_back({.stamp_s = block.stamp_s});

  facts.read_depth = [=](std::size_t frame, double unit_m, DepthImage& image) {
    const MatroskaBlock& block = depth_blocks[frame];
    convert_depth(file->read(block.offset, block.size), {depth_size.width_px, depth_size.height_px},
                  DepthPixels::kUint16BigEndian, unit_m, where, image);
  };
  const std::string code = colour ? four_characters_of(*colour) : "";
  facts.read_colour = [=](std::size_t colour_image, ColourImage& image) {
    const MatroskaBlock& block = colour_blocks[colour_image];
    decode_colour_block(file->read(block.offset, block.size), code, colour_size, where, image);
  };
  facts.read_down = [track = facts.acceleration_track, R = calibration.R_depth_accelerometer](
                        std::size_t, double stamp_s) -> std::optional<Eigen::Vector3d> {
    const auto down = down_at(*track, stamp_s, kGravityWithin_s);
    if (!down) return std::nullopt;
    return Eigen::Vector3d(R * *down);
  };
  return facts;
}

}  // namespace roomradar
