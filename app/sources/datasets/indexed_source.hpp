// indexed_source.hpp: a recording whose frames are listed in memory and whose images are read on demand.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/sources/formats/camera_rig.hpp"
#include "app/sources/formats/lens_correction.hpp"
#include "app/sources/formats/source_options.hpp"
#include "app/sources/formats/stamp_pairing.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Max time between the depth and the colour image of a frame. Devices deliver at most 30 images/s of each
/// kind and may miss some, so the nearest colour image may be almost a period away.
inline constexpr double kPairWithin_s = kDevicePairing.tolerance_s;

/// A frame of a recording before its images are read.
struct IndexedFrame {
  double stamp_s = 0.0;
  bool has_colour = false;
  /// Colour stamp minus depth stamp.
  double colour_after_depth_s = 0.0;
  std::optional<Eigen::Isometry3d> T_world_camera{};
  /// Unit direction of gravity in the depth camera's frame, if known.
  std::optional<Eigen::Vector3d> down_camera{};
  /// Reason why the frame cannot be used; empty if it can.
  std::string fault{};
};

/// Frames, cameras, and the functions that read images. The functions throw Error if a frame cannot be read.
struct IndexedRecording {
  std::string name{};
  std::vector<IndexedFrame> frames{};
  /// Cameras as recorded, with their lenses. Each image must have the size of its camera.
  CameraRig rig{};
  RationalLens depth_lens{}, colour_lens{};
  std::function<void(std::size_t frame, DepthImage&)> read_depth{};
  /// Called for frames with has_colour.
  std::function<void(std::size_t frame, ColourImage&)> read_colour{};
  /// If set, called instead of reading IndexedFrame::T_world_camera.
  std::function<std::optional<Eigen::Isometry3d>(std::size_t frame)> read_pose{};
  /// If set, called instead of reading IndexedFrame::down_camera.
  std::function<std::optional<Eigen::Vector3d>(std::size_t frame)> read_down{};
};

/// Returns a source that delivers the recording's frames, and can rewind and seek. A frame whose stamp is not
/// later than that of the last usable frame is a faulty frame. Lens distortion is removed. Faulty and
/// unreadable frames are skipped. next() throws Error after ten skipped frames in a row.
/// @throws Error if the recording has no frames, or a camera or `options.depth_camera` is invalid
std::unique_ptr<FrameSource> indexed_source(IndexedRecording recording, const SourceOptions& options = {});

/// Pairs depth images with colour images whose stamps differ by at most `tolerance_s`. Sets has_colour and
/// colour_after_depth_s of `frames`, and the fault of frames whose stamp is not later than the previous
/// frame's. Ignores frames that already have a fault. Stamps in `colour_s` must increase.
/// @return the index of the colour image per frame; unset where has_colour is false
std::vector<std::optional<std::size_t>> pair_colours(const std::vector<double>& colour_s, double tolerance_s,
                                                     std::vector<IndexedFrame>& frames);

/// Sets the stamps of all frames to `stamps_s`. If any stamp is not later than the one before, as in files
/// whose writer had no clock, sets the stamp of each frame N to N / 30 s instead.
void set_stamps(const std::vector<double>& stamps_s, std::vector<IndexedFrame>& frames);

/// Returns the text of a size, "640 x 480".
std::string size_text(int width_px, int height_px);

}  // namespace roomradar
