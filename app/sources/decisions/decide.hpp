// decide.hpp: makes frames of what a recording states, by the same rules for all kinds of recordings.
#pragma once
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/sources/datasets/recording_facts.hpp"
#include "app/sources/formats/input_report.hpp"
#include "app/sources/formats/pose_convention.hpp"
#include "app/sources/formats/source_options.hpp"

namespace roomradar {

/// A depth image with its time and its colour image.
struct DecidedFrame {
  std::size_t stated = 0;  ///< index in RecordingFacts::frames
  double stamp_s = 0.0;
  std::optional<std::size_t> colour{};  ///< argument of RecordingFacts::read_colour
  double colour_after_depth_s = 0.0;
  std::string fault{};  ///< reason why the frame cannot be used; empty: it can
};

/// What the depth of some frames shows, see question_depth().
struct DepthEvidence {
  double measured_part = 0.0;                    ///< fraction of the pixels with depth
  double median_depth_m = 0.0;                   ///< of the pixels with depth
  double near_depth_m = 0.0, far_depth_m = 0.0;  ///< 5th and 90th percentile
  /// Greatest depth, if many pixels have exactly it and hardly any has one near it. Unset: there is no such
  /// depth.
  std::optional<double> equal_most_m{};
  std::optional<double>
      noise_ratio{};            ///< standard deviation between neighbours / that of the sensor's model
  std::size_t posed_pairs = 0;  ///< number of compared pairs of frames that have poses
  std::optional<double> pose_disagreement{};      ///< DepthDifference of these pairs; unset: fewer than 3
  std::optional<double> far_pose_disagreement{};  ///< the same of pairs farther apart
  double pose_difference_m = 0.0;
  bool poses_disagree = false;
  bool is_scale_confirmed = false;           ///< halving or doubling depth worsens the agreement clearly
  std::optional<double> still_difference{};  ///< DepthDifference of frames, if the camera does not move
  bool is_camera_still = false;
};

struct DecidedRecording {
  RecordingFacts facts{};              ///< with the cameras that were chosen
  std::vector<DecidedFrame> frames{};  ///< stamps of frames without a fault increase
  double depth_unit_m = 0.001;
  PoseConvention pose_convention{};
  bool poses_are_used = true;  ///< false: depth disagrees under the poses, so pose_of() returns none
  std::optional<DepthEvidence> evidence{};  ///< unset: Questions::kNone
  std::shared_ptr<InputReport> report{};    ///< never null
};

/// Decides, for a recording of any kind:
/// - time: repair_stamps() for depth and colour images; pairs of depth and colour by time; order of the
/// frames
/// - cameras: `options`, else camera.json in the recording's folder, else the recording itself, else
///   camera-intrinsics.txt in the folder, else assumed ones
/// - unit of depth: `options`, else camera.json, else the recording or its format
/// - poses: `options`, else camera.json, else the convention of the format or, with Questions::kDepth, one
///   under which the depth of nearby frames agrees
/// - with Questions::kDepth: checks whether unit, focal length and poses can be right, see
///   depth_evidence.hpp
/// Each decision becomes one line of the report. Decisions that are only confirmed are not reported.
/// @param folder  folder in which camera.json and camera-intrinsics.txt are looked for; may be a file
/// @throws Error if the recording has no frames, none of its depth images can be read, a file with cameras is
///         invalid, or cameras do not fit the images
DecidedRecording decide(RecordingFacts facts, const std::filesystem::path& folder,
                        const SourceOptions& options);

/// Returns the pose of frame `frame` + `later_by` as the recording states it. Counts in the report a pose
/// that is lost or not rigid.
std::optional<Eigen::Isometry3d> stated_pose_of(const DecidedRecording& recording, std::size_t frame,
                                                int later_by);
/// Returns T_world_camera of a stated pose.
Eigen::Isometry3d in_world(const RecordingFacts& facts, const Eigen::Isometry3d& stated,
                           const PoseConvention& convention);
/// Returns the pose of a frame by the decided convention.
std::optional<Eigen::Isometry3d> pose_of(const DecidedRecording& recording, std::size_t frame);
/// Reads the depth of a frame, m, with its lens distortion. Throws Error if it cannot be read, or its size is
/// not that of the depth camera.
void read_depth(const DecidedRecording& recording, std::size_t frame, DepthImage& depth_m);

}  // namespace roomradar
