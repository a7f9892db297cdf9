// scenario_hiding.cpp: casts rays from surface points to the prescan's cameras and to the scenario's camera.
#include "app/sim/scenarios/scenario_hiding.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/sim/scenarios/scenario_frame.hpp"
#include "app/sim/sensor/camera_path.hpp"
#include "app/sim/sensor/movers.hpp"
#include "app/sim/solids/angles.hpp"
#include "app/sim/solids/solid_distance.hpp"
#include "app/sim/solids/swept_travel.hpp"

namespace roomradar {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

bool is_in_image(const Intrinsics& camera, const Vector3d& p_camera, double margin) {
  if (p_camera.z() <= 0.0) return false;
  const Eigen::Vector2d uv = project(camera, p_camera);
  return uv.x() > margin * camera.width_px && uv.x() < (1.0 - margin) * camera.width_px &&
         uv.y() > margin * camera.height_px && uv.y() < (1.0 - margin) * camera.height_px;
}

/// Samples a part's core on all sides, with at most `spacing_m` between points along each straight edge.
std::vector<Vector3d> core_points(const Solid& part, double spacing_m) {
  std::vector<Vector3d> points;
  const Vector3d& half_m = part.half_m;
  const auto ticks = [&](double half) {
    std::vector<double> at;
    const int parts = half > 0.0 ? std::max(1, static_cast<int>(std::ceil(2.0 * half / spacing_m))) : 0;
    for (int i = 0; i <= parts; ++i) at.push_back(parts == 0 ? 0.0 : half * (2.0 * i / parts - 1.0));
    return at;
  };
  if (part.shape == SolidShape::kCylinder) {
    constexpr int kAround = 16;
    for (const double z : ticks(half_m.z()))
      for (int i = 0; i < kAround; ++i) {
        const double angle = kFullTurn_rad * i / kAround;
        const Vector3d rim(half_m.x() * std::cos(angle), half_m.x() * std::sin(angle), z);
        points.push_back(rim);
        if (std::abs(z) == half_m.z()) points.push_back(rim.cwiseProduct(Vector3d(0.5, 0.5, 1.0)));
      }
    return points;
  }
  for (const double x : ticks(half_m.x()))
    for (const double y : ticks(half_m.y()))
      for (const double z : ticks(half_m.z()))
        if (std::abs(x) == half_m.x() || std::abs(y) == half_m.y() || std::abs(z) == half_m.z())
          points.emplace_back(x, y, z);
  return points;
}

/// Returns true if three prescan views see the point: in their image, unoccluded, from 0.6 to 3.5 m, and not
/// grazing to the normal unless it is zero.
bool is_seen_by_views(const ScenarioRoom& from, const Vector3d& p_world, const Vector3d& normal_world) {
  constexpr int kViews = 3;
  const double least_cosine = normal_world.isZero(0.0) ? -1.0 : 0.3;
  int views = 0;
  for (const Isometry3d& T_world_camera : from.T_world_prescan) {
    const Vector3d to_camera = T_world_camera.translation() - p_world;
    const double range_m = to_camera.norm();
    if (range_m < 0.6 || range_m > 3.5 || normal_world.dot(to_camera) < least_cosine * range_m) continue;
    if (!is_in_image(from.prescan.depth_camera, T_world_camera.inverse() * p_world, 0.03)) continue;
    if (from.room.tree.is_blocked(from.room.solids, p_world, T_world_camera.translation())) continue;
    if (++views == kViews) return true;
  }
  return false;
}

/// Returns some `count` directions in the hemisphere around u, or twice as many in all directions if u is
/// zero.
std::vector<Vector3d> ball_directions(const Vector3d& u, int count) {
  std::vector<Vector3d> directions;
  for (int i = 0; i < 2 * count; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / (2 * count), angle = 2.399963229728653 * i;
    const double r = std::sqrt(1.0 - z * z);
    const Vector3d direction(r * std::cos(angle), r * std::sin(angle), z);
    if (u.isZero(0.0) || direction.dot(u) > 0.0) directions.push_back(direction);
  }
  return directions;
}

/// Samples the object's front, the side facing its direction of motion, in the world.
std::vector<Vector3d> front_points(const Scenario& scenario) {
  constexpr double kWidest_m = 0.04;
  std::vector<Vector3d> points;
  for (Solid part : scenario.object.parts) {
    part.T_world_solid = scenario.T_world_object * part.T_world_solid;
    const bool is_ball = part.half_m.isZero(0.0);
    const std::vector<Vector3d> core =
        core_points(part, std::min(kWidest_m, std::max(part.half_m.maxCoeff() / 3.0, 0.002)));
    std::vector<Vector3d> grown{Vector3d::Zero()};
    if (part.round_m > 0.0) grown = ball_directions(scenario.direction_world, is_ball ? 200 : 9);
    for (const Vector3d& p_solid : core)
      for (const Vector3d& outward : grown)
        points.push_back(part.T_world_solid * p_solid + part.round_m * outward);
  }
  return points;
}

bool draw_camera(const ScenarioRoom& from, CounterRandom& random, Scenario& scenario) {
  const double azimuth_rad = random.uniform(0.0, kFullTurn_rad), away_m = random.uniform(0.9, 2.6);
  const Vector3d eye_world(scenario.contact_world.x() + away_m * std::cos(azimuth_rad),
                           scenario.contact_world.y() + away_m * std::sin(azimuth_rad),
                           random.uniform(1.1, 1.75));
  if ((eye_world - from.room.interior_min_world).minCoeff() < 0.35 ||
      (from.room.interior_max_world - eye_world).minCoeff() < 0.35)
    return false;
  if (signed_distance_m(from.room, eye_world) < 0.35) return false;
  scenario.T_world_camera = looking_at(eye_world, scenario.contact_world + 0.15 * random_unit(random));
  return is_in_image(scenario.depth_camera, scenario.T_world_camera.inverse() * scenario.contact_world, 0.1);
}

/// Adds a box at fraction `part` of the way from the contact to the eye, its broad side to the camera.
void add_box(double part, CounterRandom& random, Scenario& scenario) {
  const Vector3d eye_world = scenario.T_world_camera.translation();
  const double size_m = random.uniform(0.2, 0.45);
  Solid carried = box(scenario.contact_world + part * (eye_world - scenario.contact_world),
                      {size_m, 0.12, size_m * random.uniform(0.7, 1.2)});
  const Isometry3d T_world_facing = looking_at(eye_world, scenario.contact_world);
  carried.T_world_solid.linear() << T_world_facing.linear().col(0), T_world_facing.linear().col(2),
      -T_world_facing.linear().col(1);
  scenario.occluder_solids = {carried};
  scenario.occluder_materials = {{Pattern::kPoster, {206, 176, 132}, {120, 84, 50}, 401, 0.6F}};
}

/// Adds a hand at fraction `part` of the way, with any point from palm to forearm in front of the contact. In
/// every other scenario of this kind the hand moves past.
void add_hand(double part, CounterRandom& random, Scenario& scenario) {
  const Vector3d to_eye = scenario.T_world_camera.translation() - scenario.contact_world;
  Mover hand;
  hand.kind = MoverKind::kHand;
  const Vector3d right = Vector3d::UnitZ().cross(to_eye).normalized() * (random.uniform() < 0.5 ? 1.0 : -1.0);
  hand.arm_world = (right + 0.3 * Vector3d(to_eye.x(), to_eye.y(), 0.0) / to_eye.norm() +
                    Vector3d(0, 0, random.uniform(0.1, 0.5)))
                       .normalized();
  hand.to_world = scenario.contact_world + part * to_eye - random.uniform(0.0, 0.3) * hand.arm_world;
  hand.from_world = hand.to_world;
  append_solids(hand, 0.0, scenario.occluder_solids);
  scenario.occluder_materials.assign(scenario.occluder_solids.size(),
                                     {Pattern::kSkin, {222, 172, 142}, {196, 136, 110}, 402, 0.55F});
  if (scenario.number / 4 % 2 == 0) return;
  const Vector3d across = random_unit(random).cross(to_eye).normalized();
  scenario.occluder_velocity_world = random.uniform(0.2, 1.2) * across;
  const double shown_s = contact_frame(scenario) * kScenarioFrame_s;
  for (Solid& solid : scenario.occluder_solids)
    solid.T_world_solid.pretranslate(-shown_s * scenario.occluder_velocity_world);
}

/// Adds a person standing at fraction `part` of the way. Returns false if there is no space.
bool add_person(const Room& room, double part, CounterRandom& random, Scenario& scenario) {
  const Vector3d to_eye = scenario.T_world_camera.translation() - scenario.contact_world;
  Mover person;
  person.kind = MoverKind::kPerson;
  const Vector3d foot_world(scenario.contact_world.x() + part * to_eye.x(),
                            scenario.contact_world.y() + part * to_eye.y(), 0.0);
  for (const double height_m : {0.3, 0.6, 0.9, 1.2, 1.5})
    if (signed_distance_m(room, foot_world + Vector3d(0, 0, height_m)) < 0.25) return false;
  const double facing_rad = random.uniform(0.0, kFullTurn_rad);
  const Vector3d way = 0.3 * Vector3d(std::cos(facing_rad), std::sin(facing_rad), 0.0);
  person.from_world = foot_world - way;
  person.to_world = foot_world + way;
  person.period_s = 8.0;
  person.phase_rad = 0.25 * kFullTurn_rad;  // mid-path, close to foot_world
  append_solids(person, 0.0, scenario.occluder_solids);
  scenario.occluder_materials.assign(scenario.occluder_solids.size(),
                                     {Pattern::kFabric, {176, 62, 54}, {226, 210, 190}, 403, 0.55F});
  return true;
}

/// Returns true if the object keeps 4 cm from the occluder up to kBeyond_m past the true contact.
bool keeps_clear(const Scenario& scenario) {
  constexpr double kKeep_m = 0.04;
  const double until_m = scenario.true_travel_m + kBeyond_m;
  if (scenario.occluder_velocity_world.isZero()) {
    std::vector<Solid> grown = scenario.object.parts;
    for (Solid& part : grown) part.round_m += kKeep_m;
    return !swept_travel(scenario.occluder_solids, grown, scenario.T_world_object, scenario.direction_world,
                         until_m)
                .touches;
  }
  // A frame's occluder stays until the next frame while the object moves on: test in steps of 1 cm.
  constexpr double kStep_m = 0.01;
  for (int frame = 0; frame * step_m(scenario) < until_m; ++frame) {
    const std::vector<Solid> occluder = occluder_at(scenario, frame);
    for (double contact_distance_m = frame * step_m(scenario);
         contact_distance_m < std::min(until_m, (frame + 1) * step_m(scenario));
         contact_distance_m += kStep_m) {
      const Isometry3d T_world_object =
          Eigen::Translation3d(contact_distance_m * scenario.direction_world) * scenario.T_world_object;
      if (clearance_m(occluder, scenario.object.parts, T_world_object, kKeep_m + kStep_m) < kKeep_m + kStep_m)
        return false;
    }
  }
  return true;
}

/// Places the occluder between camera and contact. Returns false if it would intersect the room, be too close
/// to the camera, or block the object's path.
bool place_occluder(const ScenarioRoom& from, CounterRandom& random, Scenario& scenario) {
  scenario.occluder_solids.clear();
  scenario.occluder_materials.clear();
  scenario.occluder_velocity_world.setZero();
  const Vector3d eye_world = scenario.T_world_camera.translation();
  const double range_m = (eye_world - scenario.contact_world).norm();
  const auto draw_part = [&](double least, double most, double keep_m) {
    const double part = random.uniform(least, most);
    return (1.0 - part) * range_m < keep_m ? 0.0 : part;
  };
  switch (scenario.occluder) {
    case Occluder::kFurniture:
      return true;
    case Occluder::kBox: {
      const double part = draw_part(0.25, 0.6, 0.6);
      if (part == 0.0) return false;
      add_box(part, random, scenario);
      break;
    }
    case Occluder::kHand: {
      const double part = draw_part(0.12, 0.5, 0.6);
      if (part == 0.0) return false;
      add_hand(part, random, scenario);
      break;
    }
    case Occluder::kPerson: {
      const double part = draw_part(0.3, 0.65, 0.75);
      if (part == 0.0 || !add_person(from.room, part, random, scenario)) return false;
      break;
    }
  }
  for (const Solid& solid : occluder_at(scenario, contact_frame(scenario)))
    if (signed_distance_m(solid, eye_world) < 0.55) return false;
  return keeps_clear(scenario);
}

/// Returns true if something blocks the view of the point, at least 5 mm in front, so an edge does not hide
/// itself.
bool is_hidden(const std::vector<Solid>& solids, const SolidTree& tree, const Vector3d& eye_world,
               const Vector3d& point_world) {
  return tree.is_blocked(solids, eye_world, point_world + 0.005 * (eye_world - point_world).normalized());
}

/// Returns true if all patches are hidden and the room alone hides at most half of them, unless furniture is
/// the occluder.
bool is_hidden_as_meant(const ScenarioRoom& from, const Scenario& scenario,
                        const std::vector<Patch>& patches) {
  const std::vector<Solid> occluder = occluder_at(scenario, contact_frame(scenario));
  const SolidTree occluder_tree(occluder);
  const Vector3d eye_world = scenario.T_world_camera.translation();
  std::size_t hidden_by_room = 0;
  for (const Patch& patch : patches) {
    if (is_hidden(from.room.solids, from.room.tree, eye_world, patch.point_world)) {
      ++hidden_by_room;
    } else if (!is_hidden(occluder, occluder_tree, eye_world, patch.point_world)) {
      return false;
    }
  }
  return scenario.occluder == Occluder::kFurniture || 2 * hidden_by_room <= patches.size();
}

}  // namespace

