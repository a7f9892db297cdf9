// sliding.cpp: stops at contacts along the path, and follows surfaces.
#include "app/physics/sliding.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "app/physics/contact_system.hpp"

namespace roomradar {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kShortest_m = 1e-13;  // shorter moves count as none
constexpr double kGrazing = 0.05;      // min cosine that converts the margin to a distance along the motion

/// Returns false if the radar's result is unusable. Replaces a normal that is missing or does not face the
/// object by -direction.
bool make_usable(Contact& contact, const Vec3& direction) {
  if (contact.status == ContactStatus::kInvalidInput || contact.status == ContactStatus::kNoAnswer)
    return false;
  if (!contact) return true;
  // lower_m of an overlap may be -infinity: deeper than the radar searched.
  const bool has_lower = std::isfinite(contact.lower_m) || contact.status == ContactStatus::kOverlap;
  if (!std::isfinite(contact.contact_distance_m) || !has_lower) return false;
  const double length = contact.normal_world.norm();
  const bool faces_object =
      std::isfinite(length) && length > 0.5 && contact.normal_world.dot(direction) < -1e-3 * length;
  contact.normal_world = faces_object ? Vec3(contact.normal_world / length) : Vec3(-direction);
  return true;
}

/// Normals of the surfaces met so far in one call of slide().
struct MetSurfaces {
  std::array<Vec3, 2> normals;
  int count = 0;
};

/// Removes the velocity into the surface (with restitution and friction), and the remaining motion into it.
/// With two surfaces, the motion continues along their crease; with three, it ends.
void collide(Body& body, const Contact& contact, const PhysicsConfig& config, MetSurfaces& met,
             Vec3& remaining) {
  const Vec3& normal = contact.normal_world;
  Vec3& velocity = body.velocity_world_mps;
  const double into_mps = -velocity.dot(normal);
  Vec3 along = velocity + into_mps * normal;
  double kept = 1.0;
  if (into_mps > 0.0) {
    const double speed = along.norm();
    kept = speed > 0.0 ? std::max(1.0 - config.friction * into_mps / speed, 0.0) : 0.0;
    const double back_mps = into_mps > config.bounce_mps ? config.restitution * into_mps : 0.0;
    along *= kept;
    velocity = along + back_mps * normal;
  }
  remaining -= std::min(remaining.dot(normal), 0.0) * normal;
  remaining *= kept;

  for (int i = 0; i < met.count; ++i) {
    const Vec3& other = met.normals[static_cast<std::size_t>(i)];
    if (remaining.dot(other) >= -1e-9) continue;
    const Vec3 crease = other.cross(normal);
    const double length2 = crease.squaredNorm();
    const bool is_corner = met.count == 2 || length2 < 1e-6;
    const auto on_crease = [&](const Vec3& v) -> Vec3 {
      return is_corner ? Vec3::Zero() : Vec3(crease * (crease.dot(v) / length2));
    };
    remaining = on_crease(remaining);
    if (velocity.dot(other) < 0.0) velocity = on_crease(velocity);
    break;
  }
  if (met.count < 2) met.normals[static_cast<std::size_t>(met.count++)] = normal;
}

}  // namespace

Contact query_travel(Body& body, const Vec3& direction_world, double distance_m,
                     const CollisionQueries& probe, StepReport& report) {
  ++report.queries;
  Contact contact = probe.travel(body.T_world_object, direction_world, distance_m);
  if (make_usable(contact, direction_world)) return contact;
  report.status = StepStatus::kHeld;
  body.velocity_world_mps.setZero();
  body.angular_velocity_world_rad_s.setZero();
  return contact;
}

double free_past_overlaps_m(const Body& body, const Vec3& direction_world, double distance_m,
                            SurfaceKindMask overlapping, const CollisionQueries& probe,
                            const PhysicsConfig& config) {
  const Eigen::Isometry3d& T_world_object = body.T_world_object;
  constexpr SurfaceKindMask kObjects = bit_of(SurfaceKind::kObject);
  const std::size_t count = probe.others.size();
  std::vector<ClosestPoint> unused;
  SurfaceKindMask left_out = overlapping | probe.near(T_world_object, kTouching_m, 0, {}, unused);
  if ((left_out & kMovingSurfaces) != 0) left_out |= kMovingSurfaces;
  TreeStates crossing, all_but_one;
  crossing.left_out.assign(count, false);
  all_but_one.left_out.assign(count, true);
  for (std::size_t tree = 0; tree < count; ++tree) {
    if (probe.others[tree].body == nullptr) continue;
    left_out &= ~kObjects;  // each body counts by itself
    all_but_one.left_out[tree] = false;
    crossing.left_out[tree] = probe.near(T_world_object, kTouching_m, ~kObjects, all_but_one, unused) != 0;
    all_but_one.left_out[tree] = true;
  }
  RigidMotion motion;
  motion.linear_m_s = direction_world;  // 1 m/s: the free time is the free distance
  return probe.free_time(T_world_object, motion, distance_m, config.contact_margin_m, left_out, crossing)
      .free_s;
}

bool slide(Body& body, double dt_s, const CollisionQueries& probe, const PhysicsConfig& config,
           StepReport& report) {
  body.angular_velocity_world_rad_s.setZero();
  body.velocity_world_mps += config.gravity_world_mps2 * dt_s;
  const double speed_mps = body.velocity_world_mps.norm();
  if (speed_mps > config.max_speed_mps) body.velocity_world_mps *= config.max_speed_mps / speed_mps;

  auto position = body.T_world_object.translation();
  Vec3 remaining = body.velocity_world_mps * dt_s;
  const double g_mps2 = config.gravity_world_mps2.norm();
  bool is_supported = false;
  body.rests_on = SurfaceKind::kNothing;
  MetSurfaces met;
  for (int slide = 0; slide < config.max_contact_events; ++slide) {
    const double distance_m = remaining.norm();
    if (distance_m < kShortest_m) break;
    const Vec3 direction = remaining / distance_m;
    const Contact contact =
        query_travel(body, direction, distance_m + config.contact_margin_m / kGrazing, probe, report);
    if (report.status == StepStatus::kHeld) return false;
    // The gap is kept perpendicular to the surface; along a grazing motion it is longer.
    const double steepness = std::max(-contact.normal_world.dot(direction), kGrazing);
    const double free_m = contact ? contact.lower_m - config.contact_margin_m / steepness : contact.lower_m;
    if (free_m >= distance_m) {
      position += remaining;
      break;
    }
    const Vec3 moved = std::max(free_m, 0.0) * direction;
    position += moved;
    if (!contact) break;  // limited by the radar's search distance
    remaining -= moved;
    if (contact.normal_world.dot(config.gravity_world_mps2) < -kSupportCosine * g_mps2) {
      is_supported = true;
      body.rests_on = contact.touched;
    }
    collide(body, contact, config, met, remaining);
    note_contact(contact.touched, report);
  }
  return is_supported;
}

}  // namespace roomradar
