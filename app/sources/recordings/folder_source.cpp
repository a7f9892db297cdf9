// folder_source.cpp: reads the frames of an indexed recording one by one.
#include "app/sources/recordings/folder_source.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/sources/recordings/recording_index.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr int kBadFramesInARow = 10;

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
                                    std::filesystem::path RecordedFrame::*file, const ReadSize& read_size) {
  std::string first_fault;
  int bad = 0;
  for (const RecordedFrame& frame : frames) {
    if ((frame.*file).empty()) continue;
    try {
      return read_size(frame.*file);
    } catch (const Error& fault) {
      if (bad++ == 0) first_fault = fault.what();
      if (bad == kBadFramesInARow) break;
    }
  }
  if (bad == 0) return std::nullopt;
  throw Error(folder.string() + ": none of its first " + std::to_string(bad) +
              " frames can be read, the first because " + first_fault);
}

class FolderSource final : public FrameSource {
 public:
  FolderSource(std::filesystem::path folder, const SourceOptions& options)
      : folder_(std::move(folder)),
        index_(index_recording(folder_)),
        name_(std::filesystem::canonical(folder_).string()) {
    DepthImage depth_m;
    ColourImage colour;
    const auto depth_size =
        first_size(folder_, index_.frames, &RecordedFrame::depth_file, [&](const auto& file) {
          read_depth_file(file, index_.depth_encoding, depth_m);
          return ImageSize{depth_m.width, depth_m.height};
        });
    const auto colour_size =
        first_size(folder_, index_.frames, &RecordedFrame::colour_file, [&](const auto& file) {
          read_colour_file(file, colour);
          return ImageSize{colour.width, colour.height};
        });
    if (!depth_size) throw Error(name() + ": holds no depth image");
    rig_ = rig_of_recording(folder_, index_.nominal, options.depth_camera, *depth_size, colour_size);
  }

  ReadResult next(Frame& frame) override {
    if (position_ == index_.frames.size()) return {ReadStatus::kEnd, {}};
    const std::size_t position = position_++;
    try {
      read(position, whole_);
      std::swap(frame, whole_);  // `frame` stays unchanged if reading fails
    } catch (const Error& fault) {
      if (++bad_in_a_row_ >= kBadFramesInARow)
        throw Error(name() + ": " + std::to_string(bad_in_a_row_) +
                    " frames one after the other cannot be read, the last: " + fault.what());
      return {ReadStatus::kSkipped, "frame " + std::to_string(position) + ": " + fault.what()};
    }
    bad_in_a_row_ = 0;
    return {ReadStatus::kFrame, {}};
  }

  bool rewind() override { return seek(0); }

  bool seek(std::int64_t index) override {
    if (index < 0 || index >= *frame_count()) return false;
    position_ = static_cast<std::size_t>(index);
    bad_in_a_row_ = 0;
    return true;
  }

  [[nodiscard]] std::optional<std::int64_t> frame_count() const override {
    return static_cast<std::int64_t>(index_.frames.size());
  }
  [[nodiscard]] std::string name() const override { return name_; }

 private:
  void read(std::size_t position, Frame& frame) const {
    const RecordedFrame& recorded = index_.frames[position];
    if (!recorded.fault.empty()) throw Error(recorded.fault);
    frame.index = static_cast<std::int64_t>(position);
    frame.stamp_s = recorded.stamp_s;
    frame.colour_after_depth_s = recorded.colour_after_depth_s;
    frame.depth_camera = rig_.depth_camera;
    frame.colour_camera = rig_.colour_camera.value_or(Intrinsics{});
    frame.T_colour_depth = rig_.T_colour_depth;
    frame.timing = rig_.timing;
    frame.T_world_camera =
        recorded.pose_file.empty() ? recorded.T_world_camera : read_pose_file(recorded.pose_file);
    frame.down_camera = recorded.down_camera;

    read_depth_file(recorded.depth_file, index_.depth_encoding, frame.depth_m);
    require_size(frame.depth_m, rig_.depth_camera, recorded.depth_file);
    if (recorded.colour_file.empty()) {
      frame.colour.resize(0, 0);
    } else {
      read_colour_file(recorded.colour_file, frame.colour);
      require_size(frame.colour, *rig_.colour_camera, recorded.colour_file);
    }
  }

  std::filesystem::path folder_;
  RecordingIndex index_;
  std::string name_;  // absolute path, so different spellings name the same recording
  CameraRig rig_;
  std::size_t position_ = 0;
  int bad_in_a_row_ = 0;
  Frame whole_;  // scratch
};

}  // namespace

std::unique_ptr<FrameSource> open_folder(const std::filesystem::path& folder, const SourceOptions& options) {
  return std::make_unique<FolderSource>(folder, options);
}

}  // namespace roomradar
