// timing_evidence.hpp: what the residuals of an alignment say about the times at which a sensor reads its
// rows.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "mapping/alignment/rolling_shutter.hpp"
#include "mapping/alignment/view.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Corrections of a sensor's parameters: depth readout, colour readout and colour delay (s), then an offset
/// of inverse depth (1/m) a x + b y + c x^2 + d x y + e y^2, where x and y are 0 in the image's middle and x
/// is 1 at its right border. The offset is not applied; left out, a distortion of the depth would be taken
/// for a time.
inline constexpr int kTimingParameters = 8;
using TimingVector = Eigen::Matrix<double, kTimingParameters, 1>;
using TimingMatrix = Eigen::Matrix<double, kTimingParameters, kTimingParameters>;

/// Normal equations H x = b of the corrections x. Sums over frames are the evidence of all of them.
struct TimingEvidence {
  TimingMatrix H = TimingMatrix::Zero();
  TimingVector b = TimingVector::Zero();
};

/// A view and the camera's velocity when it was taken. The delay of colour is judged by the steady velocity:
/// the noise of a pose moves the points and changes the velocity, which would be taken for a delay.
struct MovingView {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  CameraVelocity velocity;
  CameraVelocity steady_velocity;  ///< mean over several frames
};

/// Linearises the residuals of an aligned image in the camera's pose and in the parameters, and eliminates
/// the pose. Images taken at equal velocities say nothing about times. Uses every fourth point of the level
/// before the finest, or of the only one.
/// @param live    points of the image before any correction
/// @param timing  times with which the views were aligned; points move with them
TimingEvidence timing_evidence(const SourcePoints& live, const MovingView& camera,
                               const TargetView& reference, const MovingView& view,
                               const SensorTiming& timing);

}  // namespace roomradar
