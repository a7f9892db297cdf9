// scenarios.cpp: draws until a surface is hidden now, was seen before, and stops the object.
#include "app/sim/scenarios.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "app/sim/camera_path.hpp"
#include "app/sim/counter_random.hpp"
#include "app/sim/kinect_depth.hpp"
#include "app/sim/movers.hpp"
#include "app/sim/room_mesh.hpp"
#include "app/sim/swept_travel.hpp"
#include "mapping/types/error.hpp"

namespace roomradar {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
// What could stop the object this far behind the contact must be hidden too.
constexpr double kBeyond_m = 0.05;
constexpr std::array kOccluders{Occluder::kFurniture, Occluder::kBox, Occluder::kHand, Occluder::kPerson};

/// A surface point and its normal.
struct Patch {
  Vector3d point_world, normal_world;
};

Vector3d random_unit(CounterRandom& random) {
  const double z = random.uniform(-1.0, 1.0), angle = random.uniform(0.0, kTurn_rad),
               r = std::sqrt(1.0 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

bool is_in_image(const Intrinsics& camera, const Vector3d& p_camera, double margin) {
  if (p_camera.z() <= 0.0) return false;
  const Eigen::Vector2d uv = project(camera, p_camera);
  return uv.x() > margin * camera.width_px && uv.x() < (1.0 - margin) * camera.width_px &&
         uv.y() > margin * camera.height_px && uv.y() < (1.0 - margin) * camera.height_px;
}

/// The surface point that some pixel of some prescan frame saw.
std::optional<Patch> draw_patch(const ScenarioRoom& from, CounterRandom& random) {
  const auto frames = static_cast<double>(from.T_world_prescan.size());
  const Isometry3d& T_world_camera =
      from.T_world_prescan[static_cast<std::size_t>(random.uniform() * frames)];
  const Vector3d direction =
      T_world_camera.linear() * back_project(from.prescan.depth_camera,
                                             random.uniform(0.0, from.prescan.depth_camera.width_px),
                                             random.uniform(0.0, from.prescan.depth_camera.height_px), 1.0);
  const auto hit = cast_ray(from.room, T_world_camera.translation(), direction);
  if (!hit) return std::nullopt;
  return Patch{T_world_camera.translation() + hit->range_m * direction, hit->normal_world};
}

bool was_seen(const ScenarioRoom& from, const Patch& patch) {
  constexpr int kViews = 3;
  int views = 0;
  const Vector3d before_world = patch.point_world + 0.002 * patch.normal_world;
  for (const Isometry3d& T_world_camera : from.T_world_prescan) {
    const Vector3d to_camera = T_world_camera.translation() - patch.point_world;
    const double range_m = to_camera.norm();
    if (range_m < 0.6 || range_m > 3.5 || patch.normal_world.dot(to_camera) < 0.3 * range_m) continue;
    if (!is_in_image(from.prescan.depth_camera, T_world_camera.inverse() * patch.point_world, 0.03)) continue;
    if (from.room.tree.is_blocked(from.room.solids, before_world, T_world_camera.translation())) continue;
    if (++views == kViews) return true;
  }
  return false;
}

Solid draw_object(CounterRandom& random) {
  const double size_m = 0.04 * std::pow(0.30 / 0.04, random.uniform());  // as many small ones as large ones
  const double kind = random.uniform();
  const auto part = [&] { return random.uniform(0.4, 1.0); };
  if (kind < 0.34) return sphere({0, 0, 0}, 0.5 * size_m);
  if (kind < 0.67)
    return box({0, 0, 0}, {size_m, std::max(0.04, part() * size_m), std::max(0.04, part() * size_m)});
  Solid can = cylinder({0, 0, 0}, 0.5 * std::max(0.04, part() * size_m), size_m);
  can.T_world_solid.setIdentity();
  return can;
}

/// Room points that the object's front would run into within the limit, one for each of some 200 points of
/// its front.
std::vector<std::pair<double, Patch>> stopping_patches(const Room& room, const Scenario& scenario,
                                                       double limit_m) {
  const Eigen::Matrix3d R_solid_world = scenario.T_world_object.linear().transpose();
  const Vector3d direction_solid = R_solid_world * scenario.direction_world;
  const Vector3d half_m = bounds_half_m(scenario.object);
  std::vector<Vector3d> front;
  if (scenario.object.half_m.isZero(0.0)) {
    constexpr int kPoints = 400;  // on the whole ball, of which half lead
    for (int i = 0; i < kPoints; ++i) {
      const double z = 1.0 - (2.0 * i + 1.0) / kPoints, angle = 2.399963229728653 * i,
                   r = std::sqrt(1.0 - z * z);
      const Vector3d outward(r * std::cos(angle), r * std::sin(angle), z);
      if (outward.dot(direction_solid) > 0.0) front.push_back(scenario.object.round_m * outward);
    }
  } else {
    front = leading_core_points(scenario.object, direction_solid, half_m.maxCoeff() / 6.0);
  }
  std::vector<std::pair<double, Patch>> patches;
  for (const Vector3d& p_solid : front) {
    const Vector3d start_world = scenario.T_world_object * p_solid;
    const auto hit = cast_ray(room, start_world, scenario.direction_world);
    if (hit && hit->range_m <= limit_m)
      patches.push_back(
          {hit->range_m, {start_world + hit->range_m * scenario.direction_world, hit->normal_world}});
  }
  return patches;
}

/// Puts an object before a patch so that it will run into it, and works out the truth. False if it does not
/// fit.
bool place_object(const ScenarioRoom& from, const Patch& patch, bool drop, CounterRandom& random,
                  Scenario& scenario) {
  if (drop ? patch.normal_world.z() < 0.9 : std::abs(patch.normal_world.z()) > 0.3) return false;
  scenario.object = draw_object(random);
  scenario.direction_world = drop ? Vector3d(-Vector3d::UnitZ())
                                  : Vector3d((-patch.normal_world + 0.25 * random_unit(random)).normalized());
  scenario.speed_m_s = random.uniform(0.3, drop ? 2.5 : 1.5);
  const double start_m = random.uniform(0.08, 0.4);
  const double reach_m = bounds_half_m(scenario.object).norm();
  scenario.T_world_object = Isometry3d::Identity();
  scenario.T_world_object.linear() = (Eigen::AngleAxisd(random.uniform(0.0, kTurn_rad), Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(random.uniform(-0.6, 0.6), random_unit(random)))
                                         .toRotationMatrix();
  scenario.T_world_object.translation() = patch.point_world - (start_m + reach_m) * scenario.direction_world;
  if (signed_distance_m(from.room, scenario.T_world_object.translation()) < reach_m + 0.02) return false;
  const double limit_m = start_m + 2.0 * reach_m;
  const SweptTravel swept =
      swept_travel(from.room, scenario.object, scenario.T_world_object, scenario.direction_world, limit_m);
  if (!swept.touches || swept.travel_m < 0.05) return false;
  scenario.true_travel_m = swept.travel_m;
  scenario.contact_world = swept.point_world;
  scenario.limit_m = swept.travel_m + 0.4;
  return true;
}

bool draw_camera(const ScenarioRoom& from, CounterRandom& random, Scenario& scenario) {
  const double azimuth_rad = random.uniform(0.0, kTurn_rad), away_m = random.uniform(0.9, 2.6);
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

/// Puts the occluder between camera and contact. False if it would stand in the room's things or in the
/// object's way.
bool place_occluder(const ScenarioRoom& from, CounterRandom& random, Scenario& scenario) {
  scenario.occluder_solids.clear();
  scenario.occluder_materials.clear();
  const Vector3d eye_world = scenario.T_world_camera.translation();
  const Vector3d to_eye = eye_world - scenario.contact_world;
  const double range_m = to_eye.norm();
  switch (scenario.occluder) {
    case Occluder::kFurniture:
      return true;
    case Occluder::kBox: {
      const double part = random.uniform(0.25, 0.6);
      if ((1.0 - part) * range_m < 0.6) return false;
      const double size_m = random.uniform(0.2, 0.45);
      Solid carried =
          box(scenario.contact_world + part * to_eye, {size_m, 0.12, size_m * random.uniform(0.7, 1.2)});
      const Isometry3d T_world_facing = looking_at(eye_world, scenario.contact_world);
      carried.T_world_solid.linear() << T_world_facing.linear().col(0), T_world_facing.linear().col(2),
          -T_world_facing.linear().col(1);
      scenario.occluder_solids = {carried};
      scenario.occluder_materials = {{Pattern::kPoster, {206, 176, 132}, {120, 84, 50}, 401, 0.6F}};
      break;
    }
    case Occluder::kHand: {
      const double part = random.uniform(0.12, 0.5);
      if ((1.0 - part) * range_m < 0.6) return false;
      Mover hand;
      hand.kind = MoverKind::kHand;
      const Vector3d right =
          Vector3d::UnitZ().cross(to_eye).normalized() * (random.uniform() < 0.5 ? 1.0 : -1.0);
      hand.arm_world = (right + 0.3 * Vector3d(to_eye.x(), to_eye.y(), 0.0) / range_m +
                        Vector3d(0, 0, random.uniform(0.1, 0.5)))
                           .normalized();
      // The surface may be hidden by any part from the palm to the forearm.
      hand.to_world = scenario.contact_world + part * to_eye - random.uniform(0.0, 0.3) * hand.arm_world;
      hand.from_world = hand.to_world;
      append_solids(hand, 0.0, scenario.occluder_solids);
      scenario.occluder_materials.assign(scenario.occluder_solids.size(),
                                         {Pattern::kSkin, {222, 172, 142}, {196, 136, 110}, 402, 0.55F});
      break;
    }
    case Occluder::kPerson: {
      const double part = random.uniform(0.3, 0.65);
      if ((1.0 - part) * range_m < 0.75) return false;
      Mover person;
      person.kind = MoverKind::kPerson;
      const Vector3d foot_world(scenario.contact_world.x() + part * to_eye.x(),
                                scenario.contact_world.y() + part * to_eye.y(), 0.0);
      for (const double height_m : {0.3, 0.6, 0.9, 1.2, 1.5})
        if (signed_distance_m(from.room, foot_world + Vector3d(0, 0, height_m)) < 0.25) return false;
      const double facing_rad = random.uniform(0.0, kTurn_rad);
      const Vector3d way = 0.3 * Vector3d(std::cos(facing_rad), std::sin(facing_rad), 0.0);
      person.from_world = foot_world - way;
      person.to_world = foot_world + way;
      person.period_s = 8.0;
      person.phase_rad = 0.25 * kTurn_rad;  // half of the way: at foot_world, but for the lane's small width
      append_solids(person, 0.0, scenario.occluder_solids);
      scenario.occluder_materials.assign(scenario.occluder_solids.size(),
                                         {Pattern::kFabric, {176, 62, 54}, {226, 210, 190}, 403, 0.55F});
      break;
    }
  }
  // A ball round the object must pass the occluder with 4 cm to spare, as far as the object is judged.
  const double keep_m = bounds_half_m(scenario.object).norm() + 0.04;
  for (double travel_m = 0.0; travel_m <= scenario.true_travel_m + kBeyond_m; travel_m += 0.01) {
    const Vector3d centre_world = scenario.T_world_object.translation() + travel_m * scenario.direction_world;
    for (const Solid& solid : scenario.occluder_solids)
      if (signed_distance_m(solid, centre_world) < keep_m + 0.01) return false;
  }
  for (const Solid& solid : scenario.occluder_solids)
    if (signed_distance_m(solid, eye_world) < 0.55) return false;
  return true;
}

bool is_hidden(const std::vector<Solid>& solids, const SolidTree& tree, const Vector3d& eye_world,
               const Patch& patch) {
  if (patch.normal_world.dot(eye_world - patch.point_world) <= 0.0) return true;
  return tree.is_blocked(solids, patch.point_world + 0.001 * patch.normal_world, eye_world);
}

/// All patches are hidden, and if there is an occluder, it hides at least half of them that the room does
/// not.
bool is_hidden_as_meant(const ScenarioRoom& from, const Scenario& scenario,
                        const std::vector<std::pair<double, Patch>>& patches) {
  const SolidTree occluders(scenario.occluder_solids);
  const Vector3d eye_world = scenario.T_world_camera.translation();
  std::size_t hidden_by_room = 0;
  for (const auto& [travel_m, patch] : patches) {
    if (is_hidden(from.room.solids, from.room.tree, eye_world, patch)) {
      ++hidden_by_room;
    } else if (!is_hidden(scenario.occluder_solids, occluders, eye_world, patch)) {
      return false;
    }
  }
  return scenario.occluder == Occluder::kFurniture || 2 * hidden_by_room <= patches.size();
}

/// Cameras and occluders for a placed object, until its stopping surface is hidden.
bool hide(const ScenarioRoom& from, const std::vector<std::pair<double, Patch>>& patches,
          CounterRandom& random, Scenario& scenario) {
  constexpr int kCameras = 12;
  for (int i = 0; i < kCameras; ++i) {
    if (!draw_camera(from, random, scenario) || !place_occluder(from, random, scenario)) continue;
    if (is_hidden_as_meant(from, scenario, patches)) return true;
  }
  return false;
}

std::optional<Scenario> draw_scenario(const ScenarioRoom& from, Occluder occluder, bool drop,
                                      CounterRandom& random) {
  Scenario scenario;
  scenario.room = from.room.name;
  scenario.occluder = occluder;
  const std::optional<Patch> patch = draw_patch(from, random);
  if (!patch || !was_seen(from, *patch) || !place_object(from, *patch, drop, random, scenario))
    return std::nullopt;
  const auto patches = stopping_patches(from.room, scenario, scenario.true_travel_m + kBeyond_m);
  if (patches.size() < 3) return std::nullopt;
  if (!std::all_of(patches.begin(), patches.end(),
                   [&](const auto& one) { return was_seen(from, one.second); }))
    return std::nullopt;
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
      return "person";
  }
  return "?";
}

ScenarioRoom make_scenario_room(std::string_view name) {
  ScenarioRoom from;
  from.room = make_room(name);
  from.prescan.room = from.room.name;
  from.prescan.frames = 720;  // once round
  const double duration_s = static_cast<double>(from.prescan.frames) / from.prescan.rate_hz;
  const CameraPath path = plan_camera_path(from.room, from.prescan.path, from.prescan.seed, duration_s);
  for (std::int64_t frame = 0; frame < from.prescan.frames; frame += 10)
    from.T_world_prescan.push_back(
        T_world_camera_at(path, static_cast<double>(frame) / from.prescan.rate_hz));
  return from;
}

Scenario make_scenario(const ScenarioRoom& room, std::uint64_t seed, std::int64_t number) {
  constexpr std::uint64_t kDraws = 4000;
  std::uint64_t room_key = 0;  // so that rooms differ in more than their furniture
  for (const char letter : room.room.name) room_key = mixed(room_key + static_cast<unsigned char>(letter));
  const bool drop = number / static_cast<std::int64_t>(kOccluders.size()) % 2 == 0;
  for (std::size_t turn = 0; turn < kOccluders.size(); ++turn) {
    const Occluder occluder = kOccluders[(static_cast<std::size_t>(number) + turn) % kOccluders.size()];
    for (std::uint64_t draw = 0; draw < kDraws; ++draw) {
      CounterRandom random(hash_of(seed, static_cast<std::uint64_t>(number), room_key), turn * kDraws + draw);
      std::optional<Scenario> scenario = draw_scenario(room, occluder, drop, random);
      if (!scenario) continue;
      scenario->seed = seed;
      scenario->number = number;
      append_mesh(scenario->object, {210, 170, 60}, kMeshDeviation_m, scenario->object_mesh);
      return *scenario;
    }
  }
  throw Error("room '" + room.room.name + "' has no hidden surface for scenario " + std::to_string(number) +
              " of seed " + std::to_string(seed) + "; try another seed");
}

void render_scenario(const Scenario& scenario, const Room& room, double noise_scale, Frame& frame) {
  std::vector<Solid> solids = room.solids;
  solids.insert(solids.end(), scenario.occluder_solids.begin(), scenario.occluder_solids.end());
  std::vector<float> infrared;
  for (const Material& material : room.materials) infrared.push_back(material.infrared);
  for (const Material& material : scenario.occluder_materials) infrared.push_back(material.infrared);
  ViewCaster view;
  ExactView exact;
  view.prepare(solids, scenario.depth_camera, scenario.T_world_camera);
  render_exact(solids, view, scenario.depth_camera, exact);
  if (noise_scale > 0.0) {
    KinectScratch scratch;
    measure_depth(solids, infrared, view, exact, scenario.depth_camera, scenario.T_world_camera, noise_scale,
                  scenario.seed, scenario.number, scratch, frame.depth_m);
  } else {
    frame.depth_m = exact.depth_m;
    for (float& depth_m : frame.depth_m.pixels)
      if (depth_m < static_cast<float>(kKinectNearest_m) || depth_m > static_cast<float>(kKinectFarthest_m))
        depth_m = 0.0F;
  }
  frame.index = scenario.number;
  frame.stamp_s = static_cast<double>(scenario.number) / 30.0;
  frame.depth_camera = scenario.depth_camera;
  frame.colour = {};
  frame.colour_camera = {};
  frame.T_world_camera = scenario.T_world_camera;
  frame.down_camera = scenario.T_world_camera.linear().transpose() * -Vector3d::UnitZ();
}

Verdict judge(const Scenario& scenario, double travelled_m) {
  constexpr double kTooFar_m = 0.02, kTooShort_m = 0.03;
  Verdict verdict;
  verdict.error_m = travelled_m - scenario.true_travel_m;
  if (verdict.error_m > kTooFar_m) verdict.outcome = Outcome::kPassedThrough;
  if (verdict.error_m < -kTooShort_m) verdict.outcome = Outcome::kStoppedFalse;
  return verdict;
}

}  // namespace roomradar
