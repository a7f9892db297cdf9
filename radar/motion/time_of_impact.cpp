// time_of_impact.cpp: steps that an inflated object proves free, and poses that prove the contact.
#include "radar/motion/time_of_impact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "radar/geometry/infinity.hpp"

namespace roomradar {
namespace {

constexpr double kNoTurn_m = 1e-9;  // below the precision of double poses far from the origin

bool is_valid(const RigidMotion& motion, double duration_s, const TimeOfImpactConfig& config) {
  return motion.linear_m_s.allFinite() && motion.angular_rad_s.allFinite() &&
         motion.centre_object.allFinite() && std::isfinite(duration_s) && duration_s >= 0.0 &&
         std::isfinite(config.tolerance_m) && config.tolerance_m > 0.0 && config.max_queries > 0 &&
         std::isfinite(motion.linear_m_s.stableNorm() * duration_s) &&
         std::isfinite(motion.angular_rad_s.stableNorm() * duration_s);
}

/// Capsule that contains the object in every orientation: all points within radius_m of a segment of the
/// axis.
struct Capsule {
  double radius_m = 0.0;
  double from_m = 0.0, to_m = 0.0;  // along the axis, from the centre of rotation
};

Capsule capsule_of(const TreeInstance& object, const RigidMotion& motion) {
  const Eigen::Vector3d axis =
      object.T_world_mesh.linear().transpose() * motion.angular_rad_s.stableNormalized();
  const Eigen::Vector3d middle = object.tree->origin() + object.tree->centre() - motion.centre_object;
  Capsule capsule{0.0, kInfinity<double>, -kInfinity<double>};
  for (int i = 0; i < 8; ++i) {  // corners of the object's box suffice: both measures are convex
    const Eigen::Vector3d side((i & 1) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0,
                               (i & 4) != 0 ? 1.0 : -1.0);
    const Eigen::Vector3d corner = middle + side.cwiseProduct(object.tree->half_size().cast<double>());
    capsule.radius_m = std::max(capsule.radius_m, axis.cross(corner).norm());
    capsule.from_m = std::min(capsule.from_m, axis.dot(corner));
    capsule.to_m = std::max(capsule.to_m, axis.dot(corner));
  }
  return capsule;
}

/// Returns the capsule's axis segment as a mesh without area, with the centre of rotation as origin and world
/// axes.
TriangleTree axis_tree(const Capsule& capsule, const RigidMotion& motion) {
  const Eigen::Vector3d axis = motion.angular_rad_s.stableNormalized();
  Mesh line;
  line.vertices = {(capsule.from_m * axis).cast<float>(), (capsule.to_m * axis).cast<float>()};
  line.triangles = {{0, 1, 1}};
  TriangleTree tree;
  tree.build_in_order(line);
  return tree;
}

bool is_answer(const Contact& contact) {
  return contact.status != ContactStatus::kInvalidInput && contact.status != ContactStatus::kNoAnswer;
}

TimeOfImpactStatus failure(const Contact& contact) {
  return contact.status == ContactStatus::kNoAnswer ? TimeOfImpactStatus::kNoAnswer
                                                    : TimeOfImpactStatus::kInvalidInput;
}

/// A sweep in progress.
struct Course {
  CyberRadar& radar;
  const TreeInstance& object;
  const RigidMotion& motion;
  const RadarScene& scene;
  const TimeOfImpactConfig& config;
  Capsule capsule;
  TriangleTree axis;       // axis segment of the capsule
  double speed_m_s = 0.0;  // speed of the centre
  double turn_rad_s = 0.0;
  int queries = 0;

  [[nodiscard]] bool has_queries() const { return queries < config.max_queries; }

  /// Returns the max distance of any point from its place in a straight motion with the half-way orientation.
  [[nodiscard]] double straying_m(double step_s) const {
    constexpr double kRounding = 1.0 + 1e-9;
    return 2.0 * capsule.radius_m * std::sin(0.5 * std::min(0.5 * turn_rad_s * step_s, std::numbers::pi)) *
           kRounding;
  }
  /// Returns an upper bound of every point's path length in the step.
  [[nodiscard]] double path_length_m(double step_s) const {
    return (speed_m_s + turn_rad_s * capsule.radius_m) * step_s;
  }

  Contact ask(const TreeInstance& what, const Eigen::Vector3d& direction, double distance_m,
              double margin_m) {
    ++queries;
    return radar.query(
        {.object = what, .direction_world = direction, .distance_m = distance_m, .margin_m = margin_m},
        scene);
  }

  /// Returns the object's pose at start_s, but with its orientation half-way through the step.
  [[nodiscard]] Eigen::Isometry3d half_turned(double start_s, double step_s) const {
    Eigen::Isometry3d T_world_mesh = pose_after(object.T_world_mesh, motion, start_s + 0.5 * step_s);
    T_world_mesh.pretranslate(-0.5 * step_s * motion.linear_m_s);
    return T_world_mesh;
  }

