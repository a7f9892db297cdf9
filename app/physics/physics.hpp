// physics.hpp: move a virtual object by what the radar answers alone: fall, touch, slide, roll, tip, rest.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "app/physics/mass_properties.hpp"
#include "mapping/types/mesh.hpp"
#include "radar/geometry/contact.hpp"
#include "radar/motion/proximity.hpp"
#include "radar/motion/time_of_impact.hpp"

namespace roomradar {

/// A rigid virtual object.
struct Body {
  std::string name;
  MassProperties mass;
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();  ///< of the centre of mass
  Eigen::Vector3d spin_world_rad_s = Eigen::Vector3d::Zero();    ///< about it, right-handed
  bool at_rest = false;
  double lingered_s = 0.0;  ///< for how long it has been on a support within rest_drift_m of lingers_at
  Eigen::Isometry3d lingers_at = Eigen::Isometry3d::Identity();
  Touched rests_on = Touched::kNothing;  ///< what held it up when it was last moved
  /// Bodies that it touched as it came to rest, and where they were.
  struct Leant {
    const Body* on;
    Eigen::Isometry3d T_world_other;
  };
  std::vector<Leant> leans;
};

struct PhysicsConfig {
  Eigen::Vector3d gravity_world_mps2{0.0, 0.0, -9.81};
  /// Part of the normal velocity that comes back, 0..1; below bounce_mps none does.
  double restitution = 0.0;
  double bounce_mps = 0.3;  ///< slower impacts do not bounce
  double friction = 0.5;    ///< Coulomb's coefficient, >= 0
  /// What holds a rolling body back: a torque of this part of the normal force times its arm, >= 0. A ball
  /// that rolls at 0.5 m/s stops after 0.9 m.
  double rolling = 0.02;
  /// Gap kept to a surface, on top of what the radar's lower bound keeps where it is not exact: a body that
  /// touches could not tell resting from overlap.
  double contact_margin_m = 0.001;
  double max_step_s = 1.0 / 60.0;  ///< a step longer by more than a 20th of it is cut into such pieces
  /// Time past this in one call is dropped (a stalled camera must not launch things).
  double max_advance_s = 0.5;
  int max_slides = 16;  ///< times that a piece of a step may be stopped; what is left of it then is dropped
  double rest_drift_m = 0.012;  ///< no point strays farther on a support for rest_after_s: at rest
  double rest_after_s = 0.3;
  double wake_gap_m = 0.012;         ///< support sank by more than this: falls again; sensor noise is some mm
  double wake_moved_m = 0.001;       ///< another body that it touched moved by more than this: goes on
  double wake_overlap_m = 0.008;     ///< support or a hand came in by more than this: moves out of the way
  double overlap_allowed_m = 0.001;  ///< less is left as it is
  double push_out_mps = 1.0;  ///< fastest way out of an overlap; also the speed of a hand that still pushes
  double max_speed_mps = 20.0;
  double max_spin_rad_s = 60.0;  ///< ten turns a second
};
/// Throws Error "physics.friction = -1: must be >= 0" and the like.
void require_valid(const PhysicsConfig& config);

/// What stands in the way of the object at T_world_object if it moves along a unit direction by up to
/// distance_m. CyberRadar::query bound to the object's mesh and to the frame's scene, or an analytic room in
/// tests.
using TravelQuery = std::function<Contact(const Eigen::Isometry3d& T_world_object,
                                          const Eigen::Vector3d& direction_world, double distance_m)>;

/// A body that is one of the scene's trees.
struct OtherBody {
  Body* body = nullptr;  ///< null: the tree is none
  double gives = 0.0;    ///< as SolverOther::gives; 0: a hand holds it
};

/// What a body asks of the radar as it moves: its own mesh against the frame's scene.
struct BodyProbe {
  TravelQuery travel;
  /// NearField::near() and free_time().
  std::function<Kinds(const Eigen::Isometry3d& T_world_object, double reach_m, Kinds left_out,
                      std::vector<NearPoint>& points)>
      near;
  std::function<FreeTime(const Eigen::Isometry3d& T_world_object, const RigidMotion& motion,
                         double duration_s, double keep_m, Kinds left_out)>
      free_time;
  /// Of the scene's first trees; what has none here stands still.
  std::span<const OtherBody> others = {};
};
/// Of an object's tree. All that is given must stay while the probe is used.
/// @param spent_ms  in which the time of all answers is summed up; may be null
BodyProbe probe_of(CyberRadar& radar, NearField& field, const TriangleTree& object, const RadarScene& scene,
                   double* spent_ms = nullptr);

enum class StepStatus {
  kMoved,    ///< or is free to move, at rest or not
  kHeld,     ///< the radar gave no usable answer: the body stays where it was, its velocity is zero
  kInvalid,  ///< dt or the body itself is not finite: nothing was changed
};

struct [[nodiscard]] StepReport {
  StepStatus status = StepStatus::kMoved;
  int contacts = 0;                                   ///< kinds of surface met, at each stop anew
  std::array<int, kTouchedKinds> contacts_by_kind{};  ///< the same, by what was touched
  int queries = 0;                                    ///< of the radar along a direction
  /// Deepest overlap seen before it was resolved, by the shortest way out, >= 0.
  double deepest_overlap_m = 0.0;
  double deepest_static_overlap_m = 0.0;  ///< the same, with the prescanned room only
  bool woke = false;                      ///< was at rest before and is not any more
};

/// Moves `body` on by dt_s: gravity, contact, Coulomb friction, rest.
///
/// A piece of a step: where the body nearly touches (near) are its contacts. Impulses there turn back what
/// enters them (with restitution, if fast), then hold it up against gravity over the piece and rub (without).
/// With the mean of the velocities before and after, it goes on for as long as that is free (free_time); what
/// is left of the piece begins anew from there. So nothing is tunnelled through, moving or turning, however
/// large the step is. Between contacts the path is a parabola and the angular momentum stays.
///
/// Of probe.others, what is met gets the impulse that the body loses: its velocity is changed, and with that
/// it goes on, from rest too, when it is advanced itself. One at rest that is met at less than 5 cm/s stays,
/// or whatever settles on it would keep it awake; weight alone does not tip it either.
///
/// A body that a surface came into is first moved out of it, along gravity by a shift, sideways with the
/// speed that a hand has that came so far in dt_s, at the place that is deepest: it slides, turns or tips.
/// While it crosses a surface yet, it is moved without turning, by the radar along its way.
///
/// @param dt_s   seconds since the last call, >= 0; 0 changes nothing
/// @param push_directions_world  unit directions from the body to moving surfaces (push_directions): an
///               overlap there moves the body away by the shortest of these ways; may be empty
/// A body at rest is asked about along gravity only (and along push_directions), and does not move by noise.
/// One that touched another body as it came to rest is woken when that moves on, or is there no more: it goes
/// with it, or tips where that is drawn from under it.
/// A body at rest with a velocity is woken by it. Steps longer than max_advance_s count as that.
StepReport advance(Body& body, double dt_s, const BodyProbe& probe, const PhysicsConfig& config,
                   std::span<const Eigen::Vector3d> push_directions_world = {});

/// Whether what `back` asks about, the inferred backs of what moved, has come about the body rather than
/// against it: deeper than anything comes that still pushes, whichever way out is taken. Such a back is no
/// reason to throw a body about: leave it out of the scene until this is over.
bool is_swallowed(const Body& body, double dt_s, const TravelQuery& back, const PhysicsConfig& config,
                  std::span<const Eigen::Vector3d> push_directions_world);

/// Horizontal unit directions from a body to the moving surfaces about it: to the nearest vertex and to the
/// mean of all vertices of these meshes within reach_m of centre_world. None, one or two.
struct PushDirections {
  int count = 0;
  std::array<Eigen::Vector3d, 2> direction_world{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  [[nodiscard]] std::span<const Eigen::Vector3d> span() const {
    return {direction_world.data(), static_cast<std::size_t>(count)};
  }
};
PushDirections push_directions(std::initializer_list<const Mesh*> moving_world,
                               const Eigen::Vector3d& centre_world, double reach_m,
                               const Eigen::Vector3d& up_world = Eigen::Vector3d::UnitZ());

}  // namespace roomradar
