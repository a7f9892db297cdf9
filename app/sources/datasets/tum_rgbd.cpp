// tum_rgbd.cpp: reads lists of images, poses and accelerations, each with stamps.
#include "app/sources/datasets/dataset_readers.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/sources/datasets/numbered_files.hpp"
#include "app/sources/datasets/text_lists.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/kinect_units.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "app/sources/formats/parse_numbers.hpp"
#include "app/sources/formats/time_tracks.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/folders.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr double kLongestPoseGap_s = 0.050;  // a hand-held camera's path is not straight for longer
constexpr double kReadingWithin_s = 0.050;

struct ListedImage {
  double stamp = kNoStamp;
  std::string file;
};

/// A line of a list of images, cut into stamp and name. Both may be empty.
struct ListLine {
  std::string stamp, name;
};

/// Cuts a line "stamp name", also with a comma or semicolon between, a decimal comma, or a name in quotes.
ListLine cut(std::string_view line) {
  const std::size_t blank = std::min(line.find_first_of(" \t\r"), line.size());
  std::size_t stamp_end = blank;
  std::string stamp(line.substr(0, blank));
  if (const std::size_t mark = stamp.find_first_of(",;"); mark != std::string::npos) {
    const auto fraction = std::string_view(stamp).substr(mark + 1);
    if (!fraction.empty() && fraction.find_first_not_of("0123456789") == std::string_view::npos)
      stamp[mark] = '.';
    else
      stamp_end = mark, stamp.resize(mark);
  }
  const std::size_t begin = std::min(line.find_first_not_of(" \t,;", stamp_end), line.size());
  std::string_view name = line.substr(begin, line.find_last_not_of(" \t\r") + 1 - begin);
  if (name.size() > 2 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
  return {std::move(stamp), std::string(name)};
}

/// Returns how the names of a list that was written on another machine become files in the folder: a function
/// under which a name that is spread over the list exists, and what it does; null if there is none.
std::pair<fs::path (*)(const fs::path& name), const char*> repair_of_names(const fs::path& folder,
                                                                           const std::vector<std::string>& names) {
  using Repair = fs::path (*)(const fs::path&);
  const std::array<std::pair<Repair, const char*>, 4> repairs = {
      std::pair<Repair, const char*>{
          [](const fs::path& name) { return name.parent_path().filename() / name.filename(); },
          "only their last two parts are used"},
      {[](const fs::path& name) { return fs::path("depth") / name.filename(); }, "they are looked for in depth"},
      {[](const fs::path& name) { return fs::path("rgb") / name.filename(); }, "they are looked for in rgb"},
      {[](const fs::path& name) { return fs::path(name).replace_extension(name.extension() == ".png" ? ".jpg" : ".png"); },
       "their endings are .jpg instead of .png, or the reverse"}};
  constexpr std::size_t kTried = 5;
  std::error_code ignored;
  const auto exist = [&](const auto& repair) {
    for (std::size_t k = 0; k < kTried && !names.empty(); ++k)
      if (const fs::path file = repair(names[k * names.size() / kTried]); fs::exists(folder / file, ignored)) return true;
    return false;
  };
  const auto is_inside = [](const fs::path& name) {
    return name.is_absolute() || (!name.empty() && *name.begin() == "..") ? fs::path("/") : name;
  };
  if (exist([&](const fs::path& name) { return is_inside(name) == "/" ? fs::path("?") : name; })) return {};
  for (const auto& [repair, what] : repairs)
    if (exist(repair)) return {repair, what};
  return {};
}

/// A line of a list of images, and where it is, for messages.
struct LocatedLine {
  ListLine cut;
  std::string where;
};

/// Reads the lines of rgb.txt or depth.txt, without a heading. Names with backslashes get slashes.
std::vector<LocatedLine> read_list_lines(const fs::path& folder, const char* name) {
  std::vector<LocatedLine> lines;
  bool is_at_first = true;
  for_each_line(folder / name, [&](std::string_view text, const std::string& where) {
    lines.push_back({cut(text), where});
    std::string& file = lines.back().cut.name;
    std::error_code ignored;
    if (file.find('\\') != std::string::npos && !fs::exists(folder / file, ignored))
      std::replace(file.begin(), file.end(), '\\', '/');
    const std::string& stamp = lines[0].cut.stamp;
    const bool is_heading = std::exchange(is_at_first, false) && !parse_number(stamp) &&
                            !fs::exists(folder / file, ignored) && !stamp.empty() &&
                            std::isalpha(static_cast<unsigned char>(stamp[0]));
    if (is_heading) lines.clear();
  });
  return lines;
}

/// Reads the images of rgb.txt or depth.txt. A stamp that is not a number is unknown.
std::vector<ListedImage> read_image_list(const fs::path& folder, const char* name, RecordingFacts& facts) {
  const std::vector<LocatedLine> lines = read_list_lines(folder, name);
  std::vector<std::string> names;
  for (const LocatedLine& line : lines) names.push_back(line.cut.name);
  const auto [repair, what_is_repaired] = repair_of_names(folder, names);
  if (repair)
    facts.notes.push_back({"images",
                           std::string("the names in ") + name + " are of no files in the folder; " + what_is_repaired,
                           static_cast<std::int64_t>(names.size())});

  std::vector<ListedImage> images;
  BadLines bad, bad_stamps;
  std::set<std::pair<std::string, std::string>> known;
  std::int64_t repeated = 0;
  for (const auto& [line, where] : lines) {
    const fs::path stated = fs::path(line.name).lexically_normal();
    const fs::path file = repair ? repair(stated) : stated;
    if (file.empty() || file == ".") {
      bad.add(where + ": must be a stamp and a file name");
      continue;
    }
    if (file.is_absolute() || *file.begin() == "..") {
      bad.add(where + ": the file must lie in the recording's folder");
      continue;
    }
    if (!known.emplace(line.stamp, line.name).second) {
      ++repeated;
      continue;
    }
    const auto stamp = parse_number(line.stamp);
    if (!stamp || !std::isfinite(*stamp))
      bad_stamps.add(where + ": '" + line.stamp.substr(0, 40) + "' is not a number");
    images.push_back({stamp && std::isfinite(*stamp) ? *stamp : kNoStamp, (folder / file).string()});
  }
  bad.report("images", name, facts);
  if (repeated > 0)
    facts.notes.push_back({"images",
                           std::to_string(repeated) + (repeated == 1 ? " line of " : " lines of ") + name +
                               (repeated == 1 ? " repeats another one; it is used once"
                                              : " repeat others; each is used once"),
                           repeated});
  if (bad_stamps.count > 0)
    facts.notes.push_back({"time",
                           std::to_string(bad_stamps.count) + " stamps of " + name +
                               " are no numbers, the first: " + bad_stamps.first,
                           static_cast<std::int64_t>(bad_stamps.count)});
  return images;
}

/// Returns the number that the file's name is, as in 1305031229.528784.png; nullopt unless it has a fraction.
std::optional<double> stamp_in_name(const fs::path& file) {
  const std::string stem = file.stem().string();
  if (stem.find('.') == std::string::npos || stem.find_first_not_of("0123456789.") != std::string::npos)
    return std::nullopt;
  return parse_number(stem);
}

/// Returns the images of a folder whose names are their stamps.
std::vector<ListedImage> images_named_by_stamps(const fs::path& folder) {
  std::vector<ListedImage> images;
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) return images;
  for (const fs::path& file : entries_of(folder))
    if (const auto stamp = stamp_in_name(file)) images.push_back({*stamp, file.string()});
  return images;
}

