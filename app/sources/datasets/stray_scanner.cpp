// stray_scanner.cpp: comma-separated lists, numbered images and a video.
#include "app/sources/datasets/dataset_readers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "app/sources/datasets/arkit_axes.hpp"
#include "app/sources/datasets/numbered_files.hpp"
#include "app/sources/datasets/text_lists.hpp"
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

/// Calls use(numbers) per line with at least `count` numbers. A first line without numbers is a heading.
/// @return the number of other lines, such as one that was being written when the app ended
template <typename Use>
std::size_t for_each_row(const fs::path& path, std::size_t count, const Use& use) {
  std::size_t bad = 0;
  bool is_at_first = true;
  for_each_line(path, [&](std::string_view line, const std::string& /*where*/) {
    std::string text(line);
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
    std::vector<double> numbers;
    const auto words = split_words(text);
    for (const std::string_view word : words) {
      const auto number = parse_number(word);
      if (!number) break;
      numbers.push_back(*number);
    }
    const bool is_heading = std::exchange(is_at_first, false) && numbers.empty();
    if (numbers.size() == words.size() && numbers.size() >= count)
      use(numbers);
    else if (!is_heading)
      ++bad;
  });
  return bad;
}

/// Reads the 3 x 3 matrix of the video. Without a video, its size is assumed to be the app's 1920 x 1440, or
/// of the aspect ratio of depth and twice as wide as the principal point's x, if that is far from 960.
Intrinsics camera_matrix_of(const fs::path& path, std::optional<ImageSize> video, ImageSize depth) {
  std::vector<double> m;
  (void)for_each_row(
      path, 3, [&](const std::vector<double>& row) { m.insert(m.end(), row.begin(), row.begin() + 3); });
  if (m.size() != 9) throw Error(path.string() + ": must be a 3 x 3 matrix");
  constexpr ImageSize kUsual{1920, 1440};
  const int twice_px = static_cast<int>(std::lround(2.0 * std::clamp(m[2], 1.0, 8000.0)));
  const ImageSize size = video ? *video
                         : std::abs(twice_px - kUsual.width_px) < 200
                             ? kUsual
                             : ImageSize{twice_px, twice_px * depth.height_px / depth.width_px};
  const Intrinsics camera{size.width_px, size.height_px, m[0], m[4], m[2], m[5]};
  require_valid(camera, path.string().c_str());
  return camera;
}

struct Odometry {
  double stamp_s = 0.0;
  std::optional<Eigen::Isometry3d> T_world_camera;
};

/// Returns the rows of odometry.csv by frame.
/// @param[out] bad  number of lines that are not a row
std::map<std::int64_t, Odometry> odometry_of(const fs::path& path, std::size_t& bad) {
  constexpr double kMostFrames = 1e9;
  std::map<std::int64_t, Odometry> rows;
  bad = for_each_row(path, 9, [&](const std::vector<double>& row) {
    if (!(row[1] >= 0 && row[1] < kMostFrames && row[1] == std::floor(row[1]))) return;
    rows[static_cast<std::int64_t>(row[1])] = {
        row[0], rigid_pose({row[2], row[3], row[4]}, {row[5], row[6], row[7], row[8]})};
  });
  return rows;
}

/// Returns odometry_of() the folder's file, and notes lines that are not rows; empty without the file.
std::map<std::int64_t, Odometry> read_odometry(const fs::path& folder, RecordingFacts& facts) {
  const fs::path path = folder / "odometry.csv";
  if (!fs::exists(path)) {
    facts.notes.push_back(
        {"poses", "odometry.csv is missing; depth is used without times and poses", 0, "", true});
    return {};
  }
  std::size_t bad_lines = 0;
  std::map<std::int64_t, Odometry> odometry = odometry_of(path, bad_lines);
  if (bad_lines > 0)
    facts.notes.push_back(
        {"poses",
         std::to_string(bad_lines) + " lines of odometry.csv are cut short or not numbers; they are left out",
         static_cast<std::int64_t>(bad_lines), "", odometry.empty()});
  return odometry;
}

/// Returns the video of colour images; null, with a note, if it is missing or cannot be read.
std::shared_ptr<VideoFile> open_video(const fs::path& folder, RecordingFacts& facts) {
  try {
    return std::make_shared<VideoFile>(folder / "rgb.mp4");
  } catch (const Error& fault) {
    const bool is_missing = !fs::exists(folder / "rgb.mp4");
    facts.notes.push_back(
        {"images",
         is_missing ? "rgb.mp4 is missing; depth is used without colour"
                    : "rgb.mp4 cannot be read, depth is used without colour: " + std::string(fault.what()),
         0, "", !is_missing});
    return nullptr;
  }
}

