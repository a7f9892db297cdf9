// recording_index_tum.cpp: reads the lists of a TUM RGB-D recording and associates them by stamp.
#include "app/sources/recordings/recording_index_tum.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "app/sources/formats/kinect_units.hpp"
#include "app/sources/formats/parse_numbers.hpp"
#include "app/sources/formats/stamp_pairing.hpp"
#include "app/sources/formats/time_tracks.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr double kLongestPoseGap_s = 0.050;  // a hand-held camera's path is not straight for longer
constexpr double kGravityWithin_s = 0.050;

/// Calls use(words, where) for each line that is neither empty nor a comment; `where` names file and line.
void for_each_line(const fs::path& path,
                   const std::function<void(const std::vector<std::string_view>&, const std::string&)>& use) {
  std::istringstream file(read_bytes(path, "a list of stamps", kLargestList_bytes));
  int line_number = 0;
  for (std::string line; std::getline(file, line);) {
    ++line_number;
    const auto words = split_words(line);
    if (!words.empty() && words[0][0] != '#')
      use(words, path.string() + ", line " + std::to_string(line_number));
  }
}

/// Reads the images of rgb.txt or depth.txt. An unusable line gets a stamp one frame after the line before
/// it.
std::vector<ListedImage> read_image_list(const fs::path& folder, const char* name) {
  std::vector<ListedImage> images;
  double last_s = -std::numeric_limits<double>::infinity();
  for_each_line(folder / name, [&](const std::vector<std::string_view>& words, const std::string& where) {
    ListedImage image{.stamp_s = std::isfinite(last_s) ? last_s + 1.0 / 30.0 : 0.0};
    const auto stamp_s = parse_number(words[0]);
    const fs::path file = words.size() > 1 ? fs::path(words[1]).lexically_normal() : fs::path();
    if (!stamp_s || !std::isfinite(*stamp_s)) {
      image.fault = where + ": '" + std::string(words[0].substr(0, 40)) + "' is not a stamp in seconds";
    } else if (words.size() != 2) {
      image.fault = where + ": must be a stamp and a file name";
    } else if (file.is_absolute() || *file.begin() == "..") {
      image.fault = where + ": the file must lie in the recording's folder";
    } else if (!(*stamp_s > last_s)) {
      image.fault = where + ": the stamp is not later than that of the line before";
    } else {
      image.stamp_s = last_s = *stamp_s;
      image.file = (folder / file).string();
    }
    images.push_back(std::move(image));
  });
  return images;
}

/// Reads rows of `count` numbers, the first a stamp, and sorts them by stamp. Skips rows with a number that
/// is not finite, which mean that nothing was measured.
std::vector<std::vector<double>> read_rows(const fs::path& path, std::size_t count) {
  std::vector<std::vector<double>> rows;
  for_each_line(path, [&](const std::vector<std::string_view>& words, const std::string& where) {
    std::vector<double> row;
    row.reserve(count);
    for (const std::string_view word : words) {
      const auto value = parse_number(word);
      if (!value) throw Error(where + ": '" + std::string(word.substr(0, 40)) + "' is not a number");
      row.push_back(*value);
    }
    if (row.size() != count)
      throw Error(where + ": has " + std::to_string(row.size()) + " numbers instead of " +
                  std::to_string(count));
    if (std::all_of(row.begin(), row.end(), [](double value) { return std::isfinite(value); }))
      rows.push_back(row);
  });
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a[0] < b[0]; });
  return rows;
}

/// Returns the poses of rows `stamp tx ty tz qx qy qz qw`, without those of a tracker that was lost.
std::vector<StampedPose> poses_of(const std::vector<std::vector<double>>& rows) {
  std::vector<StampedPose> poses;
  for (const std::vector<double>& row : rows)
    if (const auto T = rigid_pose({row[1], row[2], row[3]}, {row[4], row[5], row[6], row[7]}))
      poses.push_back({row[0], *T});
  return poses;
}