/// True if depth images are named by stamps, as in recordings of TUM's form without their lists.
bool has_stamped_depth(const fs::path& folder) {
  std::error_code fault;
  if (!fs::is_directory(folder / "rgb", fault) && !fs::exists(folder / "groundtruth.txt", fault)) return false;
  for (fs::directory_iterator each(folder / "depth", fault), end; !fault && each != end; each.increment(fault))
    if (!is_hidden_file(each->path().filename().string())) return stamp_in_name(each->path()).has_value();
  return false;
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
  if (nearest == readings.end() || std::abs(nearest->stamp_s - stamp_s) > kReadingWithin_s)
    return std::nullopt;
  return down_from_acceleration(nearest->acceleration_m_s2 / kStandardGravity_m_s2);
}

std::vector<fs::path> files_of(const std::vector<ListedImage>& images) {
  std::vector<fs::path> files;
  for (const ListedImage& image : images) files.emplace_back(image.file);
  return files;
}

using ListedImages = std::shared_ptr<const std::vector<ListedImage>>;

/// Returns the images of a list; without the list, those of the folder, whose names are their stamps.
ListedImages images_of(const fs::path& folder, const char* list, bool is_listed, const char* images,
                       RecordingFacts& facts) {
  return std::make_shared<const std::vector<ListedImage>>(
      is_listed ? read_image_list(folder, list, facts) : images_named_by_stamps(folder / images));
}

