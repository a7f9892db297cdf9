// moving_body.hpp: a body that is advanced together with others, and its progress.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "app/physics/body.hpp"
#include "app/physics/collision_queries.hpp"
#include "app/physics/contact_solver.hpp"
#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

/// A body of a call of advance_together(). Refers to the body, which alone has its pose and velocities.
struct AdvancedBody {
  Body* body = nullptr;
  /// Queries against a scene that contains all other bodies at their current poses.
  const CollisionQueries* probe = nullptr;
  /// The trees of the probe's scene. The call keeps those of its bodies (CollisionQueries::others) at their
  /// poses. May be empty if no other body of the call is in the scene.
  std::span<SceneTree> scene{};
  double mass_kg = 1.0;  ///< > 0
  /// A user carries the body: it moves at its given velocity, without gravity, friction and restitution.
  /// Other bodies hardly slow it.
  bool is_carried = false;
  double dt_s = 0.0;  ///< time since the body was last advanced, >= 0; 0 changes nothing
  /// No surface has moved near the body since it was last advanced, except bodies that were advanced with it.
  /// Then nothing can overlap it, overlaps are not queried, and a sleeping body costs no computing time.
  bool is_undisturbed = false;
  /// Dynamic surfaces grip the body from two sides. The gripping surfaces may overlap the body, and do not
  /// push it. The caller also sets is_carried, and the body's velocity to theirs.
  bool is_gripped = false;
  /// Speed of the dynamic surfaces near the body. The max speed at which they push the body is the larger of
  /// 1.5 times this speed and PhysicsConfig::max_depenetration_mps.
  double surface_speed_mps = 0.0;
  /// Directions towards dynamic surfaces, see depenetration_directions(); may be empty.
  std::span<const Eigen::Vector3d> depenetration_directions_world{};
  StepReport report{};  ///< out
  /// Out: closest features within contact distance before the body's last motion. Unchanged while it sleeps.
  /// The features of a pair of moving bodies are listed for one of the two only. ClosestPoint::tree is the
  /// index of a tree in the probe's scene.
  std::vector<ClosestPoint> near{};
};

/// A contact at which a dynamic surface pushes the body throughout a step. Until the push ends, dynamic
/// surfaces intersect the body, so the step ignores all other contacts with them.
struct Push {
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();  ///< unit, towards the body
  /// Min speed of the body at point_world along the normal. Negative: the body may approach the surface, at
  /// up to -speed_mps.
  double speed_mps = 0.0;
  SurfaceKind touched = SurfaceKind::kDynamic;
};

/// Dynamic surfaces and their inferred backs.
inline constexpr SurfaceKindMask kMovingSurfaces =
    bit_of(SurfaceKind::kDynamic) | bit_of(SurfaceKind::kInferredBack);
constexpr bool is_moving_surface(SurfaceKind kind) { return (bit_of(kind) & kMovingSurfaces) != 0; }

/// Plane fitted to a tree of the scene about a point.
struct PatchPlane {
  std::uint32_t tree = 0;
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();
  FittedPlane plane;
};

/// What holds a body in a substep.
struct SubstepResult {
  bool is_held_up = false;   ///< a surface within 60 degrees of level, or all contacts together, support it
  bool is_balanced = false;  ///< supported, and would stay at rest if all bodies stopped
  /// Kind of the supporting surface with the greatest normal impulse.
  SurfaceKind rests_on = SurfaceKind::kNothing;
  std::vector<const Body*> touches{};  ///< other bodies in contact
};

/// The progress of a body in a call of advance_together(). Refers to what the caller says of the body.
struct MovingBody {
  AdvancedBody& in;
  Body& body = *in.body;
  const CollisionQueries& probe = *in.probe;
  double dt_s = 0.0;                     ///< length of the substep
  std::vector<TreeInstance*> seen_as{};  ///< the body in the scenes of the others; see show()
  /// Per tree of the probe's scene: index of the tree's body among the substep's bodies; kNoOther if it has
  /// none.
  std::vector<std::size_t> member_of_tree{};
  std::vector<Push> pushes{};    ///< pushes by dynamic surfaces that overlap the body
  SurfaceKindMask left_out = 0;  ///< kinds excluded from the contacts, because they push or grip the body
  std::vector<PatchPlane> patches{};  ///< fitted in this call
  bool contacts_known = false;        ///< sleeping bodies: contacts are in the system

  bool was_asleep = false;  ///< when the substep began
  double left_s = 0.0;      ///< time of the substep that remains to be simulated
  /// A surface other than the pushing one intersects the body. The contact solver then does not move it.
  bool crosses = false;
  ClosestPoint limited_by{};         ///< feature that ended the body's last motion
  int stops_in_place = 0;            ///< motions in this substep that hardly moved the body
  std::vector<ClosestPoint> near{};  ///< closest features at its pose
  std::size_t near_found = 0;        ///< size of `near` without the feature that ended the body's last motion
  /// Pose at which the body's features were queried in this substep; unset if they were not.
  std::optional<Eigen::Isometry3d> T_world_near{};
  SubstepResult result{};
};

/// Returns true if the body is awake, has time left in the substep, and no surface intersects it.
inline bool is_active(const MovingBody& moving) {
  constexpr double kNoTime_s = 1e-12;
  return !moving.body.asleep && !moving.crosses && moving.left_s > kNoTime_s;
}

/// Gives the body's trees in the scenes of the others its pose.
inline void show(const MovingBody& moving) {
  for (TreeInstance* tree : moving.seen_as) tree->T_world_mesh = moving.body.T_world_object;
}

}  // namespace roomradar
