// building_stairs.cpp: builds flights of nine risers from boxes, with a banister of posts and a rail.
#include "app/sim/building/building_stairs.hpp"

#include <algorithm>
#include <numbers>

#include "app/sim/building/building_paint.hpp"
#include "app/sim/building/building_walls.hpp"
#include "app/sim/room/furniture.hpp"
#include "mapping/types/system/counter_random.hpp"

namespace roomradar {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kHalfWidth_m = 0.5 * kStairwellWidth_m;
constexpr double kFlightEnd_m = kStairwellLength_m - kLanding_m;
constexpr double kRiser_m = kStoreyHeight_m / (2 * kRisersPerFlight);
constexpr double kTopStorey_m = 2.8;

/// Adds a box from `low` to `high` in the frame of the stairwell.
void add_box(Room& room, const Isometry3d& T_world_stairs, const Vector3d& low, const Vector3d& high,
             const Material& material) {
  add(room, T_world_stairs, box(0.5 * (low + high), high - low), material);
}

/// Adds eight steps and their banister. `is_return`: the flight back, at y > 0.
void add_flight(Room& room, const Isometry3d& T_world_stairs, double foot_m, bool is_return,
                const Material& stone, const Material& rail) {
  constexpr double kPost_m = 0.015, kRail_m = 0.025, kRailHigh_m = 0.92;
  constexpr double kPostEnd_m = 0.04;  // below the rail's axis, where the post touches the inclined rail
  const double side = is_return ? 1.0 : -1.0;
  const double inner_m = side * 0.5 * kFlightGap_m, outer_m = side * kHalfWidth_m;
  const double post_y = inner_m - side * kPost_m;
  Vector3d rail_from, rail_to;
  for (int step = 1; step < kRisersPerFlight; ++step) {
    const double x =
        is_return ? kFlightEnd_m - (step - 0.5) * kTread_m : kLanding_m + (step - 0.5) * kTread_m;
    const double top_m = foot_m + step * kRiser_m, low_m = std::max(0.0, top_m - 2.0 * kRiser_m);
    add_box(room, T_world_stairs, {x - 0.5 * kTread_m, std::min(inner_m, outer_m), low_m},
            {x + 0.5 * kTread_m, std::max(inner_m, outer_m), top_m}, stone);
    const double post_end_m = top_m + kRailHigh_m - kPostEnd_m;
    add(room, T_world_stairs, cylinder({x, post_y, low_m}, kPost_m, post_end_m - low_m), rail);
    rail_to = Vector3d(x, post_y, top_m + kRailHigh_m);
    if (step == 1) rail_from = rail_to;
  }
  add(room, T_world_stairs, capsule(rail_from, rail_to, kRail_m), rail);
}

void add_walls(Room& room, const Isometry3d& T_world_stairs, int storey, double height_m, bool is_top,
               const WallPaint& paint) {
  const Isometry3d T_world_storey = T_world_stairs * standing_at(0, 0, floor_height_m(storey));
  const double front_m =
      is_top ? height_m : height_m - kShellThickness_m;  // below the landing that ends above it
  const auto own = [&paint](unsigned side) {
    WallPaint result = paint;
    result.dado.seed += 40 * side;
    result.upper.seed += 40 * side;
    return result;
  };
  constexpr double kQuarter_rad = 0.5 * std::numbers::pi;
  add_wall(room, T_world_storey * standing_at(0, 0, 0, kQuarter_rad), {-kHalfWidth_m, kHalfWidth_m, front_m},
           {{-0.5 * kStairDoorWidth_m, 0.5 * kStairDoorWidth_m, kDoorwayHeight_m}}, own(1));
  add_wall(room, T_world_storey * standing_at(kStairwellLength_m, 0, 0, -kQuarter_rad),
           {-kHalfWidth_m, kHalfWidth_m, height_m}, {}, own(2));
  add_wall(room, T_world_storey * standing_at(0, kHalfWidth_m, 0),
           {-kShellThickness_m, kStairwellLength_m + kShellThickness_m, height_m}, {}, own(3));
  add_wall(room, T_world_storey * standing_at(0, -kHalfWidth_m, 0, std::numbers::pi),
           {-kStairwellLength_m - kShellThickness_m, kShellThickness_m, height_m}, {}, own(4));
}

/// Adds pictures beside a storey's flights and landings, lower than eyes, as the camera looks down.
void add_pictures(Room& room, const Isometry3d& T_world_stairs, double floor_m, bool is_top,
                  std::uint32_t look) {
  constexpr double kEye_m = 1.2, kHalfStorey_m = 0.5 * kStoreyHeight_m, kHalfTurn_rad = std::numbers::pi;
  const auto hang = [&](const Isometry3d& T_stairs_picture, double width_m, double height_m,
                        std::uint32_t number) {
    add_picture(room, T_world_stairs * T_stairs_picture, width_m, height_m, picture_of(look + number),
                frame_of(look + number));
  };
  const auto hang_at_sides = [&](double x, double right_z, double left_z, std::uint32_t number) {
    hang(standing_at(x, -kHalfWidth_m, right_z, kHalfTurn_rad), 0.7, 0.5, number);
    hang(standing_at(x, kHalfWidth_m, left_z), 0.7, 0.5, number + 1);
  };
  hang_at_sides(0.5 * kLanding_m, floor_m + kEye_m, floor_m + kEye_m, 0);
  if (is_top) return;
  hang_at_sides(kStairwellLength_m - 0.5 * kLanding_m, floor_m + kHalfStorey_m + kEye_m,
                floor_m + kHalfStorey_m + kEye_m, 2);
  for (const double aside_m : {-0.9, 0.9}) {
    const std::uint32_t number = aside_m > 0.0 ? 7 : 4;
    const double risen_m = 0.5 * kHalfStorey_m + aside_m * kRiser_m / kTread_m;
    hang_at_sides(0.5 * kStairwellLength_m + aside_m, floor_m + risen_m + kEye_m,
                  floor_m + kStoreyHeight_m - risen_m + kEye_m, number);
    hang(standing_at(kStairwellLength_m, 0.7 * aside_m, floor_m + kHalfStorey_m + 1.15,
                     -0.5 * std::numbers::pi),
         0.9, 0.8, number + 2);
  }
}

}  // namespace