  struct Step {
    Contact contact;
    double free_s = 0.0;
  };
  Step try_step(double start_s, double step_s) {
    const double straight_m = speed_m_s * step_s;
    // Slow, or rotating in place: only the margin matters, but a query needs a positive distance.
    const double distance_m = std::max(straight_m, 1e-3 * config.tolerance_m);
    const Eigen::Vector3d direction = speed_m_s > 0.0 ? motion.linear_m_s : motion.angular_rad_s;
    Step step;
    if (straying_m(step_s) > capsule.radius_m) {
      Eigen::Isometry3d T_world_axis = Eigen::Isometry3d::Identity();
      T_world_axis.translation() = object.T_world_mesh * motion.centre_object + start_s * motion.linear_m_s;
      // float vertices of the segment
      const double rounding_m = 1e-6 * (std::abs(capsule.from_m) + std::abs(capsule.to_m));
      step.contact = ask({&axis, T_world_axis}, direction, distance_m, capsule.radius_m + rounding_m);
    } else {
      step.contact =
          ask({object.tree, half_turned(start_s, step_s)}, direction, distance_m, straying_m(step_s));
    }
    const bool is_clear = step.contact.status == ContactStatus::kNoTarget ? step.contact.lower_m >= straight_m
                                                                          : step.contact.lower_m > straight_m;
    if (is_clear) {
      step.free_s = step_s;
    } else if (step.contact.lower_m > 0.0 && speed_m_s > 0.0) {
      step.free_s = std::min(step.contact.lower_m / speed_m_s, step_s);
    }
    return step;
  }

