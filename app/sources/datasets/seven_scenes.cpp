// seven_scenes.cpp: lists frame-XXXXXX.* and reads pose files.
#include "app/sources/datasets/dataset_readers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "app/sources/datasets/numbered_files.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "app/sources/formats/parse_numbers.hpp"
#include "app/sources/formats/time_tracks.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/folders.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxPose_bytes = 1U << 16U;

/// What a file _info.txt states.
struct SequenceInfo {
  Intrinsics depth_camera{};
  std::optional<Intrinsics> colour_camera{};  ///< unset: the file states a size of 0
  Eigen::Isometry3d T_colour_depth = Eigen::Isometry3d::Identity();
  double units_per_m = 1000.0;
};

/// Returns _info.txt or info.txt; empty if there is neither.
fs::path info_file(const fs::path& folder) {
  std::error_code ignored;
  for (const char* name : {"_info.txt", "info.txt"})
    if (fs::is_regular_file(folder / name, ignored)) return folder / name;
  return {};
}

/// Reads lines "name = numbers". Throws Error naming the file and the field that is missing or invalid.
SequenceInfo read_info(const fs::path& path) {
  constexpr std::uintmax_t kMaxInfo_bytes = 1U << 16U;
  const std::string where = path.string();
  std::map<std::string, std::vector<double>> fields;
  std::istringstream lines(read_bytes(path, "a description of cameras", kMaxInfo_bytes));
  for (std::string line; std::getline(lines, line);) {
    const auto words = split_words(line);
    if (words.size() < 3 || words[1] != "=") continue;
    std::vector<double>& numbers = fields[std::string(words[0])];
    for (std::size_t i = 2; i < words.size(); ++i)
      if (const auto number = parse_number(words[i])) numbers.push_back(*number);
  }
  const auto field = [&](const char* name, std::size_t count) {
    const std::vector<double>& numbers = fields[name];
    if (numbers.size() != count)
      throw Error(where + ": " + name + " must be " + std::to_string(count) +
                  (count == 1 ? " number" : " numbers") + ", but has " + std::to_string(numbers.size()));
    return numbers;
  };
  const auto camera = [&](const std::string& width, const std::string& height, const char* intrinsic) {
    const auto m = field(intrinsic, 16);
    const double width_px = field(width.c_str(), 1)[0], height_px = field(height.c_str(), 1)[0];
    if (!(width_px >= 1 && width_px <= 16384 && height_px >= 1 && height_px <= 16384))
      throw Error(where + ": " + width + " and " + height + " must be in 1..16384");
    const Intrinsics result{static_cast<int>(width_px), static_cast<int>(height_px), m[0], m[5], m[2], m[6]};
    require_valid(result, (where + ", " + intrinsic).c_str());
    return result;
  };
  const auto pose = [&](const char* extrinsic) {
    const auto m = field(extrinsic, 16);
    return rigid_transform(
        Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(m.data()).topRows<3>());
  };
  SequenceInfo info;
  info.depth_camera = camera("m_depthWidth", "m_depthHeight", "m_calibrationDepthIntrinsic");
  if (field("m_colorWidth", 1)[0] > 0)
    info.colour_camera = camera("m_colorWidth", "m_colorHeight", "m_calibrationColorIntrinsic");
  const auto T_device_colour = pose("m_calibrationColorExtrinsic"),
             T_device_depth = pose("m_calibrationDepthExtrinsic");
  if (T_device_colour && T_device_depth) info.T_colour_depth = T_device_colour->inverse() * *T_device_depth;
  info.units_per_m = field("m_depthShift", 1)[0];
  if (!(info.units_per_m > 0.0 && info.units_per_m <= 1e7))
    throw Error(where + ": m_depthShift must be above 0, such as 1000 for millimetres");
  return info;
}

