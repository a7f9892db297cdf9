// folder_source.cpp: facts, then decisions, then frames: reads images, removes lens distortion, counts images
// that cannot be read.
#include "app/sources/recordings/folder_source.hpp"

#include <optional>
#include <string>
#include <utility>

#include "app/sources/decisions/decide.hpp"
#include "app/sources/recordings/recording_kinds.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// Delivers the frames of a decided recording. Images are read on demand, and lens distortion is removed. A
/// frame whose depth cannot be read is skipped, however many there are. A frame whose colour cannot be read
/// is delivered without colour. Both are counted in the report.
class RecordingSource final : public FrameSource {
 public:
  /// Throws Error if a camera is invalid.
  explicit RecordingSource(DecidedRecording recording)
      : recording_(std::move(recording)), rig_(recording_.facts.rig) {
    const RecordingFacts& facts = recording_.facts;
    const std::string depth_name = facts.name + ", depth camera",
                      colour_name = facts.name + ", colour camera";
    require_valid(rig_.depth_camera, depth_name.c_str());
    if (facts.depth_lens != RationalLens{}) {
      depth_correction_.emplace(rig_.depth_camera, facts.depth_lens, depth_name.c_str());
      rig_.depth_camera = depth_correction_->ideal();
    }
    if (!rig_.colour_camera) return;
    require_valid(*rig_.colour_camera, colour_name.c_str());
    if (facts.colour_lens != RationalLens{}) {
      colour_correction_.emplace(*rig_.colour_camera, facts.colour_lens, colour_name.c_str());
      rig_.colour_camera = colour_correction_->ideal();
    }
  }

  ReadResult next(Frame& frame) override {
    if (position_ == recording_.frames.size()) return {ReadStatus::kEnd, {}};
    const std::size_t position = position_++;
    try {
      read(position, whole_);
      std::swap(frame, whole_);  // `frame` stays unchanged if reading fails
    } catch (const Error& fault) {
      recording_.report->count("images", "% depth images cannot be read and are left out",
                               static_cast<std::int64_t>(position), fault.what());
      return {ReadStatus::kSkipped, "frame " + std::to_string(position) + ": " + fault.what()};
    }
    return {ReadStatus::kFrame, {}};
  }

  bool rewind() override { return seek(0); }

  bool seek(std::int64_t index) override {
    if (index < 0 || index >= *frame_count()) return false;
    position_ = static_cast<std::size_t>(index);
    return true;
  }

  [[nodiscard]] std::optional<std::int64_t> frame_count() const override {
    return static_cast<std::int64_t>(recording_.frames.size());
  }
  [[nodiscard]] std::string name() const override { return recording_.facts.name; }

 private:
  void read(std::size_t position, Frame& frame) {
    const RecordingFacts& facts = recording_.facts;
    const DecidedFrame& decided = recording_.frames[position];
    read_depth(recording_, position, frame.depth_m);
    if (depth_correction_) depth_correction_->correct(frame.depth_m);
    frame.index = static_cast<std::int64_t>(position);
    frame.stamp_s = decided.stamp_s;
    frame.colour_after_depth_s = decided.colour_after_depth_s;
    frame.depth_camera = rig_.depth_camera;
    frame.colour_camera = rig_.colour_camera.value_or(Intrinsics{});
    frame.T_colour_depth = rig_.T_colour_depth;
    frame.timing = rig_.timing;
    frame.depth_noise = rig_.depth_noise;
    frame.T_world_camera = pose_of(recording_, position);
    frame.down_camera = facts.read_down ? facts.read_down(decided.stated, decided.stamp_s)
                                        : facts.frames[decided.stated].down_camera;
    if (facts.is_world_level && frame.T_world_camera)
      frame.down_camera = -frame.T_world_camera->linear().row(2).transpose();
    if (!decided.colour || !rig_.colour_camera || !read_colour(*decided.colour, position, frame.colour))
      frame.colour.resize(0, 0);
  }

  /// Returns false if the image cannot be read.
  bool read_colour(std::size_t colour, std::size_t position, ColourImage& image) {
    try {
      recording_.facts.read_colour(colour, image);
      const Intrinsics& camera = *recording_.facts.rig.colour_camera;
      if (image.width != camera.width_px || image.height != camera.height_px)
        throw Error("its colour image is " + size_text(image.width, image.height) +
                    ", but the recording's camera is " + size_text(camera.width_px, camera.height_px));
      if (colour_correction_) colour_correction_->correct(image);
      return true;
    } catch (const Error& fault) {
      recording_.report->count("images",
                               "% colour images cannot be read; their frames are used without colour",
                               static_cast<std::int64_t>(position), fault.what());
      return false;
    }
  }

  DecidedRecording recording_;  // its cameras are as recorded
  CameraRig rig_;               // corrected cameras
  std::optional<LensCorrection> depth_correction_, colour_correction_;
  std::size_t position_ = 0;
  Frame whole_;  // scratch
};

}  // namespace

std::unique_ptr<FrameSource> open_folder(const std::filesystem::path& folder, const SourceOptions& options) {
  return std::make_unique<RecordingSource>(decide(read_facts(folder, options.depth_topic), folder, options));
}

}  // namespace roomradar
