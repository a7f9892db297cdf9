// recording_index.hpp: which files make up each frame of a recording folder, by format.
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

/// Size above which a text file that lists images is refused: weeks of frames.
inline constexpr std::uintmax_t kLargestList_bytes = std::uintmax_t{1} << 30;

/// A frame that has not been read yet.
struct RecordedFrame {
  double stamp_s = 0.0;
  std::filesystem::path depth_file{};
  std::filesystem::path colour_file{};  ///< empty: this frame has no colour
  double colour_after_depth_s = 0.0;    ///< how much later the colour was taken
  std::filesystem::path pose_file{};    ///< empty: the pose is below, or there is none
  std::optional<Eigen::Isometry3d> T_world_camera{};
  std::optional<Eigen::Vector3d> down_camera{};
  std::string fault{};  ///< if not empty: why this frame cannot be used
};

struct RecordingIndex {
  DepthEncoding depth_encoding = DepthEncoding::kMillimetres;
  NominalRig nominal = NominalRig::kSevenScenes;
  std::vector<RecordedFrame> frames;  ///< stamps of frames without a fault rise
};

/// Recognises the kind of recording and lists its frames; only its text files (and 12 byte accelerometer
/// dumps) are read. Throws Error as open_folder does.
RecordingIndex index_recording(const std::filesystem::path& folder);

/// One format each; the folder is known to be of that kind.
RecordingIndex index_seven_scenes(const std::filesystem::path& folder);
RecordingIndex index_tum(const std::filesystem::path& folder);
RecordingIndex index_numbered(const std::filesystem::path& folder);
RecordingIndex index_fakenect(const std::filesystem::path& folder);

/// A line of a list of images.
struct ListedImage {
  double stamp_s = 0.0;
  std::filesystem::path file{};
  std::string fault{};  ///< if not empty: why the line cannot be used; file is empty then
};

/// Gives the frames that `pairing` has decided on, by their numbers, their colour images, or those images'
/// faults; a frame whose stamp goes back gets that as its fault.
void pair_up(StampPairing& pairing, const std::vector<ListedImage>& colours,
             std::vector<RecordedFrame>& frames);

/// A 7-Scenes pose: 4 x 4, camera to world, its rotation made exact (recordings are off by some 1e-4).
/// Nothing where an entry is not finite: the recorder had lost track. Throws Error naming the file if it is
/// missing or not a pose.
std::optional<Eigen::Isometry3d> read_pose_file(const std::filesystem::path& path);

}  // namespace roomradar
