// building_corridor.cpp: furnishes the free stretches of a corridor's walls.
#include "app/sim/building/building_corridor.hpp"

#include <algorithm>
#include <vector>

#include "app/sim/building/building_paint.hpp"
#include "app/sim/building/building_walls.hpp"
#include "app/sim/room/furniture.hpp"
#include "mapping/types/system/counter_random.hpp"

namespace roomradar {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kGap_m = 0.01;  ///< between a piece of furniture and the wall
constexpr double kFrameWide_m = 0.08, kFrameDeep_m = 0.04;

/// A stretch of a wall.
struct Stretch {
  double from_m = 0.0, to_m = 0.0;
};

/// A wall that is being furnished.
struct Wall {
  Room& room;
  Isometry3d T_world_wall;  ///< as in add_wall()
  CounterRandom random;
  std::uint32_t look;

  std::uint32_t next_look() { return ++look; }
  [[nodiscard]] Isometry3d T_world_at(double x_m, double deep_m, double z_m = 0.0) const {
    return T_world_wall * standing_at(x_m, -0.5 * deep_m - kGap_m, z_m);
  }
};

void add_door_frame(Wall& wall, const WallOpening& door, const Material& colour) {
  for (const double side_m : {door.from_m - 0.5 * kFrameWide_m, door.to_m + 0.5 * kFrameWide_m})
    add(wall.room, wall.T_world_wall,
        box({side_m, -0.5 * kFrameDeep_m, 0.5 * door.high_m}, {kFrameWide_m, kFrameDeep_m, door.high_m}),
        colour);
  add(wall.room, wall.T_world_wall,
      box({0.5 * (door.from_m + door.to_m), -0.5 * kFrameDeep_m, door.high_m + 0.5 * kFrameWide_m},
          {door.to_m - door.from_m + 2.0 * kFrameWide_m, kFrameDeep_m, kFrameWide_m}),
      colour);
}

void add_sign(Wall& wall, double x_m) {
  const std::uint32_t look = wall.next_look();
  add(wall.room, wall.T_world_wall, box({x_m, -0.01, 1.62}, {0.24, 0.02, 0.2}), picture_of(look * 7 + 3));
}

void add_plant(Wall& wall, double x_m) {
  constexpr double kWide_m = 0.42;
  const Isometry3d T_world_pot = wall.T_world_at(x_m, kWide_m);
  const double pot_m = wall.random.uniform(0.25, 0.45), ball_m = wall.random.uniform(0.16, 0.2);
  const Material leaves{Pattern::kStone, {66, 122, 58}, {28, 62, 30}, wall.next_look(), 0.5F};
  add(wall.room, T_world_pot, cylinder({0, 0, 0}, 0.16, pot_m), lacquer(wall.next_look(), wall.look));
  add(wall.room, T_world_pot, cylinder({0, 0, pot_m}, 0.02, 0.25), frame_of(wall.look));
  add(wall.room, T_world_pot, sphere({0, 0, pot_m + 0.25 + ball_m}, ball_m), leaves);
  add(wall.room, T_world_pot, sphere({0, 0, pot_m + 0.25 + 2.0 * ball_m + 0.13}, 0.13), leaves);
}

void add_extinguisher(Wall& wall, double x_m) {
  const Material red{Pattern::kPortable, {196, 30, 30}, {150, 20, 20}, wall.next_look(), 0.5F};
  add(wall.room, wall.T_world_at(x_m, 0.16), cylinder({0, 0, 0.35}, 0.08, 0.5), red);
  add(wall.room, wall.T_world_at(x_m, 0.1), cylinder({0, 0, 0.85}, 0.03, 0.08), frame_of(wall.look));
}

/// Adds a radiator: ribs before a plate.
void add_radiator(Wall& wall, double x_m, double wide_m) {
  const Material enamel{Pattern::kPortable, {228, 226, 220}, {190, 188, 182}, wall.next_look(), 0.6F};
  add(wall.room, wall.T_world_at(x_m, 0.03), box({0, 0, 0.45}, {wide_m, 0.03, 0.6}), enamel);
  const int ribs = static_cast<int>(wide_m / 0.12);
  for (int i = 0; i < ribs; ++i)
    add(wall.room, wall.T_world_at(x_m, 0.03) * standing_at((i + 0.5) * wide_m / ribs - 0.5 * wide_m, 0, 0),
        box({0, -0.015 - 0.03, 0.45}, {0.06, 0.06, 0.56}), enamel);
}

/// Adds a thing to the stretch from x_m on and returns the width it takes; 0 if nothing that was drawn fits.
double add_thing(Wall& wall, double x_m, double most_m) {
  const double kind = wall.random.uniform(), wide_m = wall.random.uniform(0.5, 1.1);
  const std::uint32_t look = wall.next_look();
  const Material wood = frame_of(look * 11 + 5);
  const double middle_m = x_m + 0.5 * wide_m;
  if (kind < 0.42) {
    if (wide_m + 0.1 > most_m) return 0.0;
    const double high_m = wall.random.uniform(0.4, 0.8), z_m = wall.random.uniform(1.35, 1.6);
    add_picture(wall.room, wall.T_world_wall * standing_at(middle_m + 0.05, 0, z_m), wide_m, high_m,
                picture_of(look * 13 + 1), wood);
    return wide_m + 0.1;
  }
  if (kind < 0.54) {
    if (wide_m > most_m) return 0.0;
    const double high_m = wall.random.uniform(0.7, 1.3);
    add_cupboard(wall.room, wall.T_world_at(middle_m, 0.42), {wide_m, 0.37, high_m}, wood);
    return wide_m;
  }
  if (kind < 0.64) {
    if (wide_m > most_m) return 0.0;
    add_table(wall.room, wall.T_world_at(middle_m, 0.38), {wide_m, 0.38, 0.45}, wood);
    if (wall.random.uniform() < 0.5) add_book_pile(wall.room, wall.T_world_at(middle_m, 0.38, 0.45), 3, look);
    return wide_m;
  }
  if (kind < 0.72) {
    if (wide_m > most_m) return 0.0;
    add_radiator(wall, middle_m, wide_m);
    return wide_m;
  }
  if (kind < 0.84) {
    if (most_m < 0.45) return 0.0;
    add_plant(wall, x_m + 0.22);
    return 0.44;
  }
  if (kind < 0.92) {
    if (most_m < 0.3) return 0.0;
    add_extinguisher(wall, x_m + 0.15);
    return 0.3;
  }
  if (most_m < 0.4) return 0.0;
  add(wall.room, wall.T_world_at(x_m + 0.2, 0.34), cylinder({0, 0, 0}, 0.16, 0.55), lacquer(look, look));
  return 0.4;
}

void furnish(Wall& wall, const Stretch& stretch) {
  constexpr double kNothingFits_m = 0.3;
  double x_m = stretch.from_m + wall.random.uniform(0.0, 0.25);
  while (stretch.to_m - x_m > kNothingFits_m) {
    double wide_m = 0.0;
    for (int attempt = 0; attempt < 4 && wide_m == 0.0; ++attempt)
      wide_m = add_thing(wall, x_m, stretch.to_m - x_m);
    x_m += std::max(wide_m, 0.2) + wall.random.uniform(0.15, 0.6);
  }
}

void furnish_side(Wall& wall, const CorridorPiece& piece, unsigned side, std::vector<WallOpening> doors) {
  constexpr double kBesideDoor_m = 0.25, kSign_m = 0.3;
  std::sort(doors.begin(), doors.end(),
            [](const WallOpening& a, const WallOpening& b) { return a.from_m < b.from_m; });
  const double half_m = 0.5 * piece.interior_m.sizes()[side < 2 ? 0 : 1];
  // Furniture on walls along y keeps off the corners, where that of the walls along x stands.
  const double corner_m = side < 2 ? 0.05 : kCorridorFurniture_m + 0.1;
  double from_m = -half_m + corner_m;
  for (const WallOpening& door : doors) {
    add_door_frame(wall, door, lacquer(wall.next_look(), wall.look));
    furnish(wall, {from_m, door.from_m - kBesideDoor_m});
    from_m = door.to_m + kBesideDoor_m;
    if (half_m - corner_m - from_m > kSign_m) {
      add_sign(wall, door.to_m + 0.25);
      from_m += kSign_m;
    }
  }
  furnish(wall, {from_m, half_m - corner_m});
}

}  // namespace