/// Returns the stated camera, scaled to images of another size. Throws Error naming `where` if its aspect
/// ratio is not theirs.
Intrinsics fitted_to_images(const Intrinsics& camera, ImageSize images, const std::string& where) {
  const Intrinsics fitted = scaled(camera, static_cast<double>(images.width_px) / camera.width_px);
  if (std::abs(fitted.height_px - images.height_px) <= 1) {
    Intrinsics result = fitted;
    result.width_px = images.width_px;
    result.height_px = images.height_px;
    return result;
  }
  throw Error(where + ": states images of " + size_text(camera.width_px, camera.height_px) +
              ", but they are " + size_text(images.width_px, images.height_px));
}

/// Files of one frame; paths are strings, which take less memory. Empty: there is none.
struct FrameFiles {
  std::string depth, colour, pose;
};

const std::regex& seven_scenes_name() {
  static const std::regex pattern(
      R"(frame-(\d{1,9})\.(depth\.png|depth\.pgm|color\.png|color\.jpe?g|color\.none|pose\.txt))",
      std::regex::ECMAScript | std::regex::icase);
  return pattern;
}

std::vector<fs::path> as_paths(const std::vector<std::string>& files) { return {files.begin(), files.end()}; }

/// Returns the files of a folder by the number of their frame.
std::map<std::int64_t, FrameFiles> frame_files(const fs::path& folder) {
  std::map<std::int64_t, FrameFiles> by_number;
  for (const fs::path& file :
       entries_of(folder)) {  // sorted: of a jpg and a png, the same is chosen everywhere
    const std::string name = file.filename().string();
    std::smatch match;
    if (!std::regex_match(name, match, seven_scenes_name())) continue;
    FrameFiles& frame = by_number[std::stoll(match[1])];
    const std::string kind = match[2];
    std::string& slot = kind.starts_with("depth")   ? frame.depth
                        : kind.starts_with("color") ? frame.colour
                                                    : frame.pose;
    if (slot.empty()) slot = file.string();
  }
  return by_number;
}

bool has_colour_file(const FrameFiles& frame) {
  return !frame.colour.empty() && !frame.colour.ends_with(".none");
}

/// Notes how many frames lack a file, if it is not all of them. Returns this number.
std::int64_t note_missing(const std::map<std::int64_t, FrameFiles>& by_number, std::string FrameFiles::*file,
                          const char* topic, const char* what, RecordingFacts& facts) {
  const auto is_missing = [&](const auto& entry) { return (entry.second.*file).empty(); };
  const auto missing =
      static_cast<std::int64_t>(std::count_if(by_number.begin(), by_number.end(), is_missing));
  const auto count = static_cast<std::int64_t>(by_number.size());
  if (missing > 0 && missing < count) {
    const std::int64_t first = std::find_if(by_number.begin(), by_number.end(), is_missing)->first;
    facts.notes.push_back({topic,
                           "the " + std::string(what) + " of " + std::to_string(missing) + " of " +
                               std::to_string(count) + " frames is missing, the first: number " +
                               std::to_string(first) + "; these frames are used without",
                           missing});
  }
  return missing;
}

/// Sets the cameras and the depth unit that the description in `file` states.
void set_stated_cameras(const fs::path& file, ImageSize depth, std::optional<ImageSize> colour,
                        RecordingFacts& facts) {
  const SequenceInfo info = read_info(file);
  facts.rig.depth_camera = fitted_to_images(info.depth_camera, depth, file.string());
  facts.rig.colour_camera.reset();
  if (colour)
    facts.rig.colour_camera = info.colour_camera
                                  ? fitted_to_images(*info.colour_camera, *colour, file.string())
                                  : fitted_to(facts.rig.depth_camera, *colour);
  facts.rig.T_colour_depth = info.T_colour_depth;
  facts.camera_origin = Origin::kRecording;
  facts.camera_source = file.filename().string();
  facts.depth_unit_m = 1.0 / info.units_per_m;
  facts.unit_origin = Origin::kRecording;
  facts.unit_source = "m_depthShift in " + file.filename().string();
}

}  // namespace

bool is_seven_scenes(const fs::path& folder) {
  std::error_code ignored;
  const std::vector<fs::path> entries = entries_of(folder, ignored);
  return std::any_of(entries.begin(), entries.end(), [](const fs::path& file) {
    return std::regex_match(file.filename().string(), seven_scenes_name());
  });
}

