// record3d.cpp: metadata, numbered images, and ARKit's axes.
#include "app/sources/datasets/dataset_readers.hpp"

#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/sources/containers/exr_depth.hpp"
#include "app/sources/datasets/arkit_axes.hpp"
#include "app/sources/datasets/numbered_files.hpp"
#include "app/sources/formats/camera_rig_json.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "app/sources/formats/parse_numbers.hpp"
#include "app/sources/formats/time_tracks.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::uintmax_t kMaxMetadata_bytes = 1U << 28U;  // two hours at 60 Hz
constexpr std::uintmax_t kMaxExr_bytes = 1U << 28U;

/// Returns the depth images: .exr, as the app writes them, or .png of converted exports.
std::map<std::int64_t, fs::path> depth_images_of(const fs::path& folder) {
  return numbered_files(folder / "depth", {".exr", ".png"});
}

int size_px(const Json& metadata, const char* name, const std::string& where) {
  const double value = json_number(metadata, name, where);
  if (!(value >= 1 && value <= 16384 && value == std::floor(value)))
    throw Error(where + ": " + name + " must be a whole number in 1..16384");
  return static_cast<int>(value);
}

/// Returns the numbers of an array; nullopt if it is not an array of `count` numbers.
std::optional<std::vector<double>> listed_numbers(const Json& array, std::size_t count) {
  if (!array.is_array() || array.size() != count) return std::nullopt;
  std::vector<double> values;
  for (const Json& each : array) {
    if (!each.is_number()) return std::nullopt;
    values.push_back(each.get<double>());
  }
  return values;
}

/// Replaces strings that are numbers, as some scripts write them, by these numbers.
void read_quoted_numbers(Json& value) {
  if (value.is_structured())
    for (Json& each : value) read_quoted_numbers(each);
  else if (value.is_string())
    if (const auto number = parse_number(value.get_ref<const std::string&>())) value = *number;
}

/// Reads a depth image, m.
void read_depth_image(const fs::path& file, double unit_m, DepthImage& depth_m) {
  if (file.extension() == ".png") return read_depth_file(file, DepthEncoding::kMillimetres, unit_m, depth_m);
  decode_exr_depth(read_bytes(file, "an EXR image", kMaxExr_bytes), file.string(), depth_m);
  scale_depth(unit_m, depth_m);
}

/// Returns the size dw x dh, else that of the first depth image that can be read. Throws Error if there is
/// none.
ImageSize depth_size_of(const Json& metadata, const std::map<std::int64_t, fs::path>& depth_images,
                        const std::string& where) {
  if (metadata.contains("dw") && metadata.contains("dh"))
    return {size_px(metadata, "dw", where), size_px(metadata, "dh", where)};
  for (const auto& [number, file] : depth_images) {
    try {
      DepthImage depth_m;
      read_depth_image(file, 1.0, depth_m);
      return {depth_m.width, depth_m.height};
    } catch (const Error&) {  // counted when the frame's turn comes
    }
  }
  throw Error(where + ": states no dw and dh, and no depth image can be read");
}

Intrinsics colour_camera_of(const Json& metadata, const std::string& where) {
  if (!metadata.contains("K"))
    return phone_camera({size_px(metadata, "w", where), size_px(metadata, "h", where)});
  const auto listed = listed_numbers(json_field(metadata, "K", where), 9);
  if (!listed) throw Error(where + ", K: must be a list of 9 numbers");
  const std::vector<double>& K = *listed;
  const Intrinsics camera{
      size_px(metadata, "w", where), size_px(metadata, "h", where), K[0], K[4], K[6], K[7]};
  require_valid(camera, (where + ", K").c_str());
  return camera;
}

/// Sets cameras, unit and axes.
/// @param colour  see colour_camera_of()
/// @throws Error if the size of the depth images is not known, or not of the shape of the colour images
void set_rig(const Json& metadata, const fs::path& metadata_path, const Intrinsics& colour,
             const std::map<std::int64_t, fs::path>& depth_images, RecordingFacts& facts) {
  const std::string where = metadata_path.string();
  facts.rig.colour_camera = colour;
  facts.rig.depth_noise = kPhoneLidarNoise;
  facts.rig.depth_camera = scaled_to_depth(colour, depth_size_of(metadata, depth_images, where), where);
  facts.camera_source = "K in " + metadata_path.filename().string();
  if (!metadata.contains("K")) {
    facts.camera_origin = Origin::kAssumed;
    facts.camera_source = "an iPhone";
  }
  facts.is_depth_registered = true;
  const bool are_metres = depth_images.empty() || depth_images.begin()->second.extension() != ".png";
  facts.depth_unit_m = are_metres ? 1.0 : 0.001;
  facts.unit_source =
      are_metres ? "metres, by Record3D's format" : "assumed: millimetres, as in most .png files";
  if (!are_metres) facts.unit_origin = Origin::kAssumed;
  facts.has_quaternions = true;
  set_arkit_axes(facts, /*camera_is_opengl=*/true);
}

