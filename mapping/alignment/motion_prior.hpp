// motion_prior.hpp: combines the recorded motion of a camera with poses from alignment.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>

#include "mapping/alignment/align.hpp"

namespace roomradar {

/// Distance at which an error of rotation is measured as a length: 1 rad counts as this many m.
inline constexpr double kPriorLever_m = 1.5;

struct RecordedPose {
  double stamp_s = 0.0;
  Eigen::Isometry3d T_recorded_camera = Eigen::Isometry3d::Identity();
};

/// Recorded poses (of a phone, a robot, motion capture) as a prior on the camera's motion. Only relative
/// recorded poses are used: a slowly varying correction maps the recorded world to the tracker's world, so
/// that drift of the recorded poses is followed. The noise of a recorded pose is estimated from its
/// differences to well constrained alignments.
struct MotionPrior {
  /// Maps points of the recorded world to the tracker's world; unset until a frame with a recorded pose is
  /// tracked, and after an interruption.
  std::optional<Eigen::Isometry3d> T_world_recorded;
  /// Standard deviation of a recorded pose, m; a rotation counts as kPriorLever_m per rad. At least jitter_m.
  double sigma_m = 0.003;
  /// Standard deviation of the noise from frame to frame, m, from accelerations that no hand and no robot
  /// has, see note_recorded(). 0: none, or the frames are too far apart to tell.
  double jitter_m = 0.0;
  /// The last two recorded poses, the newer one second; unset before them.
  std::array<std::optional<RecordedPose>, 2> recorded;
  /// Ring of the last distances, m, by which a pose was farther from the line between its neighbours than a
  /// camera's acceleration allows.
  std::array<double, 15> excess_m{};
  std::int64_t excesses = 0;  ///< number of distances so far; the next one goes to excesses % excess_m.size()
  /// Exponential mean of the absolute difference between prior and alignment per constrained direction, m;
  /// < 0: none yet.
  double mean_difference_m = -1.0;
  /// Number of the current uninterrupted stretch of recorded poses. Relative poses are only used within one.
  std::int64_t stretch = 0;
  std::int64_t used = 0;                   ///< number of frames whose pose the prior has constrained
  std::int64_t contradicted = 0;           ///< number of frames whose depth contradicted the prior
  std::int64_t contradicted_in_a_row = 0;  ///< number of those up to now without one that agreed
};

/// Updates jitter_m. Call once per frame with a recorded pose, in order. Three consecutive poses of a camera
/// whose acceleration is limited are nearly on a line; what exceeds the limit is noise of the poses.
void note_recorded(MotionPrior& prior, double stamp_s, const Eigen::Isometry3d& T_recorded_camera);

/// Returns the pose that the prior predicts; nullopt without T_world_recorded or recorded pose.
std::optional<Eigen::Isometry3d> predicted_by(const MotionPrior& prior,
                                              const std::optional<Eigen::Isometry3d>& T_recorded_camera);

/// Combines the prior with an alignment that started from it, each weighted by its uncertainty. An
/// alignment's errors are correlated from frame to frame, so its standard deviation is at least 4 mm per
/// direction. Directions that the alignment does not constrain keep the prior. If the alignment
/// contradicts() the prior, the prior's weight is that of its difference.
/// Updates the estimates of the prior's noise and of its drift.
/// @param dt_s  time since the last frame
/// @return the combined pose; kTracked, since the prior constrains all directions
Tracking combine(MotionPrior& prior, const Eigen::Isometry3d& T_world_prior, const Tracking& aligned,
                 double dt_s);

/// Returns the largest difference between prior and alignment along a direction that the alignment
/// constrains, m. Rotations count as kPriorLever_m per rad.
double constrained_difference_m(const Eigen::Isometry3d& T_world_prior, const Tracking& aligned);

/// Returns true if a constrained_difference_m() is more than 3 cm plus five standard deviations.
bool contradicts(const MotionPrior& prior, double difference_m);

/// Counts a frame whose depth contradicts the prior, which is then not to be used in it. A single frame may
/// have a bad pose or bad depth. At the third in a row, the recorded world has jumped: interrupts the prior.
void count_contradiction(MotionPrior& prior);

/// Ends the current stretch: recorded poses before and after have no known relation. The next tracked frame
/// with a recorded pose begins a new stretch, see restart_prior().
void interrupt_prior(MotionPrior& prior);

/// Sets the correction so that the prior predicts T_world_camera for a frame with this recorded pose.
void restart_prior(MotionPrior& prior, const Eigen::Isometry3d& T_world_camera,
                   const Eigen::Isometry3d& T_recorded_camera);

/// Information (inverse covariance) of the relative pose of two cameras by the prior, as a twist in the frame
/// of the second camera. Drift is assumed to be 0.5 % of the distance, in addition to the noise.
Eigen::Matrix<double, 6, 6> prior_information(double sigma_m, const Eigen::Isometry3d& T_a_b);

/// Limits the information of an alignment to that of a standard deviation of 6 mm per direction.
Eigen::Matrix<double, 6, 6> limited_information(const Eigen::Matrix<double, 6, 6>& information);

}  // namespace roomradar
