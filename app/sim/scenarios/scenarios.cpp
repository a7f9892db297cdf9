// scenarios.cpp: draws placements until the surface that stops the object is hidden now but was seen before.
#include "app/sim/scenarios/scenarios.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "app/sim/scenarios/scenario_hiding.hpp"
#include "app/sim/sensor/camera_path.hpp"
#include "app/sim/solids/angles.hpp"
#include "app/sim/solids/solid_distance.hpp"
#include "app/sim/solids/swept_travel.hpp"
#include "mapping/types/system/counter_random.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

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
