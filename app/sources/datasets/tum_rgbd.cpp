// tum_rgbd.cpp: reads lists of images, poses and accelerations, each with stamps.
#include "app/sources/datasets/tum_rgbd.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "app/sources/datasets/numbered_files.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/kinect_units.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "app/sources/formats/parse_numbers.hpp"
#include "app/sources/formats/time_tracks.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxList_bytes = std::uintmax_t{1} << 30;
constexpr double kLongestPoseGap_s = 0.050;  // a hand-held camera's path is not straight for longer
constexpr double kGravityWithin_s = 0.050;

/// Calls use(line, where) for each line that is neither empty nor a comment; `where` names file and line.
template <typename Use>
void for_each_line(const fs::path& path, const Use& use) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  const std::string text = read_bytes(path, "a list of stamps", kMaxList_bytes);
  std::string_view rest = text;
  if (rest.starts_with(kByteOrderMark)) rest.remove_prefix(kByteOrderMark.size());
  for (int line_number = 1; !rest.empty(); ++line_number) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first != std::string_view::npos && line[first] != '#')
      use(line.substr(first), path.string() + ", line " + std::to_string(line_number));
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
}

/// Lines that were left out of a list.
struct BadLines {
  std::size_t count = 0;
  std::string first;
  void add(const std::string& fault) {
    if (count++ == 0) first = fault;
  }
  void report(const char* topic, const std::string& name, RecordingFacts& facts) const {
    if (count == 0) return;
    facts.notes.push_back({topic,
                           std::to_string(count) + (count == 1 ? " line of " : " lines of ") + name +
                               (count == 1 ? " is left out: " : " are left out, the first: ") + first,
                           static_cast<std::int64_t>(count)});
  }
};

struct ListedImage {
  double stamp = kNoStamp;
  std::string file;
};

/// Reads the images of rgb.txt or depth.txt. A stamp that is not a number is unknown.
std::vector<ListedImage> read_image_list(const fs::path& folder, const char* name, RecordingFacts& facts) {
  std::vector<ListedImage> images;
  BadLines bad, bad_stamps;
  for_each_line(folder / name, [&](std::string_view line, const std::string& where) {
    const std::size_t stamp_end = std::min(line.find_first_of(" \t\r"), line.size());
    const std::string_view stamp_word = line.substr(0, stamp_end);
    const std::size_t file_begin = std::min(line.find_first_not_of(" \t", stamp_end), line.size());
    const std::size_t file_end = line.find_last_not_of(" \t\r") + 1;
    const fs::path file =
        fs::path(file_begin < file_end ? line.substr(file_begin, file_end - file_begin) : "")
            .lexically_normal();
    if (file.empty() || file == ".") return bad.add(where + ": must be a stamp and a file name");
    if (file.is_absolute() || *file.begin() == "..")
      return bad.add(where + ": the file must lie in the recording's folder");
    const auto stamp = parse_number(stamp_word);
    if (!stamp || !std::isfinite(*stamp))
      bad_stamps.add(where + ": '" + std::string(stamp_word.substr(0, 40)) + "' is not a number");
    images.push_back({stamp && std::isfinite(*stamp) ? *stamp : kNoStamp, (folder / file).string()});
  });
  bad.report("images", name, facts);
  if (bad_stamps.count > 0)
    facts.notes.push_back({"time",
                           std::to_string(bad_stamps.count) + " stamps of " + name +
                               " are no numbers, the first: " + bad_stamps.first,
                           static_cast<std::int64_t>(bad_stamps.count)});
  return images;
}

/// Reads rows of `count` numbers, the first a stamp. Skips rows with a number that is not finite, which mean
/// that nothing was measured.
std::vector<std::vector<double>> read_rows(const fs::path& folder, const char* name, std::size_t count,
                                           RecordingFacts& facts) {
  std::vector<std::vector<double>> rows;
  std::error_code ignored;
  if (!fs::exists(folder / name, ignored)) return rows;
  BadLines bad;
  for_each_line(folder / name, [&](std::string_view line, const std::string& where) {
    std::vector<double> row;
    row.reserve(count);
    for (const std::string_view word : split_words(line)) {
      const auto value = parse_number(word);
      if (!value) return bad.add(where + ": '" + std::string(word.substr(0, 40)) + "' is not a number");
      row.push_back(*value);
    }
    if (row.size() != count)
      return bad.add(where + ": has " + std::to_string(row.size()) + " numbers instead of " +
                     std::to_string(count));
    if (std::all_of(row.begin(), row.end(), [](double value) { return std::isfinite(value); }))
      rows.push_back(std::move(row));
  });
  bad.report(count == 8 ? "poses" : "gravity", name, facts);
  return rows;
}

