// recording_index.cpp: recognises recording formats, and lists the frames of those with numbered files.
#include "app/sources/recordings/recording_index.hpp"

#include <algorithm>
#include <map>
#include <regex>
#include <sstream>
#include <string>

#include "app/sources/formats/parse_numbers.hpp"
#include "app/sources/recordings/recording_index_fakenect.hpp"
#include "app/sources/recordings/recording_index_tum.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestPose_bytes = 1U << 16U;
constexpr double kNominalRate_hz = 30.0;  // for recordings without stamps

struct NumberedFiles {
  fs::path depth, colour, pose;
};
using FilesByNumber = std::map<std::int64_t, NumberedFiles>;

const std::regex& seven_scenes_name() {
  static const std::regex pattern(
      R"(frame-(\d{1,9})\.(depth\.png|color\.png|color\.jpe?g|color\.none|pose\.txt))");
  return pattern;
}

/// Lists files in sorted order, so if an image exists twice (jpg and png), the same file is chosen
/// everywhere.
std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

bool holds_seven_scenes(const fs::path& folder) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (std::regex_match(entry.path().filename().string(), seven_scenes_name())) return true;
  return false;
}

/// Lists frames in the order of their numbers. A frame without colour or pose is bad if others have them; a
/// file .none marks a frame recorded without colour.
std::vector<RecordedFrame> frames_of(const FilesByNumber& files, const fs::path& folder) {
  bool any_colour = false, any_pose = false;
  for (const auto& [number, file] : files) {
    any_colour |= !file.colour.empty();
    any_pose |= !file.pose.empty();
  }
  std::vector<RecordedFrame> frames;
  frames.reserve(files.size());
  for (const auto& [number, file] : files) {
    RecordedFrame frame{.stamp_s = static_cast<double>(number) / kNominalRate_hz,
                        .depth_file = file.depth.string(),
                        .colour_file = file.colour.extension() == ".none" ? "" : file.colour.string(),
                        .pose_file = file.pose.string()};
    const char* missing = file.depth.empty()                  ? "depth image"
                          : any_colour && file.colour.empty() ? "colour image"
                          : any_pose && file.pose.empty()     ? "pose"
                                                              : nullptr;
    if (missing)
      frame.fault =
          folder.string() + ": the " + missing + " of number " + std::to_string(number) + " is missing";
    frames.push_back(std::move(frame));
  }
  return frames;
}

fs::path colour_folder(const fs::path& folder) {
  for (const char* name : {"color", "colour", "rgb"})
    if (fs::is_directory(folder / name)) return folder / name;
  return {};
}

/// Adds the files in `folder` whose name is a number with one of the extensions.
void add_numbered(const fs::path& folder, std::initializer_list<std::string_view> extensions,
                  fs::path NumberedFiles::*which, FilesByNumber& files) {
  for (const fs::path& file : files_in(folder)) {
    const auto number = parse_whole_number(file.stem().string());
    const bool is_wanted =
        std::find(extensions.begin(), extensions.end(), file.extension().string()) != extensions.end();
    if (!is_wanted || !number || *number < 0) continue;
    fs::path& slot = files[*number].*which;
    if (slot.empty()) slot = file;
  }
}

}  // namespace

RecordingIndex index_seven_scenes(const fs::path& folder) {
  FilesByNumber files;
  for (const fs::path& file : files_in(folder)) {
    const std::string name = file.filename().string();
    std::smatch match;
    if (!std::regex_match(name, match, seven_scenes_name())) continue;
    NumberedFiles& frame = files[std::stoll(match[1])];
    const std::string kind = match[2];
    fs::path& slot = kind.starts_with("depth")   ? frame.depth
                     : kind.starts_with("color") ? frame.colour
                                                 : frame.pose;
    if (slot.empty()) slot = file;
  }
  return {DepthEncoding::kMillimetres, NominalRig::kSevenScenes, frames_of(files, folder)};
}

