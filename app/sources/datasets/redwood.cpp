// redwood.cpp: numbered images with trajectories as text.
#include "app/sources/datasets/dataset_readers.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>

#include "app/sources/datasets/numbered_files.hpp"
#include "app/sources/datasets/text_lists.hpp"
#include "app/sources/formats/camera_rig_json.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/parse_numbers.hpp"
#include "app/sources/formats/time_tracks.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/folders.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

/// Returns the first file, by name, that ends in `ending`; empty if there is none.
fs::path file_ending(const fs::path& folder, std::string_view ending) {
  std::error_code ignored;
  for (const fs::path& file : entries_of(folder, ignored))
    if (file.filename().string().ends_with(ending)) return file;
  return {};
}

fs::path intrinsics_file(const fs::path& folder) {
  for (const char* name : {"intrinsic.json", "camera_intrinsic.json"})
    if (fs::exists(folder / name)) return folder / name;
  return {};
}

/// A pose of a .log file. Its heading's first number is the frame's.
struct LoggedPose {
  std::int64_t frame = 0;
  std::optional<Eigen::Isometry3d> T_world_camera;  ///< unset: tracking was lost
};

/// Returns the poses of a .log file. A heading that is not a number >= 0 counts on from the heading before.
/// The file is read up to the first line that is not as it must be, which is noted. Counts poses that are no
/// rigid transform.
std::vector<LoggedPose> read_log(const fs::path& path, RecordingFacts& facts) {
  std::vector<LoggedPose> poses;
  Eigen::Matrix4d matrix;
  int row = -1;  // of the matrix; -1: its heading
  std::int64_t frame = -1;
  const auto read_line = [&](std::string_view line, const std::string& where) {
    const std::vector<double> numbers = parse_numbers(line, where);
    const std::size_t count = row < 0 ? 3 : 4;
    if (numbers.size() != count)
      throw Error(where + ": has " + std::to_string(numbers.size()) + " numbers; must be " +
                  (row < 0 ? "the 3 integers before a pose" : "4, a row of a pose"));
    if (row >= 0)
      matrix.row(row) = Eigen::Map<const Eigen::RowVector4d>(numbers.data());
    else
      frame = numbers[0] >= 0 && numbers[0] < 1e9 ? static_cast<std::int64_t>(numbers[0]) : frame + 1;
    if (++row < 4) return;
    row = -1;
    poses.push_back({frame, rigid_transform(matrix.topRows<3>())});
    if (!poses.back().T_world_camera) ++facts.lost_track_poses;
  };
  std::string fault;
  try {
    for_each_line(path, read_line);
    if (row >= 0) fault = path.string() + ": ends within a pose; is it cut short?";
  } catch (const Error& error) {
    fault = error.what();
  }
  if (!fault.empty())
    facts.notes.push_back({"poses", std::to_string(poses.size()) + " poses are read, up to a fault: " + fault,
                           static_cast<std::int64_t>(poses.size()), "", true});
  return poses;
}

/// Numbers the poses by their place if two have the same number, as some programs write one heading for all.
void number_by_place_if_repeated(std::vector<LoggedPose>& poses, const std::string& file, RecordingFacts& facts) {
  std::set<std::int64_t> seen;
  if (std::all_of(poses.begin(), poses.end(), [&](const LoggedPose& pose) { return seen.insert(pose.frame).second; }))
    return;
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].frame = static_cast<std::int64_t>(i);
  facts.notes.push_back({"poses",
                         "the headings of " + file + " do not number the frames; its poses are those of the frames "
                         "in their order",
                         static_cast<std::int64_t>(poses.size()), "", true});
}

/// Returns the number of a frame's file minus its number in the headings: 0 if either the first or the last
/// numbers agree, else that of the first ones. Files of Redwood's scans count from 1, headings from 0.
std::int64_t files_after_headings(const std::vector<LoggedPose>& poses, const std::vector<std::int64_t>& files) {
  if (poses.empty() || files.empty()) return 0;
  const auto [least, most] = std::minmax_element(
      poses.begin(), poses.end(), [](const LoggedPose& a, const LoggedPose& b) { return a.frame < b.frame; });
  if (least->frame >= files.front() || most->frame == files.back()) return 0;
  return least->frame == 0 ? files.front() : 0;
}

/// Returns true if the file's first lines are a heading of three integers and a row of four numbers.
bool is_trajectory_log(const fs::path& path) {
  constexpr std::size_t kHead_bytes = 4096;
  std::ifstream file(path, std::ios::binary);
  std::string head(kHead_bytes, '\0');
  file.read(head.data(), kHead_bytes);
  head.resize(static_cast<std::size_t>(file.gcount()));
  std::istringstream lines(head);
  std::size_t row = 0;
  for (std::string line; row < 2 && std::getline(lines, line);) {
    const auto words = split_words(line);
    if (words.empty() || words[0].starts_with('#')) continue;
    if (words.size() != 3 + row || !std::all_of(words.begin(), words.end(), [](std::string_view word) {
          return parse_number(word).has_value();
        }))
      return false;
    ++row;
  }
  return row == 2;
}

