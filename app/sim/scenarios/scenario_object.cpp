// scenario_object.cpp: builds balls, needles, cups, chairs etc. from boxes, cylinders and capsules.
#include "app/sim/scenarios/scenario_object.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/sim/room/room_mesh.hpp"
#include "app/sim/solids/angles.hpp"
#include "app/sim/solids/solid_distance.hpp"

namespace roomradar {
namespace {

using Eigen::Vector3d;

constexpr double kThin_m = 0.002;

/// Draws a log-uniform size, so small and large objects are equally frequent.
double draw_size_m(CounterRandom& random, double least_m, double most_m) {
  return least_m * std::pow(most_m / least_m, random.uniform());
}

/// Builds a cup: its wall as a ring of upright boards that overlap at their edges, and its floor.
std::vector<Solid> cup(double radius_m, double height_m, double wall_m) {
  constexpr int kBoards = 20;
  const double middle_m = radius_m - 0.5 * wall_m;
  const double width_m = 2.0 * radius_m * std::tan(0.5 * kFullTurn_rad / kBoards);
  std::vector<Solid> parts{cylinder({0, 0, 0}, radius_m, wall_m)};
  for (int i = 0; i < kBoards; ++i) {
    const double angle = kFullTurn_rad * i / kBoards;
    parts.push_back(box({middle_m * std::cos(angle), middle_m * std::sin(angle), 0.5 * height_m},
                        {wall_m, width_m, height_m}, angle));
  }
  return parts;
}

std::vector<Solid> torus(double ring_m, double tube_m) {
  constexpr int kCapsules = 24;
  std::vector<Solid> parts;
  const auto at = [&](int i) {
    return Vector3d(ring_m * std::cos(kFullTurn_rad * i / kCapsules),
                    ring_m * std::sin(kFullTurn_rad * i / kCapsules), 0);
  };
  for (int i = 0; i < kCapsules; ++i) parts.push_back(capsule(at(i), at(i + 1), tube_m));
  return parts;
}

void add_legs(const Vector3d& board_m, double height_m, double leg_m, std::vector<Solid>& parts) {
  const double x = 0.5 * (board_m.x() - leg_m), y = 0.5 * (board_m.y() - leg_m);
  for (const double side_x : {-1.0, 1.0})
    for (const double side_y : {-1.0, 1.0})
      parts.push_back(box({side_x * x, side_y * y, 0.5 * height_m}, {leg_m, leg_m, height_m}));
}

std::vector<Solid> chair(double height_m) {
  const double seat_m = 0.5 * height_m, wide_m = 0.48 * height_m, board_m = 0.04 * height_m;
  std::vector<Solid> parts{box({0, 0, seat_m}, {wide_m, wide_m, board_m})};
  add_legs({wide_m, wide_m, board_m}, seat_m, board_m, parts);
  parts.push_back(
      box({0, 0.5 * (wide_m - board_m), 0.5 * (seat_m + height_m)}, {wide_m, board_m, height_m - seat_m}));
  return parts;
}

std::vector<Solid> table(double wide_m, double deep_m, double height_m) {
  const Vector3d board_m(wide_m, deep_m, 0.03);
  std::vector<Solid> parts{box({0, 0, height_m}, board_m)};
  add_legs(board_m, height_m, 0.05, parts);
  return parts;
}

std::vector<Solid> draw_parts(ObjectShape shape, CounterRandom& random) {
  const double size_m = draw_size_m(random, 0.04, 0.30);
  const auto part_m = [&] { return std::max(0.04, random.uniform(0.4, 1.0) * size_m); };
  switch (shape) {
    case ObjectShape::kBall:
      return {sphere({0, 0, 0}, 0.5 * size_m)};
    case ObjectShape::kBox:
      return {box({0, 0, 0}, {size_m, part_m(), part_m()})};
    case ObjectShape::kCylinder:
      return {cylinder({0, 0, 0}, 0.5 * part_m(), size_m)};
    case ObjectShape::kNeedle:
      return {cylinder({0, 0, 0}, 0.5 * kThin_m, draw_size_m(random, 0.05, 0.4))};
    case ObjectShape::kSheet:
      return {box({0, 0, 0}, {draw_size_m(random, 0.08, 0.6), draw_size_m(random, 0.08, 0.4), kThin_m})};
    case ObjectShape::kCup: {
      const double thick_m = random.uniform(0.003, 0.006), high_m = random.uniform(0.06, 0.14),
                   radius_m = random.uniform(0.03, 0.05);
      return cup(radius_m, high_m, thick_m);
    }
    case ObjectShape::kTorus: {
      const double across_m = draw_size_m(random, 0.08, 0.4), tube_m = random.uniform(0.06, 0.14) * across_m;
      return torus(0.5 * across_m - tube_m, tube_m);
    }
    case ObjectShape::kChair:
      return chair(random.uniform(0.5, 1.0));
    case ObjectShape::kTable:
      break;
  }
  const double high_m = random.uniform(0.35, 0.75), deep_m = random.uniform(0.4, 0.8),
               wide_m = random.uniform(0.5, 1.3);
  return table(wide_m, deep_m, high_m);
}

}  // namespace

std::string_view to_string(ObjectShape shape) {
  switch (shape) {
    case ObjectShape::kBall:
      return "ball";
    case ObjectShape::kBox:
      return "box";
    case ObjectShape::kCylinder:
      return "cylinder";
    case ObjectShape::kNeedle:
      return "needle";
    case ObjectShape::kSheet:
      return "sheet";
    case ObjectShape::kCup:
      return "cup";
    case ObjectShape::kTorus:
      return "torus";
    case ObjectShape::kChair:
      return "chair";
    case ObjectShape::kTable:
      break;
  }
  return "table";
}

ScenarioObject draw_object(ObjectShape shape, CounterRandom& random) {
  ScenarioObject object;
  object.shape = shape;
  object.parts = draw_parts(shape, random);
  Eigen::AlignedBox3d bounds;
  for (const Solid& part : object.parts) bounds.extend(bounds_world(part));
  for (Solid& part : object.parts) {
    part.T_world_solid.pretranslate(-bounds.center());
    object.reach_m =
        std::max(object.reach_m, part.T_world_solid.translation().norm() + part.half_m.norm() + part.round_m);
  }
  return object;
}

Mesh object_mesh(const ScenarioObject& object) {
  Mesh mesh;
  for (const Solid& part : object.parts) append_mesh(part, {210, 170, 60}, kMeshDeviation_m, mesh);
  return mesh;
}

}  // namespace roomradar
