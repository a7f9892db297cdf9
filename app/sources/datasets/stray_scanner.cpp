// stray_scanner.cpp: comma-separated lists, numbered images and a video.
#include "app/sources/datasets/stray_scanner.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>

#include "app/sources/datasets/arkit_axes.hpp"
#include "app/sources/datasets/numbered_files.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "app/sources/formats/parse_numbers.hpp"
#include "app/sources/formats/time_tracks.hpp"
#include "app/sources/video/video_file.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxCsv_bytes = 1U << 30U;

/// Calls use(numbers, where) per line with at least `count` numbers. A first line without numbers is a
/// heading.
template <typename Use>
void for_each_row(const fs::path& path, std::size_t count, const Use& use) {
  std::istringstream lines(read_bytes(path, "a list of numbers", kMaxCsv_bytes));
  int line_number = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string where = path.string() + ", line " + std::to_string(++line_number);
    std::replace(line.begin(), line.end(), ',', ' ');
    std::vector<double> numbers;
    for (const std::string_view word : split_words(line)) {
      const auto number = parse_number(word);
      if (!number && line_number == 1 && numbers.empty()) break;
      if (!number) throw Error(where + ": '" + std::string(word.substr(0, 40)) + "' is not a number");
      numbers.push_back(*number);
    }
    if (numbers.empty()) continue;
    if (numbers.size() < count)
      throw Error(where + ": has " + std::to_string(numbers.size()) + " numbers; must have " +
                  std::to_string(count));
    use(numbers, where);
  }
}

Intrinsics camera_matrix_of(const fs::path& path, int width_px, int height_px) {
  std::vector<double> m;
  for_each_row(path, 3, [&](const std::vector<double>& row, const std::string&) {
    m.insert(m.end(), row.begin(), row.begin() + 3);
  });
  if (m.size() != 9) throw Error(path.string() + ": must be a 3 x 3 matrix");
  const Intrinsics camera{width_px, height_px, m[0], m[4], m[2], m[5]};
  require_valid(camera, path.string().c_str());
  return camera;
}

struct Odometry {
  double stamp_s = 0.0;
  std::optional<Eigen::Isometry3d> T_world_camera;
};

/// Returns the rows of odometry.csv by frame.
std::map<std::int64_t, Odometry> odometry_of(const fs::path& path) {
  constexpr double kMostFrames = 1e9;
  std::map<std::int64_t, Odometry> rows;
  for_each_row(path, 9, [&](const std::vector<double>& row, const std::string& where) {
    if (!(row[1] >= 0 && row[1] < kMostFrames && row[1] == std::floor(row[1])))
      throw Error(where + ": the second number must be that of a frame");
    Odometry odometry{row[0], std::nullopt};
    if (const auto T = rigid_pose({row[2], row[3], row[4]}, {row[5], row[6], row[7], row[8]}))
      odometry.T_world_camera = world_from_arkit_world(*T);
    rows[static_cast<std::int64_t>(row[1])] = odometry;
  });
  return rows;
}

/// Sets pixels of confidence 0 to 0.
void remove_unsure(const Image<std::uint8_t>& confidence, const std::string& where, DepthImage& depth_m) {
  if (confidence.width != depth_m.width || confidence.height != depth_m.height)
    throw Error(where + ": is " + size_text(confidence.width, confidence.height) + ", but depth is " +
                size_text(depth_m.width, depth_m.height));
  for (std::size_t i = 0; i < depth_m.pixels.size(); ++i)
    if (confidence.pixels[i] == 0) depth_m.pixels[i] = 0.0F;
}

}  // namespace

bool is_stray_scanner(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / "odometry.csv", ignored) &&
         fs::is_regular_file(folder / "camera_matrix.csv", ignored) &&
         fs::is_directory(folder / "depth", ignored);
}

IndexedRecording index_stray_scanner(const fs::path& folder) {
  const auto video = std::make_shared<VideoFile>(folder / "rgb.mp4");
  IndexedRecording recording{.name = fs::canonical(folder).string()};
  const Intrinsics colour =
      camera_matrix_of(folder / "camera_matrix.csv", video->width_px(), video->height_px());
  recording.rig.colour_camera = colour;
  recording.rig.depth_noise = kPhoneLidarNoise;

  const std::map<std::int64_t, Odometry> odometry = odometry_of(folder / "odometry.csv");
  const auto files = numbered_files(folder / "depth", {".png"});
  std::vector<fs::path> paths;
  std::vector<std::size_t> numbers;
  for (const auto& [number, path] : files) {
    IndexedFrame frame{.has_colour = true};
    const auto row = odometry.find(number);
    if (row == odometry.end()) {
      frame.fault = path.string() + ": odometry.csv has no line for its frame";
    } else {
      frame.stamp_s = row->second.stamp_s;
      frame.T_world_camera = row->second.T_world_camera;
      if (frame.T_world_camera) frame.down_camera = down_in_camera(*frame.T_world_camera);
    }
    recording.frames.push_back(std::move(frame));
    paths.push_back(path);
    numbers.push_back(static_cast<std::size_t>(number));
  }
  recording.rig.depth_camera = scaled_to_depth(colour, size_of_first_png(paths, folder), folder.string());
  recording.read_depth = [paths, folder](std::size_t frame, DepthImage& depth_m) {
    const fs::path confidence_path = folder / "confidence" / paths[frame].filename();
    read_depth_file(paths[frame], DepthEncoding::kMillimetres, depth_m);
    if (!fs::exists(confidence_path)) return;
    Image<std::uint8_t> confidence;
    const std::string name = confidence_path.string();
    decode_grey_png(read_bytes(confidence_path, "an image", kMaxCsv_bytes), name, confidence);
    remove_unsure(confidence, name, depth_m);
  };
  recording.read_colour = [video, numbers](std::size_t frame, ColourImage& image) {
    video->read(numbers[frame], image);
  };
  return recording;
}

}  // namespace roomradar