/// Returns the first file *.log, by name, that contains a trajectory; empty if there is none.
fs::path trajectory_log(const fs::path& folder) {
  std::error_code ignored;
  for (const fs::path& file : entries_of(folder, ignored))
    if (file.extension() == ".log" && is_trajectory_log(file)) return file;
  return {};
}

/// Open3D's intrinsic.json: camera, units of depth per metre, and images per second.
/// Source: Open3D, RGBDVideoMetadata::ConvertToJsonValue(), written by RGBDVideoReader::SaveFrames().
struct Open3dIntrinsics {
  Intrinsics camera;
  std::optional<double> depth_scale;
  std::optional<double> fps;
};

Open3dIntrinsics read_open3d_intrinsics(const fs::path& path) {
  const std::string where = path.string();
  const auto root = nlohmann::json::parse(read_json_text(path), nullptr, /*allow_exceptions=*/false);
  if (root.is_discarded()) throw Error(where + ": is not JSON; is it cut short?");
  const auto& matrix = json_field(root, "intrinsic_matrix", where);
  const double width = json_number(root, "width", where), height = json_number(root, "height", where);
  if (!(width >= 1 && width <= 16384 && height >= 1 && height <= 16384))
    throw Error(where + ": width and height must be in 1..16384");
  if (!matrix.is_array() || matrix.size() != 9 ||
      !std::all_of(matrix.begin(), matrix.end(), [](const auto& each) { return each.is_number(); }))
    throw Error(where + ": intrinsic_matrix must be 9 numbers, column by column");
  const Intrinsics camera{static_cast<int>(width), static_cast<int>(height), matrix[0].get<double>(),
                          matrix[4].get<double>(), matrix[6].get<double>(),  matrix[7].get<double>()};
  require_valid(camera, where.c_str());
  Open3dIntrinsics intrinsics{camera, std::nullopt, std::nullopt};
  if (root.contains("depth_scale")) {
    intrinsics.depth_scale = json_number(root, "depth_scale", where);
    if (!(*intrinsics.depth_scale > 0.0 && *intrinsics.depth_scale <= 1e7))
      throw Error(where + ": depth_scale must be above 0, such as 1000 for millimetres");
  }
  if (root.contains("fps")) {
    const double fps = json_number(root, "fps", where);
    if (fps >= 1.0 && fps <= 1000.0) intrinsics.fps = fps;
  }
  return intrinsics;
}

/// States registered images without cameras and poses. `numbers` receives the number of each frame.
RecordingFacts registered_images(const fs::path& folder, const fs::path& colour_images,
                                 DepthEncoding encoding, std::vector<std::int64_t>& numbers) {
  RecordingFacts facts{.name = fs::canonical(folder).string()};
  facts.is_written_by_many = true;
  facts.unit_source = "millimetres, by the formats of Redwood and Open3D";
  const auto colours = numbered_files(colour_images, {".jpg", ".jpeg", ".png"});
  std::vector<fs::path> depth_paths, colour_paths;
  for (const auto& [number, path] : numbered_files(depth_folder(folder), {".png"})) {
    const auto colour = colours.find(number);
    facts.frames.push_back({.time = {.stamp_s = static_cast<double>(number) / kNominalRate_hz}});
    if (colour != colours.end()) {
      facts.frames.back().colour = colour_paths.size();
      colour_paths.push_back(colour->second);
    }
    depth_paths.push_back(path);
    numbers.push_back(number);
  }
  facts.has_no_clock = true;
  facts.is_depth_registered = true;
  facts.depth_unit_m = depth_unit_m(encoding);
  const ImageSize size = size_of_images(depth_paths, folder);
  if (!colour_paths.empty() && colour_paths.size() < colours.size())
    facts.notes.push_back(unused_colours(std::ssize(colours) - std::ssize(colour_paths)));
  facts.rig.depth_camera = {size.width_px, size.height_px, 0, 0, 0, 0};
  if (!colour_paths.empty()) {
    const ImageSize colour_size = size_of_images(colour_paths, folder);
    facts.rig.colour_camera = {colour_size.width_px, colour_size.height_px, 0, 0, 0, 0};
  }
  facts.read_depth = [depth_paths, encoding](std::size_t frame, double unit_m, DepthImage& depth_m) {
    read_depth_file(depth_paths[frame], encoding, unit_m, depth_m);
  };
  facts.read_colour = [colour_paths](std::size_t colour, ColourImage& image) {
    read_colour_file(colour_paths[colour], image);
  };
  return facts;
}

/// Sets both cameras to `camera`, scaled to the images.
void set_registered_camera(RecordingFacts& facts, const Intrinsics& camera) {
  const auto fit = [&](Intrinsics& to) {
    to = scaled_to_depth(camera, {to.width_px, to.height_px}, facts.name);
  };
  fit(facts.rig.depth_camera);
  if (facts.rig.colour_camera) fit(*facts.rig.colour_camera);
}

