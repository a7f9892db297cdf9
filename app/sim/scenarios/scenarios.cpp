// scenarios.cpp: draws placements until the surface that stops the object is hidden now but was seen before.
#include "app/sim/scenarios/scenarios.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "app/sim/sensor/camera_path.hpp"
#include "app/sim/sensor/kinect_depth.hpp"
#include "app/sim/sensor/movers.hpp"
#include "app/sim/solids/angles.hpp"
#include "app/sim/solids/solid_distance.hpp"
#include "app/sim/solids/swept_travel.hpp"
#include "mapping/types/system/counter_random.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

std::vector<Solid> occluder_at(const Scenario& scenario, int frame) {
  std::vector<Solid> solids = scenario.occluder_solids;
  for (Solid& solid : solids)
    solid.T_world_solid.pretranslate(frame * kScenarioFrame_s * scenario.occluder_velocity_world);
  return solids;
}

void render_scenario(const Scenario& scenario, const Room& room, int frame_number, double noise_scale,
                     Frame& frame) {
  std::vector<Solid> solids = room.solids;
  const std::vector<Solid> occluder = occluder_at(scenario, frame_number);
  solids.insert(solids.end(), occluder.begin(), occluder.end());
  std::vector<float> infrared;
  for (const Material& material : room.materials) infrared.push_back(material.infrared);
  for (const Material& material : scenario.occluder_materials) infrared.push_back(material.infrared);
  ViewCaster view;
  ExactView exact;
  view.prepare(solids, scenario.depth_camera, scenario.T_world_camera);
  render_exact(solids, view, scenario.depth_camera, {}, exact);
  if (noise_scale > 0.0) {
    KinectScratch scratch;
    measure_depth({solids, infrared},
                  {.caster = view,
                   .exact = exact,
                   .camera = scenario.depth_camera,
                   .T_world_camera = scenario.T_world_camera},
                  {.faults = {},
                   .noise_scale = noise_scale,
                   .seed = mixed(scenario.seed + static_cast<std::uint64_t>(scenario.number)),
                   .frame_index = frame_number},
                  scratch, frame.depth_m);
  } else {
    frame.depth_m = exact.depth_m;
    for (float& depth_m : frame.depth_m.pixels)
      if (depth_m < static_cast<float>(kKinectNearest_m) || depth_m > static_cast<float>(kKinectFarthest_m))
        depth_m = 0.0F;
  }
  frame.index = frame_number;
  frame.stamp_s = frame_number * kScenarioFrame_s;
  frame.depth_camera = scenario.depth_camera;
  frame.colour = {};
  frame.colour_camera = {};
  frame.T_world_camera = scenario.T_world_camera;
  frame.down_camera = scenario.T_world_camera.linear().transpose() * -Eigen::Vector3d::UnitZ();
}

