// folder_source.cpp: cameras of an indexed folder, and the functions that read its images.
#include "app/sources/recordings/folder_source.hpp"

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/sources/recordings/foreign_recording.hpp"
#include "app/sources/recordings/recording_index.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr int kFramesTried = 10;

template <typename Pixel>
void require_size(const Image<Pixel>& image, const Intrinsics& camera, const std::filesystem::path& path) {
  if (image.width == camera.width_px && image.height == camera.height_px) return;
  throw Error(path.string() + ": is " + std::to_string(image.width) + " x " + std::to_string(image.height) +
              ", but the recording's other images are " + std::to_string(camera.width_px) + " x " +
              std::to_string(camera.height_px));
}

/// Returns the size of the first image that can be read; nothing if no frame has one. Throws Error if there
/// are images, but none of the first ten can be read.
template <typename ReadSize>
std::optional<ImageSize> first_size(const std::filesystem::path& folder,
                                    const std::vector<RecordedFrame>& frames,
                                    std::string RecordedFrame::*file, const ReadSize& read_size) {
  std::string first_fault;
  int bad = 0;
  for (const RecordedFrame& frame : frames) {
    if ((frame.*file).empty()) continue;
    try {
      return read_size(frame.*file);
    } catch (const Error& fault) {
      if (bad++ == 0) first_fault = fault.what();
      if (bad == kFramesTried) break;
    }
  }
  if (bad == 0) return std::nullopt;
  throw Error(folder.string() + ": none of its first " + std::to_string(bad) +
              " frames can be read, the first because " + first_fault);
}

}  // namespace

std::unique_ptr<FrameSource> open_folder(const std::filesystem::path& folder, const SourceOptions& options) {
  if (auto foreign = index_foreign(folder)) return indexed_source(std::move(*foreign), options);
  const auto index = std::make_shared<const RecordingIndex>(index_recording(folder));
  DepthImage depth_m;
  ColourImage colour;
  const auto depth_size =
      first_size(folder, index->frames, &RecordedFrame::depth_file, [&](const auto& file) {
        read_depth_file(file, index->depth_encoding, depth_m);
        return ImageSize{depth_m.width, depth_m.height};
      });
  const auto colour_size =
      first_size(folder, index->frames, &RecordedFrame::colour_file, [&](const auto& file) {
        read_colour_file(file, colour);
        return ImageSize{colour.width, colour.height};
      });
  // An absolute path, so different spellings name the same recording.
  IndexedRecording recording{.name = std::filesystem::canonical(folder).string()};
  if (!depth_size) throw Error(recording.name + ": contains no depth images");
  recording.rig = rig_of_recording(folder, index->nominal, options.depth_camera, *depth_size, colour_size);
  recording.frames.reserve(index->frames.size());
  for (const RecordedFrame& frame : index->frames)
    recording.frames.push_back({frame.stamp_s, !frame.colour_file.empty(), frame.colour_after_depth_s,
                                frame.T_world_camera, frame.down_camera, frame.fault});
  const Intrinsics depth_camera = recording.rig.depth_camera;
  const Intrinsics colour_camera = recording.rig.colour_camera.value_or(Intrinsics{});
  recording.read_depth = [index, depth_camera](std::size_t i, DepthImage& image) {
    const std::string& file = index->frames[i].depth_file;
    read_depth_file(file, index->depth_encoding, image);
    require_size(image, depth_camera, file);
  };
  recording.read_colour = [index, colour_camera](std::size_t i, ColourImage& image) {
    const std::string& file = index->frames[i].colour_file;
    read_colour_file(file, image);
    require_size(image, colour_camera, file);
  };
  recording.read_pose = [index](std::size_t i) {
    const RecordedFrame& frame = index->frames[i];
    return frame.pose_file.empty() ? frame.T_world_camera : read_pose_file(frame.pose_file);
  };
  return indexed_source(std::move(recording));
}

}  // namespace roomradar