/// Takes the poses of files pose/N.txt, as other exports with an intrinsic.json have them.
void read_pose_files(const fs::path& folder, const std::vector<std::int64_t>& numbers, RecordingFacts& facts) {
  std::error_code ignored;
  const auto files = numbered_files(folder / (fs::is_directory(folder / "pose", ignored) ? "pose" : "poses"), {".txt"});
  if (files.empty()) return;
  facts.read_pose = [files, numbers](std::size_t frame, double) {
    const auto file = files.find(numbers[frame]);
    return file == files.end() ? StatedPose{} : read_pose_file(file->second);
  };
}

}  // namespace

bool is_redwood(const fs::path& folder) {
  return !depth_folder(folder).empty() && !colour_folder(folder).empty() &&
         (!trajectory_log(folder).empty() || !intrinsics_file(folder).empty());
}

RecordingFacts index_redwood(const fs::path& folder) {
  constexpr Intrinsics kPrimeSense{640, 480, 525.0, 525.0, 319.5, 239.5};
  std::vector<std::int64_t> numbers;
  RecordingFacts facts =
      registered_images(folder, colour_folder(folder), DepthEncoding::kMillimetres, numbers);
  const fs::path file = intrinsics_file(folder);
  if (file.empty()) {
    set_registered_camera(facts, kPrimeSense);
    facts.camera_origin = Origin::kAssumed;
    facts.camera_source = "a PrimeSense, as Redwood's recordings have it,";
  } else {
    const Open3dIntrinsics intrinsics = read_open3d_intrinsics(file);
    set_registered_camera(facts, intrinsics.camera);
    facts.camera_source = file.filename().string();
    if (intrinsics.fps) {
      facts.has_no_clock = false;
      for (std::size_t i = 0; i < numbers.size(); ++i)
        facts.frames[i].time.stamp_s = static_cast<double>(numbers[i]) / *intrinsics.fps;
    }
    if (intrinsics.depth_scale) {
      facts.depth_unit_m = 1.0 / *intrinsics.depth_scale;
      facts.unit_origin = Origin::kRecording;
      facts.unit_source = "depth_scale in " + file.filename().string();
    }
  }
  const fs::path log = trajectory_log(folder);
  if (log.empty()) {
    read_pose_files(folder, numbers, facts);
    return facts;
  }
  std::size_t without_image = 0;
  std::vector<LoggedPose> poses = read_log(log, facts);
  number_by_place_if_repeated(poses, log.filename().string(), facts);
  const std::int64_t shift = files_after_headings(poses, numbers);
  for (const LoggedPose& pose : poses) {
    const auto place = std::lower_bound(numbers.begin(), numbers.end(), pose.frame + shift);
    if (place == numbers.end() || *place != pose.frame + shift)
      ++without_image;
    else
      facts.frames[static_cast<std::size_t>(place - numbers.begin())].T_world_camera = pose.T_world_camera;
  }
  if (without_image > 0)
    facts.notes.push_back({"poses",
                           std::to_string(without_image) + " poses of " + log.filename().string() +
                               " are of frames without a depth image; they are left out",
                           static_cast<std::int64_t>(without_image)});
  return facts;
}

bool is_icl_nuim(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_directory(folder / "depth", ignored) && fs::is_directory(folder / "rgb", ignored) &&
         !file_ending(folder, ".gt.freiburg").empty();
}

RecordingFacts index_icl_nuim(const fs::path& folder) {
  constexpr Intrinsics kIclNuim{640, 480, 481.2, 480.0, 319.5, 239.5};
  std::vector<std::int64_t> numbers;
  RecordingFacts facts = registered_images(folder, folder / "rgb", DepthEncoding::kTum, numbers);
  set_registered_camera(facts, kIclNuim);
  facts.camera_origin = Origin::kFormat;
  facts.camera_source = "the rendered camera of ICL-NUIM";
  std::map<double, std::optional<Eigen::Isometry3d>> poses;
  for_each_line(file_ending(folder, ".gt.freiburg"), [&](std::string_view line, const std::string& where) {
    const std::vector<double> row = parse_numbers(line, where);
    if (row.size() != 8 || !std::isfinite(row[0]))
      throw Error(where + ": has " + std::to_string(row.size()) +
                  " numbers; must be a frame, a position and a quaternion");
    poses[row[0]] = rigid_pose({row[1], row[2], row[3]}, {row[4], row[5], row[6], row[7]});
  });
  Eigen::Isometry3d mirror = Eigen::Isometry3d::Identity();
  mirror.linear().diagonal() << 1, -1, 1;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto pose = poses.find(static_cast<double>(numbers[i]));
    if (pose == poses.end()) continue;
    if (pose->second)
      facts.frames[i].T_world_camera = mirror * *pose->second * mirror;
    else
      facts.frames[i].pose_fault = "is no rigid transform";
  }
  return facts;
}

}  // namespace roomradar