namespace {

/// Occluders hide all surfaces that could stop the object up to this distance beyond the true contact.
constexpr double kBeyond_m = 0.05;

/// A surface point and its unit normal.
struct Patch {
  Eigen::Vector3d point_world, normal_world;
};

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

/// Returns a random unit vector.
Vector3d random_unit(CounterRandom& random) {
  const double z = random.uniform(-1.0, 1.0), angle = random.uniform(0.0, kFullTurn_rad),
               r = std::sqrt(1.0 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
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

/// Returns the surface point at a random pixel of a random prescan frame, or nullopt if the pixel's ray hits
/// no surface.
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

/// Returns true if at least three prescan views observed the patch without occlusion, at 0.6 to 3.5 m and not
/// at a grazing angle.
bool was_seen(const ScenarioRoom& from, const Patch& patch) {
  return is_seen_by_views(from, patch.point_world + 0.002 * patch.normal_world, patch.normal_world);
}

/// Returns true if the object enters no unknown space between its start and the true contact. Tests the swept
/// volume at several hundred sample points, each of which at least three prescan views must have observed.
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

/// Returns the room's surface points that could stop the object within limit_m. They are found by casting
/// several hundred rays from the object's front.
std::vector<Patch> stopping_patches(const Room& room, const Scenario& scenario, double limit_m) {
  std::vector<Patch> patches;
  for (const Vector3d& start_world : front_points(scenario)) {
    const auto hit = room.tree.cast(room.solids, start_world, scenario.direction_world, limit_m);
    if (hit) patches.push_back({start_world + hit->range_m * scenario.direction_world, hit->normal_world});
  }
  return patches;
}

/// Draws camera pose, occluder and occluder motion at random until the occluder hides `patches` from the
/// camera.
/// @param patches  surface points that could stop the object
/// @return false if 12 draws have failed
bool hide(const ScenarioRoom& from, const std::vector<Patch>& patches, CounterRandom& random,
          Scenario& scenario) {
  constexpr int kCameras = 12;
  for (int i = 0; i < kCameras; ++i) {
    if (!draw_camera(from, random, scenario) || !place_occluder(from, random, scenario)) continue;
    if (is_hidden_as_meant(from, scenario, patches)) return true;
  }
  return false;
}

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr std::array kOccluders{Occluder::kFurniture, Occluder::kBox, Occluder::kHand, Occluder::kPerson};
constexpr std::array kShapes{ObjectShape::kBall,  ObjectShape::kNeedle, ObjectShape::kBox,
                             ObjectShape::kCup,   ObjectShape::kChair,  ObjectShape::kCylinder,
                             ObjectShape::kTorus, ObjectShape::kSheet,  ObjectShape::kTable};

/// Returns true if the object would travel nearly as far when shifted 5 mm to each side.
bool is_well_posed(const Room& room, const Scenario& scenario) {
  constexpr double kAside_m = 0.005, kSooner_m = 0.015;
  const Vector3d across = scenario.direction_world.unitOrthogonal();
  const Vector3d along = scenario.direction_world.cross(across);
  for (const Vector3d& side : {across, along, Vector3d(-across), Vector3d(-along)}) {
    const Isometry3d T_world_object = Eigen::Translation3d(kAside_m * side) * scenario.T_world_object;
    const SweptTravel swept = swept_travel(room.solids, scenario.object.parts, T_world_object,
                                           scenario.direction_world, scenario.true_travel_m + kSooner_m);
    if (!swept.touches || swept.contact_distance_m < scenario.true_travel_m - kSooner_m) return false;
  }
  return true;
}

/// Places an object in front of a patch, on course to hit it. Returns the patch that it hits, or nullopt if
/// the object does not fit.
std::optional<Patch> place_object(const ScenarioRoom& from, const Patch& patch, bool drop, ObjectShape shape,
                                  CounterRandom& random, Scenario& scenario) {
  constexpr double kStartClear_m = 0.02, kLeastTravel_m = 0.05;
  scenario.object = draw_object(shape, random);
  scenario.direction_world = drop ? Vector3d(-Vector3d::UnitZ())
                                  : Vector3d((-patch.normal_world + 0.25 * random_unit(random)).normalized());
  scenario.speed_m_s = 0.3 * std::pow(10.0 / 0.3, random.uniform());
  const double start_m = random.uniform(0.08, 0.4);
  const double reach_m = scenario.object.reach_m;
  scenario.T_world_object = Isometry3d::Identity();
  const Vector3d tilt_axis = random_unit(random);
  const double tilt_rad = random.uniform(-0.6, 0.6), yaw_rad = random.uniform(0.0, kFullTurn_rad);
  scenario.T_world_object.linear() =
      (Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()) * Eigen::AngleAxisd(tilt_rad, tilt_axis))
          .toRotationMatrix();
  scenario.T_world_object.translation() = patch.point_world - (start_m + reach_m) * scenario.direction_world;
  if (signed_distance_m(from.room, scenario.T_world_object.translation()) < kStartClear_m)
    return std::nullopt;
  if (clearance_m(from.room.solids, scenario.object.parts, scenario.T_world_object, kStartClear_m) <
      kStartClear_m)
    return std::nullopt;
  const double limit_m = start_m + 2.0 * reach_m;
  const SweptTravel swept = swept_travel(from.room.solids, scenario.object.parts, scenario.T_world_object,
                                         scenario.direction_world, limit_m);
  if (!swept.touches || swept.contact_distance_m < kLeastTravel_m) return std::nullopt;
  scenario.true_travel_m = swept.contact_distance_m;
  scenario.contact_world = swept.point_world;
  scenario.limit_m = swept.contact_distance_m + 0.4;
  if (!is_well_posed(from.room, scenario)) return std::nullopt;
  return Patch{swept.point_world, swept.normal_world};
}

/// Draws a tracking error: 1.5 mm along and 0.1 degrees about each axis (one sigma).
Isometry3d draw_pose_error(std::uint64_t key) {
  constexpr double kSigma_m = 0.0015, kSigma_rad = 0.1 * std::numbers::pi / 180.0;
  const auto bell = [&](std::uint64_t i) { return static_cast<double>(gaussian(hash_of(key, i))); };
  Isometry3d T_camera_believed = Isometry3d::Identity();
  for (int axis = 0; axis < 3; ++axis)
    T_camera_believed.rotate(
        Eigen::AngleAxisd(kSigma_rad * bell(static_cast<std::uint64_t>(axis)), Vector3d::Unit(axis)));
  T_camera_believed.translation() = kSigma_m * Vector3d(bell(3), bell(4), bell(5));
  return T_camera_believed;
}

std::optional<Scenario> draw_scenario(const ScenarioRoom& from, std::int64_t number, Occluder occluder,
                                      ObjectShape shape, bool drop, CounterRandom& random) {
  Scenario scenario;
  scenario.number = number;
  scenario.room = from.room.name;
  scenario.occluder = occluder;
  const std::optional<Patch> patch = draw_patch(from, random);
  if (!patch) return std::nullopt;
  if (drop ? patch->normal_world.z() < 0.9 : std::abs(patch->normal_world.z()) > 0.3) return std::nullopt;
  if (!was_seen(from, *patch)) return std::nullopt;
  const std::optional<Patch> contact = place_object(from, *patch, drop, shape, random, scenario);
  if (!contact) return std::nullopt;
  std::vector<Patch> patches = stopping_patches(from.room, scenario, scenario.true_travel_m + kBeyond_m);
  if (patches.size() < 3) return std::nullopt;
  patches.push_back(*contact);
  if (!std::all_of(patches.begin(), patches.end(), [&](const Patch& one) { return was_seen(from, one); }))
    return std::nullopt;
  if (!way_was_seen(from, scenario)) return std::nullopt;
  if (!hide(from, patches, random, scenario)) return std::nullopt;
  return scenario;
}

}  // namespace

std::string_view to_string(Occluder occluder) {
  switch (occluder) {
    case Occluder::kFurniture:
      return "furniture";
    case Occluder::kBox:
      return "box";
    case Occluder::kHand:
      return "hand";
    case Occluder::kPerson:
      break;
  }
  return "person";
}

std::string_view to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::kPassedThrough:
      return "passed";
    case Outcome::kStoppedFalse:
      return "false stop";
    case Outcome::kStoppedRight:
      break;
  }
  return "right";
}

