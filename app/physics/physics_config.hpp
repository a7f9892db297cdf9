// physics_config.hpp: settings of the rigid bodies' physics.
#pragma once
#include <Eigen/Core>

namespace roomradar {

struct PhysicsConfig {
  Eigen::Vector3d gravity_world_mps2{0.0, 0.0, -9.81};
  /// Fraction of the normal velocity returned by an impact, 0..1; 0 for impacts below bounce_mps.
  double restitution = 0.0;
  double bounce_mps = 0.3;  ///< min impact speed for restitution
  double friction = 0.5;    ///< Coulomb's coefficient, >= 0
  /// Rolling resistance: max torque = this x normal force x contact offset; >= 0. A ball that rolls at 0.5
  /// m/s stops after 0.9 m.
  double rolling = 0.02;
  /// Gap kept to surfaces, in addition to the radar's uncertainty (lower_m is less than the true distance).
  /// Without a gap, rounding would decide between rest and overlap.
  double contact_margin_m = 0.001;
  double max_step_s = 1.0 / 60.0;  ///< max substep, exceeded by 5 % at most
  /// Max time simulated per call; the rest is dropped (a stalled camera must not launch objects).
  double max_advance_s = 0.5;
  int max_slides = 16;           ///< max stops at contacts per substep; the rest of the substep is dropped
  double sleep_drift_m = 0.012;  ///< max motion of any point over sleep_after_s to fall asleep on a support
  double sleep_after_s = 0.3;
  double wake_gap_m = 0.012;         ///< asleep: wakes if its support sinks by more; sensor noise is a few mm
  double wake_moved_m = 0.001;       ///< asleep: wakes if another body it touched moves by more than this
  double wake_overlap_m = 0.008;     ///< asleep: wakes and is moved out if a surface enters by more than this
  double overlap_allowed_m = 0.001;  ///< awake: overlap up to this is left uncorrected
  double max_depenetration_mps = 1.0;  ///< max depenetration speed, and max speed of a pushing hand
  double max_speed_mps = 20.0;
  double max_angular_rad_s = 60.0;  ///< max angular velocity, about ten turns per second
};

/// Throws Error such as "physics.friction = -1: must be >= 0".
void require_valid(const PhysicsConfig& config);

}  // namespace roomradar
