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

/// Max time between the depth and the colour image of a frame. Devices run at 30 Hz or less, and may miss
/// images.
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
  /// Cameras as recorded, with their lenses. All images must have the cameras' sizes.
  CameraRig rig{};
  RationalLens depth_lens{}, colour_lens{};
  std::function<void(std::size_t frame, DepthImage&)> read_depth{};
  /// Called for frames with has_colour.
  std::function<void(std::size_t frame, ColourImage&)> read_colour{};
  /// Replaces IndexedFrame::T_world_camera; unset: not used.
  std::function<std::optional<Eigen::Isometry3d>(std::size_t frame)> read_pose{};
  /// Replaces IndexedFrame::down_camera; unset: not used.
  std::function<std::optional<Eigen::Vector3d>(std::size_t frame)> read_down{};
};

/// Returns a source of the recording's frames that can rewind and seek. Frames without fault must have
/// increasing stamps; others are reported as faults. Lens distortion is removed. Unreadable frames are
/// skipped; next() throws Error after ten in a row.
/// @throws Error if the recording has no frames, or a camera or `options.depth_camera` is invalid
std::unique_ptr<FrameSource> indexed_source(IndexedRecording recording, const SourceOptions& options = {});

/// Assigns colour images to depth images by their stamps, within `tolerance_s`. Sets has_colour and
/// colour_after_depth_s of `frames`, and the fault of frames whose stamp is not later than that of the frame
/// before. Leaves out frames with a fault. `colour_s` has stamps in increasing order.
/// @return the number of the colour image per frame; unset where has_colour is false
std::vector<std::optional<std::size_t>> pair_colours(const std::vector<double>& colour_s, double tolerance_s,
                                                     std::vector<IndexedFrame>& frames);

/// Sets the stamps of all frames. If they do not increase, as in files whose writer had no clock, frame N
/// gets N / 30 s.
void set_stamps(const std::vector<double>& stamps_s, std::vector<IndexedFrame>& frames);

/// Returns the text of a size, "640 x 480".
std::string size_text(int width_px, int height_px);

}  // namespace roomradar
