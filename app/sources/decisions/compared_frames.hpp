// compared_frames.hpp: frames of a recording that are compared with each other, in depth and brightness,
// under assumptions about poses and camera.
#pragma once
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/sources/decisions/decide.hpp"

namespace roomradar {

/// An error of the stated depth camera, and of its pose relative to the recorded poses' camera.
struct CameraError {
  double fx_factor = 1.0, fy_factor = 1.0;  ///< times which the focal lengths are right
  /// To be added to the principal point, as part of the image's width.
  Eigen::Vector2d principal = {0.0, 0.0};
  Eigen::Vector3d turn_rad = {0.0, 0.0, 0.0};  ///< rotation vector, recorded camera -> camera
  Eigen::Vector3d shift_m = {0.0, 0.0, 0.0};   ///< position of the camera in the recorded camera's frame
};

/// Returns the camera as it is if the stated one has this error.
Intrinsics without_error(const Intrinsics& camera, const CameraError& error);

/// Returns the words "with a focal length of about ... than with ..."; nullopt if the camera is as stated.
std::optional<std::string> other_camera(const Intrinsics& stated, const CameraError& error);

/// A frame that was read for the comparison.
struct ComparedFrame {
  DepthImage depth_m;
  bool has_depth = false;  ///< a hundredth of the pixels or more are measured; a covered lens measures none
  /// Brightness at each pixel of the depth image, 0..1; -1: unknown. Empty: there
  /// is no colour image.
  Image<float> brightness{};
};

/// Two frames that overlap.
struct FramePair {
  std::size_t a = 0, b = 0;  ///< positions
};

/// Poses of a position under an assumption; nullopt: none.
using PoseOf = std::function<std::optional<Eigen::Isometry3d>(std::size_t)>;

/// Reads frames, each once. Their images are at most 320 pixels wide, so that a hundred of them take 60 MB.
class ComparedFrames {
 public:
  /// Keeps a reference to the recording.
  explicit ComparedFrames(const DecidedRecording& recording);
  /// Returns the frame; null if it cannot be read.
  const ComparedFrame* at(std::size_t position);
  /// Returns the camera of the samples.
  [[nodiscard]] const Intrinsics& camera() const { return camera_; }
  /// Returns the camera of the recording's images, without their lens.
  [[nodiscard]] const Intrinsics& full_camera() const { return full_camera_; }
  /// Returns the noise of the frames read so far relative to the sensor's model; nullopt if unknown.
  [[nodiscard]] std::optional<double> noise_ratio() const { return noise_.ratio(); }

 private:
  /// The spread of depth about the line through a pixel's neighbours, where these are smooth, relative to the
  /// sensor's model.
  class NoiseMeasure {
   public:
    void add(const DepthImage& depth_m, const DepthNoise& noise);
    /// Returns nullopt for fewer than 200 smooth pixels.
    [[nodiscard]] std::optional<double> ratio() const;

   private:
    double sum_ = 0.0;
    std::size_t count_ = 0;
  };

  /// Leaves the brightness empty if there is no colour image, or it cannot be read.
  void read_brightness(std::size_t position, ComparedFrame& sample);

  const DecidedRecording& recording_;
  Intrinsics full_camera_, camera_;
  int stride_ = 1;
  DepthImage full_m_;   // scratch
  ColourImage colour_;  // scratch
  NoiseMeasure noise_;
  std::optional<LensCorrection> correction_;
  std::map<std::size_t, std::optional<ComparedFrame>> samples_;
};

/// Returns pairs of frames, in a dozen places of the recording, between which the camera has moved by
/// `least_motion` or more by the poses: about 1 where a third of the view has changed. Takes the frames
/// nearest in time. Without poses, frames four apart.
/// @param frames  number of the recording's frames
std::vector<FramePair> choose_pairs(std::size_t frames, double least_motion, const PoseOf& pose_of_position);

/// Returns up to eight pairs of frames, not necessarily near in time, between which the camera has moved
/// sideways but hardly turned. They tell the scale of a camera that mostly turns.
std::vector<FramePair> choose_shifted_pairs(std::size_t frames, const PoseOf& pose_of_position);

/// How well the depth of one frame predicts that of another one.
struct DepthDifference {
  static constexpr double kAgrees = 0.72;  ///< disagreement below which the poses of a pair are right
  /// Mean over the compared points of min(difference / (2 % of depth), 1). Correct poses give 0.3 to 0.65,
  /// because edges, noise and time offsets differ; wrong ones give 0.8 and more.
  double disagreement = 1.0;
  double median_m = 0.0;  ///< median absolute difference
};

/// Compares points of `from`, moved by T_to_from, with the depth image `to`, in both directions. Both images
/// are of `camera`. A pair that overlaps by less than a fifth has the disagreement 1.
DepthDifference depth_difference(const DepthImage& from, const DepthImage& to, const Intrinsics& camera,
                                 const Eigen::Isometry3d& T_to_from);

/// Returns 1 - the correlation of brightness between the points of `from` and the pixels of `to` where they
/// are seen; nullopt if too few points are seen in both, or a surface without texture.
std::optional<double> brightness_disagreement(const ComparedFrame& from, const ComparedFrame& to,
                                              const Intrinsics& camera, const Eigen::Isometry3d& T_to_from);

// The functions below compare all pairs whose frames can be read and have depth and poses, as if all depths
// were multiplied by depth_factor, and with a camera that is right but for `error`.

/// Mean difference over all pairs; DepthDifference{} without any.
DepthDifference mean_difference(const std::vector<FramePair>& pairs, ComparedFrames& samples,
                                const PoseOf& pose_of_position, double depth_factor = 1.0,
                                const CameraError& error = {});

/// Mean disagreement in brightness over all pairs; nullopt: fewer than half of them have texture.
std::optional<double> mean_brightness_disagreement(const std::vector<FramePair>& pairs,
                                                   ComparedFrames& samples, const PoseOf& pose_of_position,
                                                   double depth_factor, const CameraError& error);

/// Returns the disagreement of depth plus that of brightness of each pair; unset: a frame has no pose.
std::vector<std::optional<double>> pair_disagreements(const std::vector<FramePair>& pairs,
                                                      ComparedFrames& samples, const PoseOf& pose_of_position,
                                                      double depth_factor, const CameraError& error);

/// Returns the number of pairs whose depth agrees, and that of all compared ones.
std::pair<std::size_t, std::size_t> count_agreeing(const std::vector<FramePair>& pairs,
                                                   ComparedFrames& samples, const PoseOf& pose_of_position);

}  // namespace roomradar
