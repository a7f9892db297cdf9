// redwood.cpp: numbered images with trajectories as text.
#include "app/sources/datasets/redwood.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "app/sources/datasets/numbered_files.hpp"
#include "app/sources/formats/camera_rig_json.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/parse_numbers.hpp"
#include "app/sources/formats/time_tracks.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxTrajectory_bytes = 1U << 30U;
constexpr double kFrameRate_hz = 30.0;

/// Returns the first file, by name, that ends in `ending`; empty if there is none.
fs::path file_ending(const fs::path& folder, std::string_view ending) {
  std::error_code fault;
  fs::path found;
  for (fs::directory_iterator each(folder, fault), end; !fault && each != end; each.increment(fault)) {
    const std::string name = each->path().filename().string();
    if (name.ends_with(ending) && (found.empty() || each->path() < found)) found = each->path();
  }
  return found;
}

fs::path intrinsics_file(const fs::path& folder) {
  for (const char* name : {"intrinsic.json", "camera_intrinsic.json"})
    if (fs::exists(folder / name)) return folder / name;
  return {};
}

fs::path colour_images(const fs::path& folder) {
  for (const char* name : {"color", "colour", "image", "rgb"})
    if (fs::is_directory(folder / name)) return folder / name;
  return {};
}

/// Calls use(numbers, where) per line that is not empty and no comment.
template <typename Use>
void for_each_numbers(const fs::path& path, const Use& use) {
  std::istringstream lines(read_bytes(path, "a trajectory", kMaxTrajectory_bytes));
  int line_number = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string where = path.string() + ", line " + std::to_string(++line_number);
    std::vector<double> numbers;
    const auto words = split_words(line);
    if (words.empty() || words[0].starts_with('#')) continue;
    for (const std::string_view word : words) {
      const auto number = parse_number(word);
      if (!number) throw Error(where + ": '" + std::string(word.substr(0, 40)) + "' is not a number");
      numbers.push_back(*number);
    }
    use(numbers, where);
  }
}

/// Returns the poses of a .log file in its order; nullopt where an entry is not finite.
std::vector<std::optional<Eigen::Isometry3d>> read_log(const fs::path& path) {
  std::vector<std::optional<Eigen::Isometry3d>> poses;
  Eigen::Matrix4d matrix;
  int row = -1;  // of the matrix; -1: its heading
  for_each_numbers(path, [&](const std::vector<double>& numbers, const std::string& where) {
    const std::size_t count = row < 0 ? 3 : 4;
    if (numbers.size() != count)
      throw Error(where + ": has " + std::to_string(numbers.size()) + " numbers; must be " +
                  (row < 0 ? "the 3 integers before a pose" : "4, a row of a pose"));
    if (row >= 0) matrix.row(row) = Eigen::Map<const Eigen::RowVector4d>(numbers.data());
    if (++row < 4) return;
    row = -1;
    if (!matrix.allFinite()) {
      poses.emplace_back();
      return;
    }
    const auto T = rigid_transform(matrix.topRows<3>());
    if (!T) throw Error(where + ": the pose that ends here is not a rigid transform");
    poses.emplace_back(T);
  });
  if (row >= 0) throw Error(path.string() + ": ends within a pose; is it cut short?");
  return poses;
}

Intrinsics read_open3d_intrinsics(const fs::path& path) {
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
  return camera;
}