Vector3d random_unit(CounterRandom& random) {
  const double z = random.uniform(-1.0, 1.0), angle = random.uniform(0.0, kFullTurn_rad),
               r = std::sqrt(1.0 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

std::optional<Patch> draw_patch(const ScenarioRoom& from, CounterRandom& random) {
  const auto frames = static_cast<double>(from.T_world_prescan.size());
  const Isometry3d& T_world_camera =
      from.T_world_prescan[static_cast<std::size_t>(random.uniform() * frames)];
  const Intrinsics& camera = from.prescan.depth_camera;
  const double y_px = random.uniform(0.0, camera.height_px), x_px = random.uniform(0.0, camera.width_px);
  const Vector3d direction = T_world_camera.linear() * back_project(camera, x_px, y_px, 1.0);
  const auto hit = cast_ray(from.room, T_world_camera.translation(), direction);
  if (!hit) return std::nullopt;
  return Patch{T_world_camera.translation() + hit->range_m * direction, hit->normal_world};
}

bool was_seen(const ScenarioRoom& from, const Patch& patch) {
  return is_seen_by_views(from, patch.point_world + 0.002 * patch.normal_world, patch.normal_world);
}

bool way_was_seen(const ScenarioRoom& from, const Scenario& scenario) {
  constexpr double kStep_m = 0.06, kSpacing_m = 0.15;
  std::vector<Vector3d> points;  // on the object at its start, in the world
  for (Solid part : scenario.object.parts) {
    part.T_world_solid = scenario.T_world_object * part.T_world_solid;
    points.push_back(part.T_world_solid.translation());
    for (const Vector3d& p_solid : core_points(part, kSpacing_m))
      points.push_back(part.T_world_solid * p_solid);
    if (part.round_m > 0.0)
      for (const Vector3d& outward : ball_directions(Vector3d::Zero(), 20))
        points.push_back(part.T_world_solid.translation() + part.round_m * outward);
  }
  const double end_m = scenario.true_travel_m - 0.002;  // just in front of the surface
  for (double contact_distance_m = 0.0; contact_distance_m < end_m + kStep_m; contact_distance_m += kStep_m)
    for (const Vector3d& p_world : points)
      if (!is_seen_by_views(from, p_world + std::min(contact_distance_m, end_m) * scenario.direction_world,
                            Vector3d::Zero()))
        return false;
  return true;
}

std::vector<Patch> stopping_patches(const Room& room, const Scenario& scenario, double limit_m) {
  std::vector<Patch> patches;
  for (const Vector3d& start_world : front_points(scenario)) {
    const auto hit = room.tree.cast(room.solids, start_world, scenario.direction_world, limit_m);
    if (hit) patches.push_back({start_world + hit->range_m * scenario.direction_world, hit->normal_world});
  }
  return patches;
}

bool hide(const ScenarioRoom& from, const std::vector<Patch>& patches, CounterRandom& random,
          Scenario& scenario) {
  constexpr int kCameras = 12;
  for (int i = 0; i < kCameras; ++i) {
    if (!draw_camera(from, random, scenario) || !place_occluder(from, random, scenario)) continue;
    if (is_hidden_as_meant(from, scenario, patches)) return true;
  }
  return false;
}

}  // namespace roomradar
