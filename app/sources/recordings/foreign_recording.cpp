// foreign_recording.cpp: the table of recording formats, each with its detection and its reader.
#include "app/sources/recordings/foreign_recording.hpp"

#include <array>

#include "app/sources/containers/matroska.hpp"
#include "app/sources/containers/oni_file.hpp"
#include "app/sources/containers/ros2_bag.hpp"
#include "app/sources/containers/ros_bag.hpp"
#include "app/sources/datasets/azure_recording.hpp"
#include "app/sources/datasets/klg.hpp"
#include "app/sources/datasets/oni_recording.hpp"
#include "app/sources/datasets/record3d.hpp"
#include "app/sources/datasets/redwood.hpp"
#include "app/sources/datasets/ros_recording.hpp"
#include "app/sources/datasets/rtabmap.hpp"
#include "app/sources/datasets/scannet_sens.hpp"
#include "app/sources/datasets/stray_scanner.hpp"
#include "app/sources/formats/camera_rig.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

struct Kind {
  const char* name;
  bool (*is_kind)(const fs::path&);
  IndexedRecording (*index)(const fs::path&);
};

constexpr std::array kKinds = {
    Kind{"Record3D export", is_record3d, index_record3d},
    Kind{"Azure Kinect recording", is_matroska, index_azure_recording},
    Kind{"ROS 1 bag", is_ros_bag, index_ros1_bag},
    Kind{"ROS 2 bag", is_ros2_bag, index_ros2_bag},
    Kind{"OpenNI recording", is_oni, index_oni_recording},
    Kind{"RTAB-Map database", is_rtabmap, index_rtabmap},
    Kind{"ScanNet recording", is_scannet_sens, index_scannet_sens},
    Kind{"ElasticFusion recording", is_klg, index_klg},
    Kind{"Stray Scanner recording", is_stray_scanner, index_stray_scanner},
    Kind{"Redwood or Open3D recording", is_redwood, index_redwood},
    Kind{"ICL-NUIM recording", is_icl_nuim, index_icl_nuim},
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
  for (const char* own : {"depth.txt", "rgb.txt", "INDEX.txt", "depth"})
    if (fs::exists(path / own, fault)) return path;
  fs::path found;
  constexpr int kMaxFiles = 30;  // a folder of images has more
  int files = 0;
  for (fs::directory_iterator each(path, fault), end; !fault && each != end; each.increment(fault)) {
    if (++files > kMaxFiles || each->path().filename().string().starts_with("frame-")) return path;
    if (!each->is_regular_file(fault) || !kind_of(each->path())) continue;
    if (!found.empty()) return path;
    found = each->path();
  }
  return found.empty() ? path : found;
}

}  // namespace

std::string foreign_kind(const fs::path& path) {
  const Kind* kind = kind_of(path);
  if (!kind) kind = kind_of(file_in(path));
  return kind ? kind->name : "";
}

std::optional<IndexedRecording> index_foreign(const fs::path& path) {
  try {
    if (const Kind* kind = kind_of(path)) return kind->index(path);
    const fs::path file = file_in(path);
    const Kind* kind = file == path ? nullptr : kind_of(file);
    if (!kind) return std::nullopt;
    IndexedRecording recording = kind->index(file);
    recording.name = fs::canonical(path).string();
    if (fs::exists(path / "camera.json")) {
      recording.rig = read_camera_file(path / "camera.json");
      recording.depth_lens = recording.colour_lens = {};
    }
    return recording;
  } catch (const fs::filesystem_error& error) {
    throw Error(path.string() + ": cannot be listed: " + error.code().message());
  }
}

}  // namespace roomradar
