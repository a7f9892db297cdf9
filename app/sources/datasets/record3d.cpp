// record3d.cpp: metadata, numbered images, and ARKit's axes.
#include "app/sources/datasets/record3d.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "app/sources/containers/exr_depth.hpp"
#include "app/sources/datasets/arkit_axes.hpp"
#include "app/sources/datasets/numbered_files.hpp"
#include "app/sources/formats/camera_rig_json.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "app/sources/formats/time_tracks.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::uintmax_t kMaxMetadata_bytes = 1U << 28U;  // two hours at 60 Hz
constexpr std::uintmax_t kMaxExr_bytes = 1U << 28U;

int size_px(const Json& metadata, const char* name, const std::string& where) {
  const double value = json_number(metadata, name, where);
  if (!(value >= 1 && value <= 16384 && value == std::floor(value)))
    throw Error(where + ": " + name + " must be a whole number in 1..16384");
  return static_cast<int>(value);
}

/// Returns the numbers of an array; throws Error if it is not an array of `count` numbers.
std::vector<double> listed_numbers(const Json& array, std::size_t count, const std::string& where) {
  if (!array.is_array() || array.size() != count)
    throw Error(where + ": must be a list of " + std::to_string(count) + " numbers");
  std::vector<double> values;
  for (const Json& each : array) {
    if (!each.is_number()) throw Error(where + ": '" + each.dump().substr(0, 40) + "' is not a number");
    values.push_back(each.get<double>());
  }
  return values;
}

Intrinsics colour_camera_of(const Json& metadata, const std::string& where) {
  const std::vector<double> K = listed_numbers(json_field(metadata, "K", where), 9, where + ", K");
  const Intrinsics camera{
      size_px(metadata, "w", where), size_px(metadata, "h", where), K[0], K[4], K[6], K[7]};
  require_valid(camera, (where + ", K").c_str());
  return camera;
}

}  // namespace

bool is_record3d(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / "metadata", ignored) && fs::is_directory(folder / "depth", ignored);
}

IndexedRecording index_record3d(const fs::path& folder) {
  const std::string where = (folder / "metadata").string();
  const Json metadata =
      Json::parse(read_bytes(folder / "metadata", "Record3D's metadata", kMaxMetadata_bytes), nullptr,
                  /*allow_exceptions=*/false);
  if (metadata.is_discarded() || !metadata.is_object())
    throw Error(where + ": is not JSON; is it cut short?");

  IndexedRecording recording{.name = fs::canonical(folder).string()};
  const Intrinsics colour = colour_camera_of(metadata, where);
  recording.rig.colour_camera = colour;
  const int depth_width = size_px(metadata, "dw", where), depth_height = size_px(metadata, "dh", where);
  recording.rig.depth_noise = kPhoneLidarNoise;
  recording.rig.depth_camera = scaled_to_depth(colour, {depth_width, depth_height}, where);

  const Json& poses = json_field(metadata, "poses", where);
  const Json stamps = metadata.value("frameTimestamps", Json::array());
  const double fps = metadata.contains("fps") ? json_number(metadata, "fps", where) : 30.0;
  if (!poses.is_array() || !stamps.is_array())
    throw Error(where + ": poses and frameTimestamps must be lists");
  if (!(fps > 0.0)) throw Error(where + ": fps must be > 0");

  std::vector<fs::path> depth_paths, colour_paths;
  for (const auto& [number, file] : numbered_files(folder / "depth", {".exr"})) {
    const auto at = static_cast<std::size_t>(number);
    const std::string item = "[" + std::to_string(number) + "]";
    IndexedFrame frame{.stamp_s = static_cast<double>(number) / fps};
    if (!stamps.empty()) {
      if (at >= stamps.size() || !stamps[at].is_number())
        frame.fault = where + ": frameTimestamps" + item + " is missing or not a number";
      else
        frame.stamp_s = stamps[at].get<double>();
    }
    if (at >= poses.size()) {
      frame.fault = where + ": poses" + item + " is missing";
    } else {
      const std::vector<double> p = listed_numbers(poses[at], 7, where + ", poses" + item);
      if (const auto T_arkit = rigid_pose({p[4], p[5], p[6]}, {p[0], p[1], p[2], p[3]})) {
        frame.T_world_camera = world_from_arkit(*T_arkit);
        frame.down_camera = down_in_camera(*frame.T_world_camera);
      }
    }
    const fs::path image = folder / "rgb" / (std::to_string(number) + ".jpg");
    frame.has_colour = fs::exists(image);
    depth_paths.push_back(file);
    colour_paths.push_back(image);
    recording.frames.push_back(std::move(frame));
  }
  recording.read_depth = [depth_paths](std::size_t frame, DepthImage& depth_m) {
    const fs::path& file = depth_paths[frame];
    decode_exr_depth(read_bytes(file, "an EXR image", kMaxExr_bytes), file.string(), depth_m);
  };
  recording.read_colour = [colour_paths](std::size_t frame, ColourImage& image) {
    read_colour_file(colour_paths[frame], image);
  };
  return recording;
}

}  // namespace roomradar
