// azure_recording.cpp: tracks of a Matroska file as frames.
#include "app/sources/datasets/dataset_readers.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "app/sources/containers/matroska.hpp"
#include "app/sources/datasets/recording_facts.hpp"
#include "app/sources/formats/camera_rig.hpp"
#include "app/sources/formats/camera_rig_json.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/lens_correction.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "app/sources/formats/raw_pixels.hpp"
#include "app/sources/formats/time_tracks.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

struct AzureCalibration {
  CameraRig rig;  ///< with a colour camera if a colour size was given
  RationalLens depth_lens, colour_lens;
  /// Rotates directions from the accelerometer's frame to the depth camera's frame.
  Eigen::Matrix3d R_depth_accelerometer = Eigen::Matrix3d::Identity();
};

using Json = nlohmann::json;

/// Part of a sensor that a mode delivers: the binned sensor, from `left`, `top` on.
struct SensorMode {
  ImageSize image;
  int binned_width_px, binned_height_px, left_px, top_px;
};
constexpr std::array<SensorMode, 4> kDepthModes = {{
    {{320, 288}, 512, 512, 96, 90},      // narrow field of view, 2 x 2 binned
    {{640, 576}, 1024, 1024, 192, 180},  // narrow field of view
    {{512, 512}, 512, 512, 0, 0},        // wide field of view, 2 x 2 binned
    {{1024, 1024}, 1024, 1024, 0, 0},    // wide field of view
}};
constexpr std::array<SensorMode, 6> kColourModes = {{
    {{1280, 720}, 1280, 960, 0, 120},
    {{1920, 1080}, 1920, 1440, 0, 180},
    {{2560, 1440}, 2560, 1920, 0, 240},
    {{2048, 1536}, 2048, 1536, 0, 0},
    {{3840, 2160}, 3840, 2880, 0, 360},
    {{4096, 3072}, 4096, 3072, 0, 0},
}};

std::vector<double> numbers(const Json& object, const char* name, std::size_t count,
                            const std::string& where) {
  const Json& array = json_field(object, name, where);
  if (!array.is_array() || array.size() != count)
    throw Error(where + ": " + name + " must be " + std::to_string(count) + " numbers");
  std::vector<double> values;
  for (const Json& each : array) {
    if (!each.is_number())
      throw Error(where + ": " + name + " must be " + std::to_string(count) + " numbers");
    values.push_back(each.get<double>());
  }
  return values;
}

/// Returns the entry of an array whose field `name` has this value.
const Json& entry_with(const Json& array, const char* name, const char* value, const std::string& where) {
  if (array.is_array())
    for (const Json& entry : array)
      if (entry.is_object() && entry.contains(name) && entry[name] == value) return entry;
  throw Error(where + ": contains no entry with " + name + " " + value);
}

/// Returns the transform to the sensor's frame from the device's, which is the depth camera's.
Eigen::Isometry3d sensor_pose(const Json& sensor, const std::string& where) {
  const Json& Rt = json_field(sensor, "Rt", where);
  const std::vector<double> r = numbers(Rt, "Rotation", 9, where), t_m = numbers(Rt, "Translation", 3, where);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  const auto R = nearest_rotation(
      (Eigen::Matrix3d() << r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8]).finished());
  if (!R) throw Error(where + ": Rotation is not a rotation");
  T.linear() = *R;
  T.translation() << t_m[0], t_m[1], t_m[2];
  return T;
}

Intrinsics camera_of(const Json& camera, ImageSize size, std::span<const SensorMode> modes,
                     RationalLens& lens, const std::string& where) {
  for (const SensorMode& mode : modes) {
    if (mode.image != size) continue;
    const std::vector<double> p =
        numbers(json_field(camera, "Intrinsics", where), "ModelParameters", 14, where);
    lens = {.k1 = p[4], .k2 = p[5], .p1 = p[13], .p2 = p[12], .k3 = p[6], .k4 = p[7], .k5 = p[8], .k6 = p[9]};
    // Normalised coordinates count from the sensor's corner, roomradar's from the centre of its first pixel.
    return {size.width_px,
            size.height_px,
            p[2] * mode.binned_width_px,
            p[3] * mode.binned_height_px,
            p[0] * mode.binned_width_px - mode.left_px - 0.5,
            p[1] * mode.binned_height_px - mode.top_px - 0.5};
  }
  throw Error(where + ": no mode of the device has images of " + size_text(size.width_px, size.height_px));
}

/// Reads a device's calibration, JSON as the Azure Kinect SDK stores it, for images of these sizes. The sizes
/// determine the mode, that is, which part of the sensor is read and whether its pixels are binned.
/// @throws Error naming `where` if the JSON is damaged or no mode has these sizes
/// Source: Azure Kinect Sensor SDK, modes and camera calibration.
AzureCalibration read_azure_calibration(const std::string& text, ImageSize depth, const ImageSize* colour,
                                        const std::string& where) {
  const Json root = Json::parse(text.substr(0, text.find('\0')), nullptr, /*allow_exceptions=*/false);
  if (root.is_discarded() || !root.is_object()) throw Error(where + ": is not JSON; is it cut short?");
  const Json& information = json_field(root, "CalibrationInformation", where);
  const Json& cameras = json_field(information, "Cameras", where);

  AzureCalibration calibration;
  const Json& depth_json = entry_with(cameras, "Location", "CALIBRATION_CameraLocationD0", where);
  calibration.rig.depth_noise = kTimeOfFlightNoise;
  calibration.rig.depth_camera = camera_of(depth_json, depth, kDepthModes, calibration.depth_lens, where);
  const Eigen::Isometry3d T_depth_device = sensor_pose(depth_json, where);
  if (colour) {
    const Json& colour_json = entry_with(cameras, "Location", "CALIBRATION_CameraLocationPV0", where);
    calibration.rig.colour_camera =
        camera_of(colour_json, *colour, kColourModes, calibration.colour_lens, where);
    calibration.rig.T_colour_depth = sensor_pose(colour_json, where) * T_depth_device.inverse();
  }
  if (information.contains("InertialSensors")) {
    const Json& accelerometer = entry_with(information["InertialSensors"], "SensorType",
                                           "CALIBRATION_InertialSensorType_Accelerometer", where);
    calibration.R_depth_accelerometer =
        T_depth_device.linear() * sensor_pose(accelerometer, where).linear().transpose();
  }
  return calibration;
}

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