ScenarioRoom make_scenario_room(std::string_view name, std::uint64_t seed) {
  ScenarioRoom from;
  from.prescan.room = name;
  from.prescan.seed = seed;
  from.prescan.frames = kScenarioPrescanFrames;
  from.room = make_room(name, /*crate=*/false, seed);
  const double duration_s = static_cast<double>(from.prescan.frames) / from.prescan.rate_hz;
  const CameraPath path = plan_camera_path(from.room, from.prescan.path, from.prescan.seed, duration_s);
  for (std::int64_t frame = 0; frame < from.prescan.frames; frame += 10)
    from.T_world_prescan.push_back(
        T_world_camera_at(path, static_cast<double>(frame) / from.prescan.rate_hz));
  return from;
}

Scenario make_scenario(const ScenarioRoom& room, std::uint64_t seed, std::int64_t number) {
  constexpr std::uint64_t kDraws = 3000;
  std::uint64_t room_key = room.prescan.seed;  // so rooms differ in more than their furniture
  for (const char letter : room.room.name) room_key = mixed(room_key + static_cast<unsigned char>(letter));
  const auto at = static_cast<std::size_t>(number);
  const bool drop = at / kOccluders.size() % 2 == 0;
  std::uint64_t position = 0;
  for (std::size_t next_shape = 0; next_shape < kShapes.size(); ++next_shape) {
    const ObjectShape shape =
        kShapes[(at + 5 * (at / (2 * kOccluders.size())) + next_shape) % kShapes.size()];
    for (std::size_t next_occluder = 0; next_occluder < kOccluders.size(); ++next_occluder) {
      const Occluder occluder = kOccluders[(at + next_occluder) % kOccluders.size()];
      for (std::uint64_t draw = 0; draw < kDraws; ++draw) {
        CounterRandom random(hash_of(seed, at, room_key), position++);
        std::optional<Scenario> scenario = draw_scenario(room, number, occluder, shape, drop, random);
        if (!scenario) continue;
        scenario->seed = seed;
        scenario->object_mesh = object_mesh(scenario->object);
        scenario->T_world_believed =
            scenario->T_world_camera * draw_pose_error(hash_of(seed, at, room_key + 1));
        return *scenario;
      }
    }
  }
  throw Error("room '" + room.room.name + "' has no hidden surface for scenario " + std::to_string(number) +
              " of seed " + std::to_string(seed) + "; try another seed");
}

Verdict judge(const Scenario& scenario, double travelled_m) {
  constexpr double kTooShort_m = 0.03;
  Verdict verdict;
  verdict.error_m = travelled_m - scenario.true_travel_m;
  if (!(verdict.error_m <= kTooFar_m)) verdict.outcome = Outcome::kPassedThrough;  // includes NaN
  if (verdict.error_m < -kTooShort_m) verdict.outcome = Outcome::kStoppedFalse;
  return verdict;
}

}  // namespace roomradar