void note_missing_list(const char* list, bool is_listed, const ListedImages& images, RecordingFacts& facts) {
  if (!is_listed && !images->empty())
    facts.notes.push_back(
        {"time", std::string(list) + " is missing; the names of the images are taken as their stamps",
         static_cast<std::int64_t>(images->size())});
}

/// Reads groundtruth.txt and accelerometer.txt, and looks poses and gravity up in them.
void read_tracks(const fs::path& folder, const std::vector<ListedImage>& depth, RecordingFacts& facts) {
  facts.pose_track = std::make_shared<std::vector<StampedPose>>();
  const ListedPoses listed = read_pose_list(folder / "groundtruth.txt", std::ssize(depth), facts);
  for (std::size_t i = 0; i < listed.poses.size(); ++i)
    if (listed.poses[i].T_world_camera)
      facts.pose_track->push_back(
          {listed.are_stamped ? listed.poses[i].stamp : depth[i].stamp, *listed.poses[i].T_world_camera});
    else
      ++facts.lost_track_poses;
  facts.acceleration_track = std::make_shared<std::vector<StampedAcceleration>>();
  for (const auto& row : read_rows(folder / "accelerometer.txt", "gravity", {4}, facts))
    facts.acceleration_track->push_back({row[0], {row[1], row[2], row[3]}});
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
}

}  // namespace

bool is_tum_rgbd(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / "depth.txt", ignored) || fs::exists(folder / "rgb.txt", ignored) ||
         has_stamped_depth(folder);
}

RecordingFacts index_tum_rgbd(const fs::path& folder) {
  // Without lists, the names of the images are their stamps.
  const bool is_depth_listed = fs::exists(folder / "depth.txt"), is_colour_listed = fs::exists(folder / "rgb.txt");
  if (!is_depth_listed && !has_stamped_depth(folder))
    throw Error((folder / "depth.txt").string() + ": is missing beside rgb.txt");
  RecordingFacts facts{.name = fs::canonical(folder).string(), .stamps_have_no_unit = true};
  facts.is_written_by_many = true;
  const ListedImages depth = images_of(folder, "depth.txt", is_depth_listed, "depth", facts);
  const ListedImages colours = images_of(folder, "rgb.txt", is_colour_listed, "rgb", facts);
  if (!is_colour_listed && colours->empty() && fs::is_directory(folder / "rgb"))
    throw Error((folder / "rgb.txt").string() +
                ": is missing, although there is a folder rgb; it lists the colour images");
  note_missing_list("depth.txt", is_depth_listed, depth, facts);
  note_missing_list("rgb.txt", is_colour_listed, colours, facts);
  for (const ListedImage& image : *depth) facts.frames.push_back({.time = {.stamp_s = image.stamp}});
  for (const ListedImage& image : *colours) facts.colours.push_back({.stamp_s = image.stamp});
  // A recording by RecordingWriter keeps the pairs made from a device.
  if (!fs::exists(folder / "camera.json")) facts.pair_within_s = PairingConfig{}.tolerance_s;
  if (depth->empty()) return facts;

  const bool is_bonn = fs::weakly_canonical(folder).filename().string().starts_with("rgbd_bonn_");
  const NominalRig nominal = is_bonn ? NominalRig::kBonn : NominalRig::kTum;
  const ImageSize size = size_of_images(files_of(*depth), folder);
  const std::optional<ImageSize> colour_size = size_of_colours(files_of(*colours), folder, facts);
  facts.rig = nominal_rig(nominal, size, colour_size);
  facts.camera_origin = Origin::kAssumed;
  facts.camera_source = nominal_name(nominal);
  facts.is_depth_registered = true;
  facts.is_registered_if_given = true;
  facts.depth_unit_m = depth_unit_m(DepthEncoding::kTum);
  facts.unit_source = "1/5000 m, by the TUM RGB-D format";

  read_tracks(folder, *depth, facts);
  facts.read_depth = [depth](std::size_t frame, double unit_m, DepthImage& depth_m) {
    read_depth_file((*depth)[frame].file, DepthEncoding::kTum, unit_m, depth_m);
  };
  facts.read_colour = [colours](std::size_t colour, ColourImage& image) {
    read_colour_file((*colours)[colour].file, image);
  };
  return facts;
}

}  // namespace roomradar