RecordingIndex index_numbered(const fs::path& folder) {
  FilesByNumber files;
  add_numbered(folder / "depth", {".png"}, &NumberedFiles::depth, files);
  if (const fs::path colour = colour_folder(folder); !colour.empty())
    add_numbered(colour, {".jpg", ".jpeg", ".png"}, &NumberedFiles::colour, files);
  return {DepthEncoding::kMillimetres, NominalRig::kNumbered, frames_of(files, folder)};
}

RecordingIndex index_recording(const fs::path& folder) {
  const std::string name = folder.string();
  std::error_code fault;
  if (!fs::exists(folder, fault)) throw Error(name + ": there is no such folder");
  if (!fs::is_directory(folder, fault))
    throw Error(name +
                ": is neither a folder nor a recording file of a known format; `roomradar help sources` "
                "lists the formats");
  try {
    if (fs::is_empty(folder)) throw Error(name + ": the folder is empty");
    RecordingIndex index;
    if (fs::exists(folder / "INDEX.txt"))
      index = index_fakenect(folder);
    else if (fs::exists(folder / "depth.txt") || fs::exists(folder / "rgb.txt"))
      index = index_tum(folder);
    else if (holds_seven_scenes(folder))
      index = index_seven_scenes(folder);
    else if (fs::is_directory(folder / "depth"))
      index = index_numbered(folder);
    else if (fs::exists(folder / "map.json"))
      throw Error(name + ": is a saved map, not a recording; give the recording or the device as SOURCE");
    else if (fs::exists(folder / "events.txt") && fs::exists(folder / "session.json"))
      throw Error(name + ": is a recorded session, not a recording; `roomradar run` replays it");
    else
      throw Error(name +
                  ": is not a recording of a known format; looked for INDEX.txt (fakenect), depth.txt and "
                  "rgb.txt (TUM RGB-D), frame-XXXXXX.depth.png (7-Scenes), depth/NNNNN.png with "
                  "color/NNNNN.jpg (numbered), and recordings of other programs (`roomradar help sources`)");
    if (index.frames.empty()) throw Error(name + ": the recording contains no frames");
    return index;
  } catch (const fs::filesystem_error& error) {
    throw Error(name + ": cannot be listed: " + error.code().message());
  }
}

void pair_up(StampPairing& pairing, const std::vector<ListedImage>& colours,
             std::vector<RecordedFrame>& frames) {
  while (const auto pair = pairing.take()) {
    RecordedFrame& frame = frames[static_cast<std::size_t>(pair->depth)];
    if (pair->stamp_goes_back)
      frame.fault = frame.depth_file + ": its stamp is not later than that of the depth image before it";
    if (!pair->colour) continue;
    const ListedImage& colour = colours[static_cast<std::size_t>(*pair->colour)];
    frame.colour_file = colour.file;
    frame.colour_after_depth_s = pair->colour_after_depth_s;
    if (!colour.fault.empty()) frame.fault = colour.fault;
  }
}

std::optional<Eigen::Isometry3d> read_pose_file(const fs::path& path) {
  const std::string name = path.string();
  std::istringstream file(read_bytes(path, "a 4 x 4 pose", kLargestPose_bytes));
  Eigen::Matrix4d matrix;
  int count = 0;
  for (std::string line; std::getline(file, line);) {
    for (const std::string_view word : split_words(line)) {
      const auto value = parse_number(word);
      if (!value) throw Error(name + ": '" + std::string(word.substr(0, 40)) + "' is not a number");
      if (count == 16) throw Error(name + ": has more than 16 numbers; must be a 4 x 4 pose");
      matrix(count / 4, count % 4) = *value;
      ++count;
    }
  }
  if (count != 16)
    throw Error(name + ": has " + std::to_string(count) + " numbers; must be a 4 x 4 pose; is it cut short?");
  if (!matrix.allFinite()) return std::nullopt;
  const auto rotation = nearest_rotation(matrix.topLeftCorner<3, 3>());
  if (!rotation || !matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1), 1e-6))
    throw Error(name + ": is not a rigid pose: a rotation, a shift in metres, and 0 0 0 1 below");
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.linear() = *rotation;
  T_world_camera.translation() = matrix.topRightCorner<3, 1>();
  return T_world_camera;
}

}  // namespace roomradar