/// Files of the frames, in the order of RecordingFacts::frames.
struct StrayFrames {
  std::vector<fs::path> depth{};
  std::vector<std::size_t> numbers{};  ///< images of the video
};

/// Adds a frame per depth image, with its line of odometry.csv, and notes where one of these is missing.
StrayFrames add_frames(const fs::path& folder, bool has_video, RecordingFacts& facts) {
  const std::map<std::int64_t, Odometry> odometry = read_odometry(folder, facts);
  StrayFrames files;
  std::size_t without_row = 0;
  for (const auto& [number, path] : numbered_files(folder / "depth", {".png"})) {
    StatedFrame frame;
    if (has_video) frame.colour = files.numbers.size();
    if (const auto row = odometry.find(number); row != odometry.end()) {
      frame.time.stamp_s = row->second.stamp_s;
      frame.T_world_camera = row->second.T_world_camera;
      if (!frame.T_world_camera) frame.pose_fault = "is no rigid transform";
    } else {
      ++without_row;
    }
    facts.frames.push_back(std::move(frame));
    files.depth.push_back(path);
    files.numbers.push_back(static_cast<std::size_t>(number));
  }
  if (without_row > 0 && !odometry.empty())
    facts.notes.push_back({"poses",
                           std::to_string(without_row) +
                               " depth images have no line in odometry.csv; they are used "
                               "without a pose",
                           static_cast<std::int64_t>(without_row)});
  if (const std::size_t with_row = files.depth.size() - without_row; with_row < odometry.size())
    facts.notes.push_back({"images",
                           std::to_string(odometry.size() - with_row) + " of " +
                               std::to_string(odometry.size()) +
                               " frames of odometry.csv have no depth image; they are left out",
                           static_cast<std::int64_t>(odometry.size() - with_row)});
  return files;
}

/// Sets the cameras: as camera_matrix.csv states, else an iPhone's.
void set_cameras(const fs::path& folder, const VideoFile* video, ImageSize depth_size,
                 RecordingFacts& facts) {
  std::optional<ImageSize> video_size;
  if (video) video_size = ImageSize{video->width_px(), video->height_px()};
  const fs::path matrix = folder / "camera_matrix.csv";
  const bool is_camera_stated = fs::exists(matrix);
  const Intrinsics colour = is_camera_stated ? camera_matrix_of(matrix, video_size, depth_size)
                                             : phone_camera(video_size.value_or(depth_size));
  facts.camera_source = "camera_matrix.csv";
  if (!is_camera_stated) {
    facts.camera_origin = Origin::kAssumed;
    facts.camera_source = "an iPhone";
  }
  if (video) facts.rig.colour_camera = colour;
  facts.rig.depth_camera = scaled_to_depth(colour, depth_size, folder.string());
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
  return (fs::is_regular_file(folder / "odometry.csv", ignored) ||
          fs::is_regular_file(folder / "camera_matrix.csv", ignored)) &&
         fs::is_directory(folder / "depth", ignored);
}

RecordingFacts index_stray_scanner(const fs::path& folder) {
  RecordingFacts facts{.name = fs::canonical(folder).string()};
  const std::shared_ptr<VideoFile> video = open_video(folder, facts);
  facts.rig.depth_noise = kPhoneLidarNoise;
  facts.is_depth_registered = true;
  facts.unit_source = "millimetres, by Stray Scanner's format";
  facts.stamps_have_no_unit = true;
  facts.has_quaternions = true;
  set_arkit_axes(facts, /*camera_is_opengl=*/false);

  const auto [paths, numbers] = add_frames(folder, video != nullptr, facts);
  set_cameras(folder, video.get(), size_of_images(paths, folder), facts);
  facts.read_depth = [paths = paths](std::size_t frame, double unit_m, DepthImage& depth_m) {
    read_depth_file(paths[frame], DepthEncoding::kMillimetres, unit_m, depth_m);
  };
  facts.remove_unsure = [paths = paths, folder](std::size_t frame, DepthImage& depth_m) {
    const fs::path confidence_path = folder / "confidence" / paths[frame].filename();
    if (!fs::exists(confidence_path)) return;
    Image<std::uint8_t> confidence;
    const std::string name = confidence_path.string();
    decode_grey_png(read_bytes(confidence_path, "an image"), name, confidence);
    remove_unsure(confidence, name, depth_m);
  };
  facts.read_colour = [video, numbers = numbers](std::size_t frame, ColourImage& image) {
    video->read(numbers[frame], image);
  };
  return facts;
}

}  // namespace roomradar