/// Times and poses of the metadata, by image number.
struct Tracks {
  Json poses, stamps;
  double fps = 30.0;
};

Tracks tracks_of(const Json& metadata, const std::string& where) {
  const Tracks tracks{metadata.value("poses", Json()), metadata.value("frameTimestamps", Json()),
                      metadata.contains("fps") ? json_number(metadata, "fps", where) : 30.0};
  if (!(tracks.poses.is_array() || tracks.poses.is_null()) ||
      !(tracks.stamps.is_array() || tracks.stamps.is_null()))
    throw Error(where + ": poses and frameTimestamps must be lists");
  if (!(tracks.fps > 0.0)) throw Error(where + ": fps must be > 0");
  return tracks;
}

/// Returns the frame of an image number, without colour.
StatedFrame frame_of(std::int64_t number, const Tracks& tracks) {
  const auto at = static_cast<std::size_t>(number);
  const Json &poses = tracks.poses, &stamps = tracks.stamps;
  StatedFrame frame{.time = {.stamp_s = static_cast<double>(number) / tracks.fps}};
  if (!stamps.empty())
    frame.time.stamp_s = at < stamps.size() && stamps[at].is_number() ? stamps[at].get<double>() : kNoStamp;
  if (!poses.empty()) {
    const auto p = at < poses.size() ? listed_numbers(poses[at], 7) : std::nullopt;
    if (p)
      frame.T_world_camera = rigid_pose({(*p)[4], (*p)[5], (*p)[6]}, {(*p)[0], (*p)[1], (*p)[2], (*p)[3]});
    if (!frame.T_world_camera)
      frame.pose_fault = at >= poses.size() ? "is missing in metadata"
                         : p                ? "is no rigid transform"
                                            : "is not a list of 7 numbers";
  }
  return frame;
}

/// Returns the file metadata, or metadata.json as other versions name it; empty if there is neither.
fs::path metadata_file(const fs::path& folder) {
  std::error_code ignored;
  for (const char* name : {"metadata", "metadata.json"})
    if (fs::is_regular_file(folder / name, ignored)) return folder / name;
  return {};
}

/// True for a file *.r3d, or its content, which are not exports.
bool is_unexported(const fs::path& path) {
  std::error_code ignored;
  return path.extension() == ".r3d" ||
         (fs::is_regular_file(path / "metadata", ignored) && fs::is_directory(path / "rgbd", ignored) &&
          !fs::is_directory(path / "depth", ignored));
}

}  // namespace

bool is_record3d(const fs::path& folder) {
  std::error_code ignored;
  if (is_unexported(folder)) return true;
  const fs::path metadata = metadata_file(folder);
  return !metadata.empty() && fs::is_directory(folder / "depth", ignored) &&
         (metadata.extension().empty() || !depth_images_of(folder).empty());
}

RecordingFacts index_record3d(const fs::path& folder) {
  const fs::path metadata_path = metadata_file(folder);
  const std::string where = metadata_path.string();
  if (is_unexported(folder))
    throw Error(
        folder.string() +
        ": is in Record3D's own form (.r3d, rgbd/N.depth), which is not read; export the recording in the "
        "app as \"EXR + RGB\"");
  Json metadata = Json::parse(read_bytes(metadata_path, "Record3D's metadata", kMaxMetadata_bytes), nullptr,
                              /*allow_exceptions=*/false);
  if (metadata.is_discarded() || !metadata.is_object())
    throw Error(where + ": is not JSON; is it cut short?");
  read_quoted_numbers(metadata);

  RecordingFacts facts{.name = fs::canonical(folder).string()};
  const Intrinsics colour = colour_camera_of(metadata, where);
  const auto depth_images = depth_images_of(folder);
  set_rig(metadata, metadata_path, colour, depth_images, facts);
  const Tracks tracks = tracks_of(metadata, where);
  facts.has_no_clock = tracks.stamps.empty() && !metadata.contains("fps");

  const auto images = numbered_files(folder / "rgb", {".jpg", ".jpeg", ".png"});
  std::vector<fs::path> depth_paths, colour_paths;
  std::ptrdiff_t with_colour = 0;
  for (const auto& [number, file] : depth_images) {
    StatedFrame frame = frame_of(number, tracks);
    const auto image = images.find(number);
    if (image != images.end()) frame.colour = colour_paths.size();
    depth_paths.push_back(file);
    colour_paths.push_back(image == images.end() ? fs::path{} : image->second);
    if (frame.colour) ++with_colour;
    facts.frames.push_back(std::move(frame));
  }
  if (with_colour > 0 && with_colour < std::ssize(images))
    facts.notes.push_back(unused_colours(std::ssize(images) - with_colour));
  facts.read_depth = [depth_paths](std::size_t frame, double unit_m, DepthImage& depth_m) {
    read_depth_image(depth_paths[frame], unit_m, depth_m);
  };
  facts.read_colour = [colour_paths](std::size_t colour_image, ColourImage& image) {
    read_colour_file(colour_paths[colour_image], image);
  };
  return facts;
}

}  // namespace roomradar
