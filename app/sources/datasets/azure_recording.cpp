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

IndexedRecording index_azure_recording(const std::filesystem::path& path) {
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

  IndexedRecording recording{.name = std::filesystem::canonical(path).string(),
                             .rig = calibration.rig,
                             .depth_lens = calibration.depth_lens,
                             .colour_lens = calibration.colour_lens};
  const auto accelerations =
      imu ? accelerations_of(*file, blocks_of(index, *imu)) : std::vector<StampedAcceleration>();
  const auto depth_blocks = blocks_of(index, *depth);
  for (const MatroskaBlock& block : depth_blocks) {
    IndexedFrame frame{.stamp_s = block.stamp_s};
    if (const auto down = down_at(accelerations, block.stamp_s, kGravityWithin_s))
      frame.down_camera = calibration.R_depth_accelerometer * *down;
    recording.frames.push_back(std::move(frame));
  }
  std::vector<std::optional<std::size_t>> colour_of(depth_blocks.size());
  std::vector<MatroskaBlock> colour_blocks;
  if (colour) {
    colour_blocks = blocks_of(index, *colour);
    std::vector<double> stamps_s;
    for (const MatroskaBlock& block : colour_blocks) stamps_s.push_back(block.stamp_s);
    colour_of = pair_colours(stamps_s, kPairWithin_s, recording.frames);
  }

  recording.read_depth = [=](std::size_t frame, DepthImage& image) {
    const MatroskaBlock& block = depth_blocks[frame];
    convert_depth(file->read(block.offset, block.size), {depth_size.width_px, depth_size.height_px},
                  DepthPixels::kUint16BigEndian, 0.001, where, image);
  };
  const std::string code = colour ? four_characters_of(*colour) : "";
  recording.read_colour = [=](std::size_t frame, ColourImage& image) {
    const MatroskaBlock& block = colour_blocks[*colour_of[frame]];
    decode_colour_block(file->read(block.offset, block.size), code, colour_size, where, image);
  };
  return recording;
}

}  // namespace roomradar