  /// Returns kOverlap if the object's pose at time_s overlaps the scene, kFree if not, or why that is
  /// unknown. Queries along the motion first, then along all axes, since scene that an object leaves is no
  /// overlap in that direction.
  TimeOfImpactStatus state_at(double time_s, Contact& contact) {
    const Eigen::Isometry3d T_world_mesh = pose_after(object.T_world_mesh, motion, time_s);
    const std::array<Eigen::Vector3d, 7> directions = {motion.linear_m_s,         Eigen::Vector3d::UnitX(),
                                                       -Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(),
                                                       -Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ(),
                                                       -Eigen::Vector3d::UnitZ()};
    for (const Eigen::Vector3d& direction : directions) {
      if (!(direction.stableNorm() > 0.0)) continue;
      if (!has_queries()) return TimeOfImpactStatus::kOutOfQueries;
      const Contact got = ask({object.tree, T_world_mesh}, direction, config.tolerance_m, 0.0);
      if (!is_answer(got)) return failure(got);
      if (got.status != ContactStatus::kOverlap) continue;
      contact = got;
      return TimeOfImpactStatus::kOverlap;
    }
    return TimeOfImpactStatus::kFree;
  }
  bool meets(double time_s, Contact& contact) {
    return state_at(time_s, contact) == TimeOfImpactStatus::kOverlap;
  }
};

/// Without rotation: uses the radar's own bounds.
void time_of_impact_straight(Course& course, double duration_s, TimeOfImpact& result) {
  const Contact contact =
      course.ask(course.object, course.motion.linear_m_s, course.speed_m_s * duration_s, 0.0);
  result.contact = contact;
  if (!is_answer(contact)) {
    result.status = failure(contact);
    return;
  }
  if (contact.status == ContactStatus::kOverlap) {
    result.status = TimeOfImpactStatus::kOverlap;
    result.contact_s = 0.0;
    return;
  }
  const ContactTime time = contact_time(contact, course.speed_m_s);
  result.safe_s = std::min(time.lower_s, duration_s);
  if (contact.status == ContactStatus::kNoTarget && result.safe_s >= duration_s * (1.0 - 1e-12)) {
    result.status = TimeOfImpactStatus::kFree;
    result.safe_s = duration_s;
    return;
  }
  result.status = TimeOfImpactStatus::kContact;
  result.contact_s = time.upper_s;
}

/// Finds the contact and its time, after a step of least length stopped the sweep.
void find_contact(Course& course, double step_s, double duration_s, const Contact& stopped_by,
                  TimeOfImpact& result) {
  result.status = TimeOfImpactStatus::kContact;
  result.contact = stopped_by;
  if (course.meets(result.safe_s, result.contact)) {
    result.contact_s = result.safe_s;
    if (result.safe_s == 0.0) result.status = TimeOfImpactStatus::kOverlap;
    return;
  }
  constexpr int kProbes = 10;  // the last one is 38 shortest steps ahead; later contacts count as a graze
  for (int i = 0; i < kProbes; ++i) {
    const double time_s = std::min(result.safe_s + step_s * std::pow(1.5, i), duration_s);
    if (course.meets(time_s, result.contact)) {
      result.contact_s = time_s;
      return;
    }
    if (time_s >= duration_s) break;
  }
  if (!(course.speed_m_s > 0.0) || !course.has_queries()) return;
  const Eigen::Isometry3d T_world_mesh = pose_after(course.object.T_world_mesh, course.motion, result.safe_s);
  const Contact ahead = course.ask({course.object.tree, T_world_mesh}, course.motion.linear_m_s,
                                   40.0 * course.config.tolerance_m, 0.0);
  if (ahead) result.contact = ahead;
}

void time_of_impact_turning(Course& course, double duration_s, TimeOfImpact& result) {
  // A rotation in place returns to its start after a full turn.
  const double turn_s = 2.0 * std::numbers::pi / course.turn_rad_s;
  const double end_s = course.speed_m_s > 0.0 ? duration_s : std::min(duration_s, turn_s * (1.0 + 1e-9));
  double step_s = duration_s;
  while (result.safe_s < end_s) {
    if (!course.has_queries()) {
      result.status = TimeOfImpactStatus::kOutOfQueries;
      return;
    }
    const bool is_last = step_s >= duration_s - result.safe_s;  // one query may show all the rest free
    if (is_last) step_s = duration_s - result.safe_s;
    const Course::Step step = course.try_step(result.safe_s, step_s);
    if (!is_answer(step.contact)) {
      result.status = failure(step.contact);
      result.contact = step.contact;
      return;
    }
    if (step.free_s >= step_s) {
      result.safe_s = is_last ? duration_s : result.safe_s + step_s;
      step_s *= 2.0;
      continue;
    }
    result.safe_s += step.free_s;
    if (course.path_length_m(step_s) <= course.config.tolerance_m) {
      find_contact(course, step_s, duration_s, step.contact, result);
      return;
    }
    step_s *= 0.5;
  }
  result.safe_s = duration_s;
  result.status = TimeOfImpactStatus::kFree;
}

}  // namespace

ContactTime contact_time(const Contact& contact, double speed_m_s) {
  if (contact.status == ContactStatus::kInvalidInput || contact.status == ContactStatus::kNoAnswer) return {};
  if (contact.status == ContactStatus::kOverlap) return {0.0, 0.0};
  if (!(speed_m_s > 0.0)) return {kInfinity<double>, kInfinity<double>};
  return {std::max(contact.lower_m, 0.0) / speed_m_s, contact.upper_m / speed_m_s};
}

Eigen::Isometry3d pose_after(const Eigen::Isometry3d& T_world_object, const RigidMotion& motion,
                             double time_s) {
  Eigen::Isometry3d T_world_moved = T_world_object;
  const double angle = motion.angular_rad_s.stableNorm() * time_s;
  if (angle > 0.0) {
    T_world_moved.linear() = Eigen::AngleAxisd(std::remainder(angle, 2.0 * std::numbers::pi),
                                               motion.angular_rad_s.stableNormalized())
                                 .toRotationMatrix() *
                             T_world_object.linear();
  }
  const Eigen::Vector3d centre_world = T_world_object * motion.centre_object + time_s * motion.linear_m_s;
  T_world_moved.translation() = centre_world - T_world_moved.linear() * motion.centre_object;
  return T_world_moved;
}

TimeOfImpact time_of_impact(CyberRadar& radar, const TreeInstance& object, const RigidMotion& motion,
                            double duration_s, const RadarScene& scene, const TimeOfImpactConfig& config) {
  TimeOfImpact result;
  if (object.tree == nullptr || object.tree->empty() || !object.T_world_mesh.matrix().allFinite() ||
      !is_valid(motion, duration_s, config)) {
    return result;
  }
  result.T_world_object = object.T_world_mesh;
  Course course{radar,
                object,
                motion,
                scene,
                config,
                capsule_of(object, motion),
                {},
                motion.linear_m_s.stableNorm(),
                motion.angular_rad_s.stableNorm()};
  const bool turns = course.straying_m(duration_s) > kNoTurn_m;
  if (turns) course.axis = axis_tree(course.capsule, motion);
  if (course.speed_m_s * duration_s == 0.0 && !turns) {
    result.status = course.state_at(0.0, result.contact);
    if (result.status == TimeOfImpactStatus::kOverlap) result.contact_s = 0.0;
    if (result.status == TimeOfImpactStatus::kFree) result.safe_s = duration_s;
  } else if (!turns) {
    time_of_impact_straight(course, duration_s, result);
  } else {
    time_of_impact_turning(course, duration_s, result);
  }
  result.queries = course.queries;
  result.T_world_object = pose_after(object.T_world_mesh, motion, result.safe_s);
  return result;
}

}  // namespace roomradar
