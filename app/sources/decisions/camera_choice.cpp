// camera_choice.cpp: precedence of the files and options that state cameras.
#include "app/sources/decisions/camera_choice.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "app/sources/formats/camera_rig_json.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

void require_fit(const Intrinsics& camera, ImageSize images, const char* which, const std::string& where) {
  if (ImageSize{camera.width_px, camera.height_px} == images) return;
  throw Error(where + ": the " + which + " camera's intrinsics are for images of " +
              size_text(camera.width_px, camera.height_px) + ", but the recording's are " +
              size_text(images.width_px, images.height_px) + "; give intrinsics for " +
              size_text(images.width_px, images.height_px));
}

/// Returns camera.json: options.camera_file if it is one, else that of the folder; empty if there is none.
fs::path camera_json(const fs::path& folder, const SourceOptions& options) {
  if (!options.camera_file.empty())
    return options.camera_file.extension() == ".json" ? options.camera_file : fs::path{};
  std::error_code ignored;
  return fs::is_directory(folder, ignored) && fs::exists(folder / "camera.json", ignored)
             ? folder / "camera.json"
             : fs::path{};
}

/// Returns the file with the 3 x 3 matrix of the depth camera; empty if there is none.
fs::path matrix_file(const RecordingFacts& facts, const fs::path& folder, const SourceOptions& options) {
  if (!options.camera_file.empty()) return options.camera_file;
  std::error_code ignored;
  const fs::path beside = folder / "camera-intrinsics.txt";
  return facts.camera_origin == Origin::kAssumed && fs::exists(beside, ignored) ? beside : fs::path{};
}

void set_origin(RecordingFacts& facts, Origin origin, const std::string& source) {
  facts.camera_origin = origin;
  facts.camera_source = source;
}

/// Returns true if a stated focal length is that of the device assumed until then, to 3 %. If not, the device
/// is another one, and so is its colour camera. With a single matrix, as in the 3DMatch and TSDF-Fusion
/// datasets, depth is registered to colour.
bool is_same_device(const Intrinsics& stated, const Intrinsics& assumed) {
  constexpr double kSame = 0.03;
  return std::abs(stated.fx_px / assumed.fx_px - 1.0) < kSame;
}

/// Reports cameras, and the place of the colour camera, that nothing states.
void report_assumed(const RecordingFacts& facts, InputReport& report) {
  const Intrinsics& camera = facts.rig.depth_camera;
  if (facts.camera_origin == Origin::kAssumed)
    report.add(
        {"camera",
         "no camera is stated; that of " + facts.camera_source + " is assumed: focal length " +
             format_readable(camera.fx_px, 4) + " px at " + size_text(camera.width_px, camera.height_px) +
             ". State another in a file camera.json or camera-intrinsics.txt in the folder, or by the option",
         0, "--camera FILE", facts.is_registered_if_given && !facts.is_depth_registered});
  else if (facts.rig.colour_camera && facts.is_colour_camera_assumed)
    report.add({"camera",
                "the colour camera is not stated; that of " + facts.colour_camera_source +
                    " is assumed, with a focal length of " +
                    format_readable(facts.rig.colour_camera->fx_px, 4) + " px. camera.json can state it",
                0, "--camera FILE"});
  else if (facts.rig.colour_camera && facts.colour_pose_origin == Origin::kAssumed)
    report.add(
        {"camera",
         "the place of the colour camera beside the depth camera is not stated; the same place is assumed, "
         "so colours may be shifted by some pixels",
         0, "--camera FILE", true});
}

}  // namespace

void choose_cameras(RecordingFacts& facts, const fs::path& folder, const SourceOptions& options,
                    InputReport& report) {
  CameraRig& rig = facts.rig;
  const ImageSize depth{rig.depth_camera.width_px, rig.depth_camera.height_px};
  std::optional<ImageSize> colour;
  if (rig.colour_camera) colour = ImageSize{rig.colour_camera->width_px, rig.colour_camera->height_px};
  const auto register_colour = [&] {
    if (!colour) return;
    rig.colour_camera = fitted_to(rig.depth_camera, *colour);
    rig.T_colour_depth.setIdentity();
    facts.colour_pose_origin = facts.camera_origin;
  };
  const bool is_option = !options.camera_file.empty();
  if (const fs::path file = camera_json(folder, options); !file.empty()) {
    const DepthNoise noise = rig.depth_noise;
    rig = read_camera_file(file);
    if (rig.depth_noise == DepthNoise{}) rig.depth_noise = noise;
    require_fit(rig.depth_camera, depth, "depth", file.string());
    facts.depth_lens = facts.colour_lens = {};
    set_origin(facts, is_option ? Origin::kOption : Origin::kFile, file.string());
    facts.colour_pose_origin = facts.camera_origin;
    if (!rig.colour_camera) register_colour();
    facts.is_depth_registered = rig.T_colour_depth.matrix().isIdentity();
  } else if (const fs::path matrix = matrix_file(facts, folder, options); !matrix.empty()) {
    const bool was_assumed = facts.camera_origin == Origin::kAssumed;
    facts.colour_camera_source = facts.camera_source;
    const Intrinsics assumed = rig.depth_camera;
    rig.depth_camera = read_intrinsics_matrix(matrix, depth.width_px, depth.height_px);
    const bool is_other_device = was_assumed && !is_same_device(rig.depth_camera, assumed);
    if (is_other_device) rig.timing = {};
    facts.depth_lens = {};
    set_origin(facts, is_option ? Origin::kOption : Origin::kFile, matrix.string());
    if (facts.is_depth_registered || (was_assumed && facts.is_registered_if_given) || is_other_device)
      register_colour();
    else
      facts.is_colour_camera_assumed = was_assumed;
  }
  if (options.depth_camera) {
    require_valid(*options.depth_camera, "the depth intrinsics that were given");
    require_fit(*options.depth_camera, depth, "depth", facts.name);
    const bool was_assumed = facts.camera_origin == Origin::kAssumed;
    rig.depth_camera = *options.depth_camera;
    set_origin(facts, Origin::kOption, "the given depth camera");
    if (facts.is_depth_registered || (was_assumed && facts.is_registered_if_given)) register_colour();
  }
  if (!colour) rig.colour_camera.reset();
  if (rig.colour_camera) require_fit(*rig.colour_camera, *colour, "colour", facts.camera_source);
  report_assumed(facts, report);
}

StatedInput read_stated_input(const fs::path& folder, const SourceOptions& options) {
  StatedInput stated;
  const fs::path file = camera_json(folder, options);
  if (file.empty()) return stated;
  const std::string where = file.string();
  const auto root = nlohmann::json::parse(read_json_text(file), nullptr, /*allow_exceptions=*/false);
  if (!root.is_object()) return stated;  // read_camera_file() refuses it
  if (root.contains("depth_unit_m")) {
    stated.depth_unit_m = json_number(root, "depth_unit_m", where);
    if (!(*stated.depth_unit_m > 0.0 && *stated.depth_unit_m <= 1000.0))
      throw Error(where + ": depth_unit_m must be above 0, such as 0.001 for millimetres");
  }
  if (root.contains("poses_convention")) {
    const auto& word = root["poses_convention"];
    if (word.is_string()) stated.pose_convention = parse_pose_convention(word.get<std::string>());
    if (!stated.pose_convention)
      throw Error(where +
                  ": poses_convention must be \"stated\", or of the words inverse, opengl, wxyz, mm, cm, "
                  "separated by commas");
  }
  return stated;
}

}  // namespace roomradar