void add_corridor_piece(Room& room, const BuildingPlan& plan, int piece, int floor, std::uint32_t look) {
  constexpr int kPiecesPerPaint = 3;  // the paint changes along the corridor
  const CorridorPiece& own = plan.pieces[static_cast<std::size_t>(piece)];
  const std::uint64_t floor_seed = hash_of(plan.seed, 0x666c6f6f, static_cast<std::uint64_t>(floor));
  const Material ceiling{Pattern::kTiles, {232, 230, 224}, {196, 194, 188}, look + 1, 0.65F};
  const std::uint64_t paint_seed = hash_of(floor_seed, static_cast<std::uint64_t>(piece / kPiecesPerPaint));
  add_piece_shell(room, plan, own, floor,
                  {.ground = floor_covering(floor_seed, look + 2),
                   .ceiling = ceiling,
                   .walls = wall_paint(paint_seed, look + 3)});
  for (unsigned side = 0; side < 4; ++side) {
    std::vector<WallOpening> doors;
    bool is_wall = true;
    for (const PieceOpening& opening : own.openings) {
      if (opening.side != side || !is_open_on(plan, opening, floor)) continue;
      is_wall = is_wall && opening.leads_to != LeadsTo::kPiece;
      doors.push_back(opening_in_side(own, opening));
    }
    if (!is_wall) continue;
    Wall wall{room, T_world_side(own, side, floor),
              CounterRandom(hash_of(floor_seed, 0x77616c6c, static_cast<std::uint64_t>(piece)), side),
              look + 1000 * (side + 1)};
    furnish_side(wall, own, side, std::move(doors));
  }
  const Eigen::Vector2d middle = own.interior_m.center();
  room.lamps.push_back(
      {{middle.x(), middle.y(), floor_height_m(floor) + kCorridorHeight_m - 0.2}, 1.5F, 0.2});
}

}  // namespace roomradar