/// Makes the recording of registered images without poses. `numbers` receives the number of each frame.
IndexedRecording registered_images(const fs::path& folder, const fs::path& colour_folder,
                                   DepthEncoding encoding, std::vector<std::int64_t>& numbers) {
  IndexedRecording recording{.name = fs::canonical(folder).string()};
  const auto colours = numbered_files(colour_folder, {".jpg", ".jpeg", ".png"});
  std::vector<fs::path> depth_paths, colour_paths;
  for (const auto& [number, path] : numbered_files(folder / "depth", {".png"})) {
    const auto colour = colours.find(number);
    recording.frames.push_back(
        {.stamp_s = static_cast<double>(number) / kFrameRate_hz, .has_colour = colour != colours.end()});
    depth_paths.push_back(path);
    colour_paths.push_back(colour == colours.end() ? fs::path{} : colour->second);
    numbers.push_back(number);
  }
  const ImageSize size = size_of_first_png(depth_paths, folder);
  recording.rig.depth_camera = {size.width_px, size.height_px, 0, 0, 0, 0};
  recording.read_depth = [depth_paths, encoding](std::size_t frame, DepthImage& depth_m) {
    read_depth_file(depth_paths[frame], encoding, depth_m);
  };
  recording.read_colour = [colour_paths](std::size_t frame, ColourImage& image) {
    read_colour_file(colour_paths[frame], image);
  };
  std::erase(colour_paths, fs::path{});
  if (!colour_paths.empty()) {
    const ImageSize colour_size = size_of_first_png(colour_paths, folder);
    recording.rig.colour_camera = {colour_size.width_px, colour_size.height_px, 0, 0, 0, 0};
  }
  return recording;
}

/// Sets both cameras to `camera`, scaled to the images.
void set_registered_camera(IndexedRecording& recording, const Intrinsics& camera) {
  const auto fit = [&](Intrinsics& to) {
    to = scaled_to_depth(camera, {to.width_px, to.height_px}, recording.name);
  };
  fit(recording.rig.depth_camera);
  if (recording.rig.colour_camera) fit(*recording.rig.colour_camera);
}

}  // namespace

bool is_redwood(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_directory(folder / "depth", ignored) && !colour_images(folder).empty() &&
         (!file_ending(folder, ".log").empty() || !intrinsics_file(folder).empty());
}

IndexedRecording index_redwood(const fs::path& folder) {
  constexpr Intrinsics kPrimeSense{640, 480, 525.0, 525.0, 319.5, 239.5};
  std::vector<std::int64_t> numbers;
  IndexedRecording recording =
      registered_images(folder, colour_images(folder), DepthEncoding::kMillimetres, numbers);
  const fs::path intrinsics = intrinsics_file(folder);
  set_registered_camera(recording, intrinsics.empty() ? kPrimeSense : read_open3d_intrinsics(intrinsics));
  const fs::path log = file_ending(folder, ".log");
  if (log.empty()) return recording;
  const auto poses = read_log(log);
  for (std::size_t i = 0; i < std::min(poses.size(), recording.frames.size()); ++i)
    recording.frames[i].T_world_camera = poses[i];
  return recording;
}

bool is_icl_nuim(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_directory(folder / "depth", ignored) && fs::is_directory(folder / "rgb", ignored) &&
         !file_ending(folder, ".gt.freiburg").empty();
}

IndexedRecording index_icl_nuim(const fs::path& folder) {
  constexpr Intrinsics kIclNuim{640, 480, 481.2, 480.0, 319.5, 239.5};
  std::vector<std::int64_t> numbers;
  IndexedRecording recording = registered_images(folder, folder / "rgb", DepthEncoding::kTum, numbers);
  set_registered_camera(recording, kIclNuim);
  std::map<double, std::optional<Eigen::Isometry3d>> poses;
  for_each_numbers(file_ending(folder, ".gt.freiburg"),
                   [&](const std::vector<double>& row, const std::string& where) {
                     if (row.size() != 8 || !std::isfinite(row[0]))
                       throw Error(where + ": has " + std::to_string(row.size()) +
                                   " numbers; must be a frame, a position and a quaternion");
                     poses[row[0]] = rigid_pose({row[1], row[2], row[3]}, {row[4], row[5], row[6], row[7]});
                   });
  Eigen::Isometry3d mirror = Eigen::Isometry3d::Identity();
  mirror.linear().diagonal() << 1, -1, 1;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto pose = poses.find(static_cast<double>(numbers[i]));
    if (pose != poses.end() && pose->second)
      recording.frames[i].T_world_camera = mirror * *pose->second * mirror;
  }
  return recording;
}

}  // namespace roomradar