RecordingFacts index_seven_scenes(const fs::path& folder) {
  const std::map<std::int64_t, FrameFiles> by_number = frame_files(folder);
  RecordingFacts facts{.name = fs::canonical(folder).string(), .has_no_clock = true};
  facts.is_written_by_many = true;
  const auto files = std::make_shared<std::vector<FrameFiles>>();
  std::vector<std::string> depths, colours;
  for (const auto& [number, frame] : by_number) {
    StatedFrame stated{.time = {.stamp_s = static_cast<double>(number) / kNominalRate_hz}};
    if (frame.depth.empty())
      stated.fault =
          folder.string() + ": the depth image of number " + std::to_string(number) + " is missing";
    else
      depths.push_back(frame.depth);
    if (has_colour_file(frame)) {
      stated.colour = files->size();
      colours.push_back(frame.colour);
    }
    facts.frames.push_back(std::move(stated));
    files->push_back(frame);
  }
  note_missing(by_number, &FrameFiles::colour, "images", "colour image", facts);
  const std::int64_t without_pose = note_missing(by_number, &FrameFiles::pose, "poses", "pose", facts);
  if (depths.empty()) throw Error(facts.name + ": contains no depth images");

  const ImageSize size = size_of_images(as_paths(depths), folder);
  const std::optional<ImageSize> colour_size = size_of_colours(as_paths(colours), folder, facts);
  facts.rig = nominal_rig(NominalRig::kSevenScenes, size, colour_size);
  facts.camera_origin = Origin::kAssumed;
  facts.camera_source = nominal_name(NominalRig::kSevenScenes);
  facts.depth_unit_m = depth_unit_m(DepthEncoding::kMillimetres);
  facts.unit_source = "millimetres, by the 7-Scenes format";
  if (const fs::path file = info_file(folder); !file.empty())
    set_stated_cameras(file, size, colour_size, facts);
  facts.read_depth = [files](std::size_t frame, double unit_m, DepthImage& depth_m) {
    read_depth_file((*files)[frame].depth, DepthEncoding::kMillimetres, unit_m, depth_m);
  };
  facts.read_colour = [files](std::size_t frame, ColourImage& image) {
    read_colour_file((*files)[frame].colour, image);
  };
  if (without_pose < std::ssize(*files))
    facts.read_pose = [files](std::size_t frame, double) {
      const std::string& file = (*files)[frame].pose;
      return file.empty() ? StatedPose{} : read_pose_file(file);
    };
  return facts;
}

StatedPose read_pose_file(const fs::path& path) {
  const std::string name = path.string();
  std::vector<double> m;
  try {
    std::string text = read_bytes(path, "a 4 x 4 pose", kMaxPose_bytes);
    for (char& c : text)  // as NumPy and spreadsheets write matrices
      if (c == ',' || c == ';' || c == '[' || c == ']') c = ' ';
    m = parse_numbers(text, name);
  } catch (const Error& fault) {
    return {{}, fault.what()};
  }
  if (m.size() > 16) return {{}, name + ": has more than 16 numbers; must be a 4 x 4 pose"};
  if (m.size() == 12) m.insert(m.end(), {0.0, 0.0, 0.0, 1.0});
  if (m.size() != 16)
    return {{},
            name + ": has " + std::to_string(m.size()) + " numbers; must be a 4 x 4 pose; is it cut short?"};
  Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(m.data());
  const Eigen::RowVector4d last(0, 0, 0, 1);
  const auto ends_as_pose = [&](const Eigen::RowVector4d& row) { return row.isApprox(last, 1e-6); };
  const bool is_transposed =
      matrix.allFinite() && !ends_as_pose(matrix.row(3)) && ends_as_pose(matrix.col(3).transpose());
  if (is_transposed) matrix.transposeInPlace();
  const auto T =
      matrix.allFinite() && ends_as_pose(matrix.row(3)) ? rigid_transform(matrix.topRows<3>()) : std::nullopt;
  if (!T) return {{}, name + ": is not a rigid pose: a rotation, a shift in metres, and 0 0 0 1 below"};
  return {T, {}, is_transposed};
}

}  // namespace roomradar