std::optional<Eigen::Vector3d> gravity_near(double stamp_s, const std::vector<std::vector<double>>& rows) {
  const auto after = std::lower_bound(rows.begin(), rows.end(), stamp_s,
                                      [](const auto& row, double s) { return row[0] < s; });
  auto nearest = after;
  if (after != rows.begin() && (after == rows.end() || stamp_s - (*(after - 1))[0] < (*after)[0] - stamp_s))
    nearest = after - 1;
  if (nearest == rows.end() || std::abs((*nearest)[0] - stamp_s) > kGravityWithin_s) return std::nullopt;
  const std::vector<double>& row = *nearest;
  return down_from_acceleration(Eigen::Vector3d(row[1], row[2], row[3]) / kStandardGravity_m_s2);
}

/// Feeds both lists to the pairing in the order of their stamps.
void associate(const std::vector<ListedImage>& depth, const std::vector<ListedImage>& colours,
               double tolerance_s, std::vector<RecordedFrame>& frames) {
  constexpr std::size_t kKept = 300;  // ten seconds of colour without depth
  StampPairing pairing({.tolerance_s = tolerance_s, .colours_kept = kKept});
  std::size_t c = 0;
  const auto add_colours_until = [&](double stamp_s) {
    for (; c < colours.size() && colours[c].stamp_s <= stamp_s; ++c) {
      pairing.add_colour(static_cast<std::int64_t>(c), colours[c].stamp_s);
      pair_up(pairing, colours, frames);
    }
  };
  for (std::size_t d = 0; d < depth.size(); ++d) {
    if (!depth[d].fault.empty()) continue;
    add_colours_until(depth[d].stamp_s);
    pairing.add_depth(static_cast<std::int64_t>(d), depth[d].stamp_s);
    pair_up(pairing, colours, frames);
  }
  add_colours_until(std::numeric_limits<double>::infinity());
  pairing.finish();
  pair_up(pairing, colours, frames);
}

}  // namespace

RecordingIndex index_tum(const fs::path& folder) {
  if (!fs::exists(folder / "depth.txt"))
    throw Error((folder / "depth.txt").string() + ": is missing beside rgb.txt");
  const bool has_colour = fs::exists(folder / "rgb.txt");
  if (!has_colour && fs::is_directory(folder / "rgb"))
    throw Error((folder / "rgb.txt").string() +
                ": is missing, although there is a folder rgb; it lists the colour images");

  const auto depth = read_image_list(folder, "depth.txt");
  const auto colours = has_colour ? read_image_list(folder, "rgb.txt") : std::vector<ListedImage>();
  const auto rows = [&](const char* name, std::size_t count) {
    return fs::exists(folder / name) ? read_rows(folder / name, count) : std::vector<std::vector<double>>();
  };
  const auto poses = poses_of(rows("groundtruth.txt", 8));
  const auto accelerations = rows("accelerometer.txt", 4);

  const bool is_bonn = fs::weakly_canonical(folder).filename().string().starts_with("rgbd_bonn_");
  RecordingIndex index{DepthEncoding::kTum, is_bonn ? NominalRig::kBonn : NominalRig::kTum, {}};
  index.frames.reserve(depth.size());
  for (const ListedImage& image : depth) {
    RecordedFrame frame{.stamp_s = image.stamp_s, .depth_file = image.file, .fault = image.fault};
    if (image.fault.empty()) {
      frame.T_world_camera = pose_at(poses, image.stamp_s, kLongestPoseGap_s);
      frame.down_camera = gravity_near(image.stamp_s, accelerations);
    }
    index.frames.push_back(std::move(frame));
  }
  // A recording by RecordingWriter keeps the pairs made from a device.
  const bool is_own = fs::exists(folder / "camera.json");
  associate(depth, colours, is_own ? kDevicePairing.tolerance_s : PairingConfig{}.tolerance_s, index.frames);
  return index;
}

}  // namespace roomradar
