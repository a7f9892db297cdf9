// recording_facts.hpp: what a recording states about its images, times, cameras and poses.
//
// Readers of datasets fill RecordingFacts and decide nothing. decide() (app/sources/decisions) makes frames
// of the facts, by the same rules for all kinds of recordings.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/sources/formats/camera_rig.hpp"
#include "app/sources/formats/input_report.hpp"
#include "app/sources/formats/lens_correction.hpp"
#include "app/sources/formats/stamp_pairing.hpp"
#include "app/sources/formats/time_tracks.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// A time that the recording does not state.
inline constexpr double kNoStamp = std::numeric_limits<double>::quiet_NaN();

/// Rate of images that is assumed for recordings without a clock.
inline constexpr double kNominalRate_hz = 30.0;

/// Times of an image as the recording states them, in s unless RecordingFacts::stamps_have_no_unit.
struct StatedTime {
  double stamp_s = kNoStamp;     ///< of the exposure, such as the header's stamp
  double received_s = kNoStamp;  ///< of the reception by the recorder
};

/// A depth image, and what the recording states about it.
struct StatedFrame {
  StatedTime time{};
  /// Colour image that belongs to this depth image. Unset: see RecordingFacts::colours.
  std::optional<std::size_t> colour{};
  double colour_after_depth_s = 0.0;  ///< colour stamp minus depth stamp; only with `colour`
  std::optional<Eigen::Isometry3d> T_world_camera{};
  /// Reason why a pose that the recording lists for this frame is none, such as "is not a rigid transform".
  /// Empty: there is a pose, or the recording lists none.
  std::string pose_fault{};
  std::optional<Eigen::Vector3d> down_camera{};  ///< unit direction of gravity in the depth camera's frame
  std::string fault{};                           ///< reason why the frame cannot be used; empty: it can
};

/// A pose that was looked up for a frame.
struct StatedPose {
  std::optional<Eigen::Isometry3d> T_world_camera{};
  std::string fault{};          ///< as StatedFrame::pose_fault
  bool was_transposed = false;  ///< the matrix was stored column by column, and was transposed
};

/// How a value is known.
enum class Origin {
  kRecording,  ///< the recording states it
  kFile,       ///< a file beside the recording, such as camera.json, states it
  kOption,     ///< the user states it
  kFormat,     ///< the format defines it for all recordings
  kAssumed,    ///< the value of a typical device
};

struct RecordingFacts {
  std::string name{};  ///< canonical path
  std::string kind{};  ///< such as "Record3D export"
  std::string entered{};  ///< folder in the given one that holds the recording; empty: the given one does

  std::vector<StatedFrame> frames{};  ///< one per depth image, in the recording's order
  /// Times of the colour images, to be paired with depth images by time. Empty if StatedFrame::colour tells
  /// the pairs.
  std::vector<StatedTime> colours{};
  double pair_within_s = kDevicePairing.tolerance_s;  ///< max time between the images of a pair
  /// True: stamps are numbers in a text file, whose unit (s, ms, us, ns) the format does not fix.
  bool stamps_have_no_unit = false;
  /// True: the recording has no clock. Stamps are numbers of images, at 30 per second.
  bool has_no_clock = false;

  /// Tracks on the clock of the stamps, in the recording's order. The functions below use them after decide()
  /// has repaired and sorted them. Null: there is none.
  std::shared_ptr<std::vector<StampedPose>> pose_track{};
  std::shared_ptr<std::vector<StampedAcceleration>> acceleration_track{};
  std::size_t lost_track_poses = 0;  ///< entries of the pose track that were not a pose

  /// T_world_camera = T_world_statedworld * (stated pose) * T_statedcamera_camera: the axes of the format.
  Eigen::Isometry3d T_world_statedworld = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_statedcamera_camera = Eigen::Isometry3d::Identity();
  bool has_quaternions = false;  ///< the recording states rotations as quaternions, whose order may be another one
  bool has_pose_times = false;  ///< poses have time stamps of their own, so they cannot be shifted by a frame
  /// True: the world frame of the poses is aligned with gravity, so a pose gives the direction of gravity.
  bool is_world_level = false;

  /// Cameras as recorded, with their lenses. Each image must have the size of its camera.
  CameraRig rig{};
  RationalLens depth_lens{}, colour_lens{};
  Origin camera_origin = Origin::kRecording;
  std::string camera_source{};  ///< where the cameras are stated, or whose they are if they are assumed
  bool is_colour_camera_assumed = false;           ///< only the depth camera is stated
  std::string colour_camera_source{};              ///< whose colour camera is assumed
  Origin colour_pose_origin = Origin::kRecording;  ///< of rig.T_colour_depth
  /// True: depth images are registered to the colour camera. Cameras that are given for depth only then are
  /// those of colour, too.
  bool is_depth_registered = false;
  /// True: the cameras are assumed, and a user who gives a depth camera but no colour camera has registered
  /// images.
  bool is_registered_if_given = false;

  double depth_unit_m = 0.001;  ///< length of a unit of the stored depth
  Origin unit_origin = Origin::kFormat;
  std::string unit_source{};  ///< where the unit is stated
  /// True: folders of this form are written by many programs, some of which store depth in another unit.
  bool is_written_by_many = false;

  std::string gravity_source{};  ///< such as "accelerometer.txt"; empty: there is no gravity
  /// Lines, files and images that the reader left out, and choices between several streams.
  std::vector<InputDecision> notes{};

  /// Reads a depth image, m. `unit_m` is the length of a unit of the stored depth. Throws Error.
  std::function<void(std::size_t frame, double unit_m, DepthImage&)> read_depth{};
  /// If set, called after read_depth: sets depths of which the recording states that they are unreliable to
  /// 0. Throws Error if that cannot be read; the frame is then used with all its depths.
  std::function<void(std::size_t frame, DepthImage&)> remove_unsure{};
  /// Reads a colour image. Throws Error.
  std::function<void(std::size_t colour, ColourImage&)> read_colour{};
  /// If set, called instead of reading StatedFrame::T_world_camera. `stamp_s` is the frame's time by
  /// decide().
  std::function<StatedPose(std::size_t frame, double stamp_s)> read_pose{};
  /// If set, called instead of reading StatedFrame::down_camera.
  std::function<std::optional<Eigen::Vector3d>(std::size_t frame, double stamp_s)> read_down{};
};

/// Returns the text of a size, "640 x 480".
inline std::string size_text(int width_px, int height_px) {
  return std::to_string(width_px) + " x " + std::to_string(height_px);
}

}  // namespace roomradar
