// timing_evidence.hpp: normal equations for a sensor's readout times and colour delay, from an alignment's
// residuals.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "mapping/alignment/rolling_shutter.hpp"
#include "mapping/alignment/view.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Parameters: corrections of depth readout, colour readout and colour delay (s), then the five coefficients
/// of an inverse-depth offset (1/m) a x + b y + c x^2 + d x y + e y^2. Here x and y are 0 at the image's
/// centre and x is 1 at its right border. The offset is estimated but not applied. Without it, distortion of
/// the depth would bias the times.
inline constexpr int kTimingParameters = 8;
using TimingVector = Eigen::Matrix<double, kTimingParameters, 1>;
using TimingMatrix = Eigen::Matrix<double, kTimingParameters, kTimingParameters>;

/// Normal equations H x = b of the corrections x. Equations of several frames are added.
struct TimingEvidence {
  TimingMatrix H = TimingMatrix::Zero();
  TimingVector b = TimingVector::Zero();
};

/// Pose and velocity of the camera when a view was taken. The colour delay is estimated with steady_velocity.
/// With `velocity`, the noise of a single pose would look like a delay, since it shifts both the points and
/// the velocity.
struct MovingView {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  CameraVelocity velocity;
  CameraVelocity steady_velocity;  ///< mean over several frames
  SensorTiming timing;             ///< sensor times used to register the view's intensity to its depth
};

/// Linearises the residuals of an aligned image in the camera's pose and in the parameters, and eliminates
/// the pose. The parameters are corrections of camera.timing. If the reference's intensity was registered
/// with sensor times other than camera.timing, the displacement due to the difference is subtracted. Two
/// images taken at equal velocities do not constrain the times. Uses every fourth point of the second finest
/// level, or of the only level.
/// @param live  points of the image before any rolling-shutter correction
TimingEvidence timing_evidence(const SourcePoints& live, const MovingView& camera,
                               const TargetView& reference, const MovingView& view);

}  // namespace roomradar
