// recording_index.hpp: lists the files of each frame of a recording folder, by format.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "app/sources/formats/stamp_pairing.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Max size of a text file that lists images; enough for weeks of frames.
inline constexpr std::uintmax_t kLargestList_bytes = std::uintmax_t{1} << 30;

/// A frame that has not been read yet.
struct RecordedFrame {
  double stamp_s = 0.0;
  std::filesystem::path depth_file{};
  std::filesystem::path colour_file{};  ///< empty: no colour
  double colour_after_depth_s = 0.0;    ///< colour stamp minus depth stamp
  std::filesystem::path pose_file{};    ///< empty: T_world_camera holds the pose, if there is one
  std::optional<Eigen::Isometry3d> T_world_camera{};
  std::optional<Eigen::Vector3d> down_camera{};
  std::string fault{};  ///< if not empty: reason why the frame cannot be used
};

struct RecordingIndex {
  DepthEncoding depth_encoding = DepthEncoding::kMillimetres;
  NominalRig nominal = NominalRig::kSevenScenes;
  std::vector<RecordedFrame> frames;  ///< stamps increase, except for frames with a fault
};

/// Recognises the format of a recording and lists its frames; reads only its text files (and 12 byte
/// accelerometer dumps). Throws Error as open_folder() does.
RecordingIndex index_recording(const std::filesystem::path& folder);

/// One function per format; the folder must be of that format. index_tum() and index_fakenect() are in
/// recording_index_tum.hpp and recording_index_fakenect.hpp.
RecordingIndex index_seven_scenes(const std::filesystem::path& folder);
RecordingIndex index_numbered(const std::filesystem::path& folder);

/// A line of a list of images.
struct ListedImage {
  double stamp_s = 0.0;
  std::filesystem::path file{};
  std::string fault{};  ///< if not empty: reason why the line cannot be used; `file` is then empty
};

/// Assigns the decided pairs' colour images to `frames`, by number, or the colour images' faults. A frame
/// whose stamp does not advance gets a fault.
void pair_up(StampPairing& pairing, const std::vector<ListedImage>& colours,
             std::vector<RecordedFrame>& frames);

/// Reads a 7-Scenes pose, 4 x 4, camera to world, and projects its rotation to the nearest exact one
/// (recordings are off by some 1e-4). Returns nothing if an entry is not finite: tracking was lost while
/// recording. Throws Error naming the file if it is missing or not a pose.
std::optional<Eigen::Isometry3d> read_pose_file(const std::filesystem::path& path);

}  // namespace roomradar