/// Returns the direction of gravity by the reading nearest in time.
std::optional<Eigen::Vector3d> gravity_near(double stamp_s,
                                            const std::vector<StampedAcceleration>& readings) {
  const auto after = std::lower_bound(readings.begin(), readings.end(), stamp_s,
                                      [](const auto& reading, double s) { return reading.stamp_s < s; });
  auto nearest = after;
  if (after != readings.begin() &&
      (after == readings.end() || stamp_s - (after - 1)->stamp_s < after->stamp_s - stamp_s))
    nearest = after - 1;
  if (nearest == readings.end() || std::abs(nearest->stamp_s - stamp_s) > kGravityWithin_s)
    return std::nullopt;
  return down_from_acceleration(nearest->acceleration_m_s2 / kStandardGravity_m_s2);
}

std::vector<fs::path> files_of(const std::vector<ListedImage>& images) {
  std::vector<fs::path> files;
  for (const ListedImage& image : images) files.emplace_back(image.file);
  return files;
}

}  // namespace

bool is_tum_rgbd(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / "depth.txt", ignored) || fs::exists(folder / "rgb.txt", ignored);
}

RecordingFacts index_tum_rgbd(const fs::path& folder) {
  if (!fs::exists(folder / "depth.txt"))
    throw Error((folder / "depth.txt").string() + ": is missing beside rgb.txt");
  const bool has_colour = fs::exists(folder / "rgb.txt");
  if (!has_colour && fs::is_directory(folder / "rgb"))
    throw Error((folder / "rgb.txt").string() +
                ": is missing, although there is a folder rgb; it lists the colour images");

  RecordingFacts facts{.name = fs::canonical(folder).string(), .stamps_have_no_unit = true};
  const auto depth =
      std::make_shared<const std::vector<ListedImage>>(read_image_list(folder, "depth.txt", facts));
  const auto colours = std::make_shared<const std::vector<ListedImage>>(
      has_colour ? read_image_list(folder, "rgb.txt", facts) : std::vector<ListedImage>());
  for (const ListedImage& image : *depth) facts.frames.push_back({.time = {.stamp_s = image.stamp}});
  for (const ListedImage& image : *colours) facts.colours.push_back({.stamp_s = image.stamp});
  // A recording by RecordingWriter keeps the pairs made from a device.
  if (!fs::exists(folder / "camera.json")) facts.pair_within_s = PairingConfig{}.tolerance_s;
  if (depth->empty()) return facts;

  const bool is_bonn = fs::weakly_canonical(folder).filename().string().starts_with("rgbd_bonn_");
  const NominalRig nominal = is_bonn ? NominalRig::kBonn : NominalRig::kTum;
  const ImageSize size = size_of_images(files_of(*depth), folder);
  std::optional<ImageSize> colour_size;
  if (!colours->empty()) colour_size = size_of_images(files_of(*colours), folder);
  facts.rig = nominal_rig(nominal, size, colour_size);
  facts.camera_origin = Origin::kAssumed;
  facts.camera_source = nominal_name(nominal);
  facts.is_depth_registered = true;
  facts.is_registered_if_given = true;
  facts.depth_unit_m = depth_unit_m(DepthEncoding::kTum);
  facts.unit_source = "1/5000 m, by the TUM RGB-D format";

  facts.pose_track = std::make_shared<std::vector<StampedPose>>();
  for (const auto& row : read_rows(folder, "groundtruth.txt", 8, facts)) {
    if (const auto T = rigid_pose({row[1], row[2], row[3]}, {row[4], row[5], row[6], row[7]}))
      facts.pose_track->push_back({row[0], *T});
    else
      ++facts.lost_track_poses;
  }
  facts.acceleration_track = std::make_shared<std::vector<StampedAcceleration>>();
  for (const auto& row : read_rows(folder, "accelerometer.txt", 4, facts))
    facts.acceleration_track->push_back({row[0], {row[1], row[2], row[3]}});

  facts.read_depth = [depth](std::size_t frame, double unit_m, DepthImage& depth_m) {
    read_depth_file((*depth)[frame].file, DepthEncoding::kTum, unit_m, depth_m);
  };
  facts.read_colour = [colours](std::size_t colour, ColourImage& image) {
    read_colour_file((*colours)[colour].file, image);
  };
  if (!facts.pose_track->empty())
    facts.read_pose = [track = facts.pose_track](std::size_t, double stamp_s) {
      return StatedPose{pose_at(*track, stamp_s, kLongestPoseGap_s)};
    };
  if (!facts.acceleration_track->empty()) {
    facts.gravity_source = "accelerometer.txt";
    facts.read_down = [track = facts.acceleration_track](std::size_t, double stamp_s) {
      return gravity_near(stamp_s, *track);
    };
  }
  return facts;
}

}  // namespace roomradar
