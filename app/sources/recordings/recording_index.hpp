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

/// A frame of a recording before its images are read. Paths are strings: those of a recording of ten minutes
/// take 20 MB less than as std::filesystem::path, which also stores its parts.
struct RecordedFrame {
  double stamp_s = 0.0;
  std::string depth_file{};
  /// Colour image; empty if there is none.
  std::string colour_file{};
  /// Colour stamp minus depth stamp.
  double colour_after_depth_s = 0.0;
  /// Pose file. If empty, T_world_camera contains the pose, if any.
  std::string pose_file{};
  std::optional<Eigen::Isometry3d> T_world_camera{};
  /// Unit direction of gravity in the depth camera's frame, if known.
  std::optional<Eigen::Vector3d> down_camera{};
  /// Reason why the frame cannot be used; empty if it can.
  std::string fault{};
};

struct RecordingIndex {
  DepthEncoding depth_encoding = DepthEncoding::kMillimetres;
  NominalRig nominal = NominalRig::kSevenScenes;
  /// Frames. Stamps of usable frames increase.
  std::vector<RecordedFrame> frames;
};

/// Recognises the format of a recording and lists its frames. Reads only text files and accelerometer dumps,
/// not images. Throws Error as open_folder() does.
RecordingIndex index_recording(const std::filesystem::path& folder);

/// Lists the frames of a folder in 7-Scenes format. The other formats are in recording_index_tum.hpp and
/// recording_index_fakenect.hpp.
RecordingIndex index_seven_scenes(const std::filesystem::path& folder);
/// Lists the frames of a numbered folder (depth/NNNNN.png, color/NNNNN.jpg or .png).
RecordingIndex index_numbered(const std::filesystem::path& folder);

/// A line of a file that lists images.
struct ListedImage {
  double stamp_s = 0.0;
  std::string file{};
  /// Reason why the line cannot be used. Then `file` is empty. Empty if the line is valid.
  std::string fault{};
};

/// Assigns colour images to `frames` by the decided pairs of `pairing`. A frame becomes unusable if the line
/// of its colour image cannot be used, or if the frame's depth stamp is not later than the previous frame's.
void pair_up(StampPairing& pairing, const std::vector<ListedImage>& colours,
             std::vector<RecordedFrame>& frames);

/// Reads a 7-Scenes pose, a 4 x 4 matrix from camera to world. Replaces its rotation by the nearest exact
/// rotation. Rotations in recordings deviate by about 1e-4. Returns nullopt if an entry is not finite, as
/// recorders write when tracking is lost. Throws Error naming the file if it is missing or not a pose.
std::optional<Eigen::Isometry3d> read_pose_file(const std::filesystem::path& path);

}  // namespace roomradar
