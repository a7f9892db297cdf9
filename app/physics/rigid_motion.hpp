// rigid_motion.hpp: a piece of a rigid body's motion: contacts, impulses, and as far as the way is free.
#pragma once
#include <optional>

#include "app/physics/contact_solver.hpp"
#include "app/physics/physics.hpp"

namespace roomradar {

/// A moving surface that pushes the body, for the whole of a step; moving surfaces say nothing else then,
/// since they are in the body yet.
struct Push {
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();  ///< unit, towards the body
  double speed_mps = 0.0;                                  ///< at least so fast along the normal
  Touched touched = Touched::kDynamic;
};

constexpr bool is_moving_surface(Touched kind) {
  return kind == Touched::kDynamic || kind == Touched::kInferredBack;
}

inline constexpr double kSupportCosine = 0.5;  ///< a surface within 60 degrees of level holds a body up

/// Counts it as a surface that was met.
void note_contact(Touched touched, StepReport& report);

struct [[nodiscard]] RigidPiece {
  /// A surface crosses the body that does not push it out: the rest of the piece was not moved.
  bool crosses = false;
  double left_s = 0.0;       ///< of the piece, then
  bool is_held_up = false;   ///< by a contact within 60 degrees of up
  bool is_balanced = false;  ///< held up, it would not begin to move if it stood still
  Touched rests_on = Touched::kNothing;
};

/// What a body touches while it moves; kept from piece to piece of a step.
struct RigidScratch {
  std::vector<NearPoint> near;
  std::vector<SolverContact> contacts;
  std::vector<Touched> kinds;
  std::vector<SolverOther> others;  ///< bodies that are touched
  std::vector<Body*> bodies;        ///< whose these are
};

/// Moves the body on by dt_s, as advance() says it for one piece of a step.
/// @param report  contacts and moves are counted
RigidPiece move_rigidly(Body& body, double dt_s, const BodyProbe& probe, const PhysicsConfig& config,
                        const std::optional<Push>& push, RigidScratch& scratch, StepReport& report);

/// Columns of unit length at right angles again, after any number of turns.
void make_orthonormal(Eigen::Isometry3d& T);

/// At most so far has a point of the body come from where it was: what its centre moved, and what it turned.
double strayed_m(const Body& body, const Eigen::Isometry3d& T_world_before);

/// Centre of mass, in the world.
Eigen::Vector3d centre_world(const Body& body);
/// About the centre, along the world's axes.
Eigen::Matrix3d inertia_world_m2(const Body& body);

}  // namespace roomradar