double stairwell_top_m(const BuildingPlan& plan) {
  return floor_height_m(plan.size.floors - 1) + kTopStorey_m;
}

void add_stairwell(Room& room, const BuildingPlan& plan, const PlannedStairs& stairs, std::uint32_t look) {
  const Isometry3d& T_world_stairs = stairs.T_world_stairs;
  const Material stone{Pattern::kStone, {176, 172, 164}, {104, 100, 96}, look + 1, 0.55F};
  const Material rail{Pattern::kWood, {150, 96, 54}, {96, 58, 30}, look + 2, 0.5F};
  const Material ceiling{Pattern::kPlaster, {226, 224, 218}, {198, 196, 190}, look + 3, 0.65F};
  add_box(room, T_world_stairs, {-kShellThickness_m, -kHalfWidth_m - kShellThickness_m, -kShellThickness_m},
          {kStairwellLength_m + kShellThickness_m, kHalfWidth_m + kShellThickness_m, 0.0}, stone);
  const double top_m = stairwell_top_m(plan);
  add_box(
      room, T_world_stairs, {-kShellThickness_m, -kHalfWidth_m - kShellThickness_m, top_m},
      {kStairwellLength_m + kShellThickness_m, kHalfWidth_m + kShellThickness_m, top_m + kShellThickness_m},
      ceiling);
  for (int storey = 0; storey < plan.size.floors; ++storey) {
    const bool is_top = storey + 1 == plan.size.floors;
    const double floor_m = floor_height_m(storey);
    const std::uint32_t own_look = look + 1000 * static_cast<std::uint32_t>(storey + 1);
    add_walls(room, T_world_stairs, storey, is_top ? kTopStorey_m : kStoreyHeight_m, is_top,
              wall_paint(hash_of(plan.seed, 0x73746169, own_look), own_look));
    room.lamps.push_back({T_world_stairs * Vector3d(0.5 * kLanding_m, 0, floor_m + 2.5), 1.0F, 0.2});
    if (storey > 0) {  // a landing, and the doorway's floor between the walls above and below
      add_box(room, T_world_stairs, {0.0, -kHalfWidth_m, floor_m - 0.2}, {kLanding_m, kHalfWidth_m, floor_m},
              stone);
      add_box(room, T_world_stairs, {-kShellThickness_m, -kHalfWidth_m, floor_m - kShellThickness_m},
              {0.0, kHalfWidth_m, floor_m}, stone);
    }
    add_pictures(room, T_world_stairs, floor_m, is_top, own_look);
    // Beside the door.
    const Isometry3d T_stairs_sign =
        standing_at(0, 0.5 * (0.5 * kStairDoorWidth_m + kHalfWidth_m), floor_m + 1.6, 0.5 * std::numbers::pi);
    add_picture(room, T_world_stairs * T_stairs_sign, 0.4, 0.5, picture_of(own_look + 9),
                frame_of(own_look + 9));
    if (is_top) {
      add_box(room, T_world_stairs, {kLanding_m - 0.06, -kHalfWidth_m, floor_m},
              {kLanding_m, -0.5 * kFlightGap_m, floor_m + 1.0}, rail);
      continue;
    }
    const double half_m = floor_m + 0.5 * kStoreyHeight_m;
    add_flight(room, T_world_stairs, floor_m, false, stone, rail);
    add_flight(room, T_world_stairs, half_m, true, stone, rail);
    add_box(room, T_world_stairs, {kFlightEnd_m, -kHalfWidth_m, half_m - 0.2},
            {kStairwellLength_m, kHalfWidth_m, half_m}, stone);
    room.lamps.push_back(
        {T_world_stairs * Vector3d(kStairwellLength_m - 0.5 * kLanding_m, 0, half_m + 2.3), 1.2F, 0.2});
  }
}

}  // namespace roomradar
