// indexed_source.cpp: reads images, removes lens distortion, counts unreadable frames.
#include "app/sources/datasets/indexed_source.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr int kMaxBadInARow = 10;

template <typename Pixel>
void require_size(const Image<Pixel>& image, const Intrinsics& camera, const char* which) {
  if (image.width == camera.width_px && image.height == camera.height_px) return;
  throw Error(std::string("its ") + which + " image is " + size_text(image.width, image.height) +
              ", but the recording's camera is " + size_text(camera.width_px, camera.height_px));
}

/// Marks frames whose stamp is not later than that of the last good frame.
void mark_wrong_stamps(std::vector<IndexedFrame>& frames) {
  double last_s = -std::numeric_limits<double>::infinity();
  for (IndexedFrame& frame : frames) {
    if (!frame.fault.empty()) continue;
    if (!std::isfinite(frame.stamp_s) || !(frame.stamp_s > last_s))
      frame.fault = "its stamp is not later than that of the frame before it";
    else
      last_s = frame.stamp_s;
  }
}

class IndexedSource final : public FrameSource {
 public:
  IndexedSource(IndexedRecording recording, const SourceOptions& options) : recording_(std::move(recording)) {
    CameraRig& rig = recording_.rig;
    if (recording_.frames.empty()) throw Error(recording_.name + ": the recording contains no frames");
    if (options.depth_camera) {
      const Intrinsics& chosen = *options.depth_camera;
      require_valid(chosen, "the depth intrinsics that were given");
      if (chosen.width_px != rig.depth_camera.width_px || chosen.height_px != rig.depth_camera.height_px)
        throw Error(recording_.name + ": the depth intrinsics are for images of " +
                    size_text(chosen.width_px, chosen.height_px) + ", but the recording's are " +
                    size_text(rig.depth_camera.width_px, rig.depth_camera.height_px));
      rig.depth_camera = chosen;
    }
    real_depth_camera_ = rig.depth_camera;
    require_valid(rig.depth_camera, (recording_.name + ", depth camera").c_str());
    if (recording_.depth_lens != RationalLens{}) {
      depth_correction_.emplace(rig.depth_camera, recording_.depth_lens,
                                (recording_.name + ", depth camera").c_str());
      rig.depth_camera = depth_correction_->ideal();
    }
    if (rig.colour_camera) {
      real_colour_camera_ = *rig.colour_camera;
      require_valid(*rig.colour_camera, (recording_.name + ", colour camera").c_str());
      if (recording_.colour_lens != RationalLens{}) {
        colour_correction_.emplace(*rig.colour_camera, recording_.colour_lens,
                                   (recording_.name + ", colour camera").c_str());
        rig.colour_camera = colour_correction_->ideal();
      }
    }
    mark_wrong_stamps(recording_.frames);
  }

  ReadResult next(Frame& frame) override {
    if (position_ == recording_.frames.size()) return {ReadStatus::kEnd, {}};
    const std::size_t position = position_++;
    try {
      read(position, whole_);
      std::swap(frame, whole_);  // `frame` stays unchanged if reading fails
    } catch (const Error& fault) {
      if (++bad_in_a_row_ >= kMaxBadInARow)
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
    return static_cast<std::int64_t>(recording_.frames.size());
  }
  [[nodiscard]] std::string name() const override { return recording_.name; }

 private:
  void read(std::size_t position, Frame& frame) {
    const IndexedFrame& indexed = recording_.frames[position];
    if (!indexed.fault.empty()) throw Error(indexed.fault);
    const CameraRig& rig = recording_.rig;
    frame.index = static_cast<std::int64_t>(position);
    frame.stamp_s = indexed.stamp_s;
    frame.colour_after_depth_s = indexed.colour_after_depth_s;
    frame.depth_camera = rig.depth_camera;
    frame.colour_camera = rig.colour_camera.value_or(Intrinsics{});
    frame.T_colour_depth = rig.T_colour_depth;
    frame.timing = rig.timing;
    frame.depth_noise = rig.depth_noise;
    frame.T_world_camera = recording_.read_pose ? recording_.read_pose(position) : indexed.T_world_camera;
    frame.down_camera = recording_.read_down ? recording_.read_down(position) : indexed.down_camera;

    recording_.read_depth(position, frame.depth_m);
    require_size(frame.depth_m, real_depth_camera_, "depth");
    if (depth_correction_) depth_correction_->correct(frame.depth_m);
    if (indexed.has_colour && rig.colour_camera) {
      recording_.read_colour(position, frame.colour);
      require_size(frame.colour, real_colour_camera_, "colour");
      if (colour_correction_) colour_correction_->correct(frame.colour);
    } else {
      frame.colour.resize(0, 0);
    }
  }

  IndexedRecording recording_;  // its rig holds the corrected cameras
  Intrinsics real_depth_camera_, real_colour_camera_;
  std::optional<LensCorrection> depth_correction_, colour_correction_;
  std::size_t position_ = 0;
  int bad_in_a_row_ = 0;
  Frame whole_;  // scratch
};

}  // namespace

std::unique_ptr<FrameSource> indexed_source(IndexedRecording recording, const SourceOptions& options) {
  return std::make_unique<IndexedSource>(std::move(recording), options);
}

std::vector<std::optional<std::size_t>> pair_colours(const std::vector<double>& colour_s, double tolerance_s,
                                                     std::vector<IndexedFrame>& frames) {
  constexpr std::size_t kColoursWithoutDepth = 300;  // ten seconds
  std::vector<std::optional<std::size_t>> colour_of(frames.size());
  StampPairing pairing({.tolerance_s = tolerance_s, .colours_kept = kColoursWithoutDepth});
  const auto take_pairs = [&] {
    while (const auto pair = pairing.take()) {
      IndexedFrame& frame = frames[static_cast<std::size_t>(pair->depth)];
      if (pair->stamp_goes_back)
        frame.fault = "its stamp is not later than that of the depth image before it";
      if (!pair->colour) continue;
      frame.has_colour = true;
      frame.colour_after_depth_s = pair->colour_after_depth_s;
      colour_of[static_cast<std::size_t>(pair->depth)] = static_cast<std::size_t>(*pair->colour);
    }
  };
  std::size_t colour = 0;
  const auto add_colours_until = [&](double stamp_s) {
    for (; colour < colour_s.size() && colour_s[colour] <= stamp_s; ++colour) {
      pairing.add_colour(static_cast<std::int64_t>(colour), colour_s[colour]);
      take_pairs();
    }
  };
  for (std::size_t depth = 0; depth < frames.size(); ++depth) {
    if (!frames[depth].fault.empty()) continue;
    add_colours_until(frames[depth].stamp_s);
    pairing.add_depth(static_cast<std::int64_t>(depth), frames[depth].stamp_s);
    take_pairs();
  }
  add_colours_until(std::numeric_limits<double>::infinity());
  pairing.finish();
  take_pairs();
  return colour_of;
}

void set_stamps(const std::vector<double>& stamps_s, std::vector<IndexedFrame>& frames) {
  constexpr double kNominalRate_hz = 30.0;
  const bool increase =
      std::adjacent_find(stamps_s.begin(), stamps_s.end(), std::greater_equal<>()) == stamps_s.end();
  for (std::size_t i = 0; i < frames.size(); ++i)
    frames[i].stamp_s = increase ? stamps_s[i] : static_cast<double>(i) / kNominalRate_hz;
}

std::string size_text(int width_px, int height_px) {
  return std::to_string(width_px) + " x " + std::to_string(height_px);
}

}  // namespace roomradar
