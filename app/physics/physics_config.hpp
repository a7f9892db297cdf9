// physics_config.hpp: settings of rigid-body physics.
#pragma once
#include <Eigen/Core>

namespace roomradar {

struct PhysicsConfig {
  Eigen::Vector3d gravity_world_mps2{0.0, 0.0, -9.81};
  /// Restitution coefficient, 0..1. Impacts up to bounce_mps have no restitution.
  double restitution = 0.0;
  double bounce_mps = 0.3;  ///< min impact speed for restitution
  double friction = 0.5;    ///< Coulomb's coefficient, >= 0
  /// Rolling resistance coefficient, >= 0. Max torque = `rolling` x normal force x distance of the centre of
  /// mass from the contact's tangent plane (a ball's radius). With 0.02, a ball that rolls at 0.5 m/s stops
  /// after 0.9 m.
  double rolling = 0.02;
  /// Gap between resting bodies and surfaces, measured by Contact::lower_m (the radar's lower bound of the
  /// distance). Without a gap, rounding errors would turn contacts into overlaps.
  double contact_margin_m = 0.001;
  /// Impulses act along the normal of the plane fitted to the room's surface within this distance of a
  /// contact, if the surface is flat there within `roughness_m`. 0: along the normal of the feature in
  /// contact.
  double patch_reach_m = 0.09;
  /// Max standard deviation of a surface from the fitted plane, m: a map's noise. Features that rise over the
  /// plane by more than 1.5 times this are steps.
  double roughness_m = 0.002;
  double max_step_s = 1.0 / 60.0;  ///< max substep, exceeded by 5 % at most
  /// Max time simulated per call of advance(). Time beyond it is discarded, so that objects do not jump after
  /// a camera stall.
  double max_advance_s = 0.5;
  /// Max number of contact events per substep. The time left after the last event is not simulated.
  int max_contact_events = 16;
  /// A supported body falls asleep if all its points move by at most this within sleep_after_s.
  double sleep_drift_m = 0.012;
  /// Time at rest before a balanced body falls asleep. An unbalanced body needs four times as long.
  double sleep_after_s = 0.3;
  /// A sleeping body wakes if the gap to its support exceeds contact_margin_m by more than this. Sensor noise
  /// is a few mm.
  double wake_gap_m = 0.012;
  /// A sleeping body wakes if a body that it touches moves farther than this.
  double wake_moved_m = 0.001;
  /// A sleeping body wakes and is moved out if it overlaps a surface by more than this. The threshold is
  /// lower for a moving surface (see advance_together()).
  double wake_overlap_m = 0.008;
  double overlap_allowed_m = 0.001;  ///< overlaps of an awake body up to this depth are not corrected
  /// Max speed at which surfaces push a body or move it out of an overlap. Faster dynamic surfaces raise it,
  /// see max_push_mps().
  double max_depenetration_mps = 1.0;
  double max_speed_mps = 20.0;
  double max_angular_rad_s = 60.0;  ///< about ten revolutions per second
};

/// Throws Error such as "physics.friction = -1: must be >= 0".
void require_valid(const PhysicsConfig& config);

}  // namespace roomradar
