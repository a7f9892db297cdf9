// recording_kinds.cpp: the table of kinds, each with its detection and its reader.
#include "app/sources/recordings/recording_kinds.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "app/sources/containers/matroska.hpp"
#include "app/sources/containers/oni_file.hpp"
#include "app/sources/containers/ros2_bag.hpp"
#include "app/sources/containers/ros_bag.hpp"
#include "app/sources/datasets/dataset_readers.hpp"
#include "app/sources/datasets/numbered_files.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/folders.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

struct Kind {
  const char* name;
  bool (*is_kind)(const fs::path&);
  RecordingFacts (*read)(const fs::path&);  ///< null: read_topic is called
  bool is_foreign = true;
  /// Reads a recording with several topics; an empty name leaves the choice to the reader.
  RecordingFacts (*read_topic)(const fs::path&, const std::string& depth_topic) = nullptr;
};

/// In this order: a folder that looks like several kinds is of the first.
constexpr std::array kKinds = {
    Kind{"Record3D export", is_record3d, index_record3d},
    Kind{"Azure Kinect recording", is_matroska, index_azure_recording},
    Kind{"ROS 1 bag", is_ros_bag, nullptr, true, index_ros1_bag},
    Kind{"ROS 2 bag", is_ros2_bag, nullptr, true, index_ros2_bag},
    Kind{"OpenNI recording", is_oni, index_oni_recording},
    Kind{"RTAB-Map database", is_rtabmap, index_rtabmap},
    Kind{"ScanNet recording", is_scannet_sens, index_scannet_sens},
    Kind{"ElasticFusion recording", is_klg, index_klg},
    Kind{"fakenect recording", is_fakenect_dump, index_fakenect_dump, false},
    Kind{"TUM RGB-D recording", is_tum_rgbd, index_tum_rgbd, false},
    Kind{"Stray Scanner recording", is_stray_scanner, index_stray_scanner},
    Kind{"Redwood or Open3D recording", is_redwood, index_redwood},
    Kind{"ICL-NUIM recording", is_icl_nuim, index_icl_nuim},
    Kind{"7-Scenes recording", is_seven_scenes, index_seven_scenes, false},
    Kind{"folder of numbered images", is_numbered_images, index_numbered_images, false},
};

/// Returns the path's kind; null for unknown ones.
const Kind* kind_of(const fs::path& path) {
  for (const Kind& kind : kKinds)
    if (kind.is_kind(path)) return &kind;
  return nullptr;
}

/// Returns the one file with a recording in a folder; the path itself if it has none or several, or if it
/// holds a recording in files of its own.
fs::path file_in(const fs::path& path) {
  std::error_code fault;
  for (const char* own : {"depth.txt", "rgb.txt", "INDEX.txt"})
    if (fs::exists(path / own, fault)) return path;
  if (!depth_folder(path).empty()) return path;
  fs::path found;
  constexpr int kMaxFiles = 30;  // a folder of images has more
  int files = 0;
  for (fs::directory_iterator each(path, fault), end; !fault && each != end; each.increment(fault)) {
    if (is_hidden_file(each->path().filename().string())) continue;
    if (++files > kMaxFiles || each->path().filename().string().starts_with("frame-")) return path;
    if (!each->is_regular_file(fault) || !kind_of(each->path())) continue;
    if (!found.empty()) return path;
    found = each->path();
  }
  return found.empty() ? path : found;
}

/// Returns the folders in a folder, at most a hundred; none if it cannot be listed.
std::vector<fs::path> folders_in(const fs::path& path) {
  constexpr std::size_t kMost = 100;
  std::vector<fs::path> folders;
  std::error_code fault;
  for (fs::directory_iterator each(path, fault), end; !fault && each != end && folders.size() < kMost;
       each.increment(fault)) {
    std::error_code ignored;
    if (!is_hidden_file(each->path().filename().string()) && each->is_directory(ignored))
      folders.push_back(each->path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

/// Returns the path's kind, or that of the one file or the one folder in it, and sets `file` to what is to be read.
const Kind* kind_of(const fs::path& path, fs::path& file) {
  file = path;
  if (const Kind* kind = kind_of(path)) return kind;
  file = file_in(path);
  if (file != path) return kind_of(file);
  // An archive that was unpacked into a folder of its own, or an app's folder in it.
  constexpr int kLevels = 3;
  for (int level = 0; level < kLevels; ++level) {
    const std::vector<fs::path> folders = folders_in(file);
    if (folders.size() != 1) break;
    file = folders.front();
    if (const Kind* kind = kind_of(file)) return kind;
  }
  file = path;
  return nullptr;
}

[[noreturn]] void fail_unknown(const fs::path& path) {
  const std::string name = path.string();
  std::error_code fault;
  if (!fs::exists(path, fault)) throw Error(name + ": there is no such folder");
  if (!fs::is_directory(path, fault))
    throw Error(name +
                ": is neither a folder nor a recording file of a known format; `roomradar help sources` "
                "lists the formats");
  if (entries_of(path).empty()) throw Error(name + ": the folder is empty");
  if (fs::exists(path / "map.json"))
    throw Error(name + ": is a saved map, not a recording; give the recording or the device as SOURCE");
  if (fs::exists(path / "events.txt") && fs::exists(path / "session.json"))
    throw Error(name + ": is a recorded session, not a recording; `roomradar run` replays it");
  std::vector<std::string> recordings;
  for (const fs::path& folder : folders_in(path))
    if (kind_of(folder)) recordings.push_back(folder.filename().string());
  if (!recordings.empty())
    throw Error(name + ": holds several folders, of which " + recordings.front() +
                (recordings.size() == 1 ? " is a recording" : " and " + recordings.back() + " are recordings") +
                "; give one of them");
  throw Error(name +
              ": is not a recording of a known format; looked for INDEX.txt (fakenect), depth.txt and "
              "rgb.txt (TUM RGB-D), frame-XXXXXX.depth.png (7-Scenes), depth/NNNNN.png with "
              "color/NNNNN.jpg (numbered), and recordings of other programs (`roomradar help sources`)");
}

}  // namespace

std::string recording_kind(const fs::path& path) {
  fs::path file;
  const Kind* kind = kind_of(path, file);
  return kind ? kind->name : "";
}

bool is_foreign_recording(const fs::path& path) {
  fs::path file;
  const Kind* kind = kind_of(path, file);
  return kind && kind->is_foreign;
}

RecordingFacts read_facts(const fs::path& path, const std::string& depth_topic) {
  try {
    fs::path file;
    const Kind* kind = kind_of(path, file);
    if (!kind) fail_unknown(path);
    if (!depth_topic.empty() && !kind->read_topic)
      throw Error(path.string() + ": is a " + kind->name + ", which has no topics; leave out --depth-topic");
    RecordingFacts facts = kind->read_topic ? kind->read_topic(file, depth_topic) : kind->read(file);
    facts.kind = kind->name;
    if (file != path) facts.name = fs::canonical(path).string();
    if (file != path && fs::is_directory(file)) facts.entered = file.string();
    return facts;
  } catch (const fs::filesystem_error& error) {
    throw Error(path.string() + ": cannot be listed: " + error.code().message());
  }
}

}  // namespace roomradar
