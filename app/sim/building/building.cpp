// building.cpp: puts rooms, corridors and stairwells together, with the openings and lamps between them.
#include "app/sim/building/building.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <vector>

#include "app/sim/building/building_plan.hpp"
#include "app/sim/building/building_walk.hpp"
#include "app/sim/room/furniture.hpp"
#include "app/sim/room/room.hpp"
#include "app/sim/room/room_random.hpp"
#include "mapping/types/system/counter_random.hpp"

namespace roomradar {
namespace {

/// An opening in a wall, which begins at the wall's bottom.
struct WallOpening {
  double from_m = 0.0, to_m = 0.0;  ///< range along the wall's x axis
  double high_m = 0.0;
};

/// Size of a wall.
struct WallExtent {
  double from_m = 0.0, to_m = 0.0;  ///< range along the wall's x axis
  double height_m = 0.0;
};

/// Materials of a wall: a dado of height kDado_m below, paint above.
struct WallPaint {
  Material dado, upper;
};
constexpr double kDado_m = 1.1;

/// Materials of a corridor segment.
struct ShellMaterials {
  Material ground, ceiling;
  WallPaint walls;
};

using Eigen::Isometry3d;
using Eigen::Vector3d;

bool leads_to_piece(const CorridorPiece& piece, unsigned side) {
  return std::any_of(piece.openings.begin(), piece.openings.end(), [side](const PieceOpening& opening) {
    return opening.side == side && opening.leads_to == LeadsTo::kPiece;
  });
}

/// Returns how far a wall along y extends beyond its piece at the piece's end `end` (side 0 or 1): over the
/// wall there, or short of the wall of the corridor that begins behind the corner.
double beyond_m(const BuildingPlan& plan, const CorridorPiece& piece, unsigned side, unsigned end) {
  for (const PieceOpening& opening : piece.openings)
    if (opening.side == end && opening.leads_to == LeadsTo::kPiece)
      return leads_to_piece(plan.pieces[static_cast<std::size_t>(opening.number)], side) ? -kShellThickness_m
                                                                                         : 0.0;
  return kShellThickness_m;
}

/// Adds a wall of thickness kShellThickness_m. In the wall's frame, x is along the inner edge of the wall's
/// bottom face, to the right as seen from inside. -y points into the room.
/// @param openings  without overlap, at least kDado_m high
void add_wall(Room& room, const Isometry3d& T_world_wall, const WallExtent& extent,
              std::vector<WallOpening> openings, const WallPaint& paint) {
  std::sort(openings.begin(), openings.end(),
            [](const WallOpening& a, const WallOpening& b) { return a.from_m < b.from_m; });
  const auto add_box = [&](double left_m, double right_m, double low_m, double high_m,
                           const Material& material) {
    if (right_m <= left_m || high_m <= low_m) return;
    add(room, T_world_wall,
        box({0.5 * (left_m + right_m), 0.5 * kShellThickness_m, 0.5 * (low_m + high_m)},
            {right_m - left_m, kShellThickness_m, high_m - low_m}),
        material);
  };
  WallPaint part = paint;
  double left_m = extent.from_m;
  const auto add_part = [&](double right_m) {
    ++part.dado.seed;
    ++part.upper.seed;
    add_box(left_m, right_m, 0.0, kDado_m, part.dado);
    add_box(left_m, right_m, kDado_m, extent.height_m, part.upper);
  };
  for (const WallOpening& opening : openings) {
    add_part(opening.from_m);
    add_box(opening.from_m, opening.to_m, opening.high_m, extent.height_m, part.upper);
    left_m = opening.to_m;
  }
  add_part(extent.to_m);
}

/// Returns true if `opening` exists on this floor. An upper floor without the last room has no opening to it.
bool is_open_on(const BuildingPlan& plan, const PieceOpening& opening, int floor) {
  const auto at = static_cast<std::size_t>(floor);
  return opening.leads_to != LeadsTo::kRoom ||
         opening.number < plan.first_of_floor[at + 1] - plan.first_of_floor[at];
}

/// Frame of one wall of a corridor segment. The axes are those of add_wall(). The origin is the midpoint of
/// the wall's inner bottom edge.
Isometry3d T_world_side(const CorridorPiece& piece, unsigned side, int floor) {
  const Eigen::Vector2d low = piece.interior_m.min(), high = piece.interior_m.max(),
                        middle = piece.interior_m.center();
  const double z_m = floor_height_m(floor);
  switch (side) {
    case 0:
      return standing_at(middle.x(), high.y(), z_m);
    case 1:
      return standing_at(middle.x(), low.y(), z_m, std::numbers::pi);
    case 2:
      return standing_at(low.x(), middle.y(), z_m, 0.5 * std::numbers::pi);
    default:
      return standing_at(high.x(), middle.y(), z_m, -0.5 * std::numbers::pi);
  }
}

/// Returns an opening in the frame of its side's wall.
WallOpening opening_in_side(const CorridorPiece& piece, const PieceOpening& opening) {
  const double middle_m = piece.interior_m.center()[opening.side < 2 ? 0 : 1];
  const double high_m = opening.leads_to == LeadsTo::kPiece ? kCorridorHeight_m : kDoorwayHeight_m;
  if (opening.side == 0 || opening.side == 2)
    return {opening.from_m - middle_m, opening.to_m - middle_m, high_m};
  return {middle_m - opening.to_m, middle_m - opening.from_m, high_m};
}

/// Adds floor, ceiling and walls of a corridor segment.
void add_piece_shell(Room& room, const BuildingPlan& plan, const CorridorPiece& piece, int floor,
                     const ShellMaterials& materials) {
  Eigen::AlignedBox2d slab = piece.interior_m;
  const Eigen::Vector2d size = piece.interior_m.sizes();
  for (unsigned side = 0; side < 4; ++side) {
    if (leads_to_piece(piece, side)) continue;
    std::vector<WallOpening> openings;
    bool has_stairs = false;
    for (const PieceOpening& opening : piece.openings) {
      if (opening.side != side || !is_open_on(plan, opening, floor)) continue;
      openings.push_back(opening_in_side(piece, opening));
      has_stairs = has_stairs || opening.leads_to == LeadsTo::kStairs;
    }
    const Isometry3d T_world_wall = T_world_side(piece, side, floor);
    const double half_m = 0.5 * size[side < 2 ? 0 : 1];
    // Walls along y end beside walls along x. The wall's x axis points north on side 2, south on side 3.
    const double right_m = side < 2 ? 0.0 : beyond_m(plan, piece, side, side == 2 ? 0 : 1),
                 left_m = side < 2 ? 0.0 : beyond_m(plan, piece, side, side == 2 ? 1 : 0);
    WallPaint own = materials.walls;
    own.dado.seed += 40 * (side + 1);
    own.upper.seed += 40 * (side + 1);
    add_wall(room, T_world_wall, {-half_m - left_m, half_m + right_m, kCorridorHeight_m}, std::move(openings),
             own);
    // The floor extends under walls with doorways.
    if (side == 0) slab.max().y() += kShellThickness_m;
    if (side == 1) slab.min().y() -= kShellThickness_m;
    if (side == 2 && has_stairs) slab.min().x() -= kShellThickness_m;
    if (side == 3 && has_stairs) slab.max().x() += kShellThickness_m;
  }
  const double z_m = floor_height_m(floor);
  const Eigen::Vector2d middle = slab.center(), extent = slab.sizes();
  const Isometry3d world = Isometry3d::Identity();
  add(room, world,
      box({middle.x(), middle.y(), z_m - 0.5 * kShellThickness_m},
          {extent.x(), extent.y(), kShellThickness_m}),
      materials.ground);
  add(room, world,
      box({middle.x(), middle.y(), z_m + kCorridorHeight_m + 0.5 * kShellThickness_m},
          {extent.x(), extent.y(), kShellThickness_m}),
      materials.ceiling);
}

/// Returns a colour of this hue (0 to 1), saturation and value.
Rgb hsv(double hue, double saturation, double value) {
  const auto part = [&](double shift) {
    const double k = std::fmod(shift + 6.0 * hue, 6.0);
    const double of = value - value * saturation * std::clamp(std::min(k, 4.0 - k), 0.0, 1.0);
    return static_cast<std::uint8_t>(std::lround(255.0 * of));
  };
  return {part(5.0), part(3.0), part(1.0)};
}

/// Returns paint in a hue drawn from `seed`. `look` seeds its texture.
WallPaint wall_paint(std::uint64_t seed, std::uint32_t look) {
  CounterRandom random(seed, 1);
  const double hue = random.uniform(), strength = random.uniform(0.25, 0.6),
               value = random.uniform(0.55, 0.85);
  const double other = random.uniform(0.1, 0.9), warm = random.uniform();
  constexpr std::array kDados{Pattern::kFabric, Pattern::kTiles, Pattern::kPlanks, Pattern::kStone};
  const Pattern pattern = kDados[static_cast<std::size_t>(4.0 * random.uniform())];
  return {{pattern, hsv(hue, strength, value), hsv(std::fmod(hue + 0.15 * other, 1.0), strength, 0.6 * value),
           look + 500, 0.55F},
          {Pattern::kPlaster, hsv(warm, 0.07, 0.93), hsv(hue, 0.16, 0.8), look + 600, 0.62F}};
}

/// Returns a floor covering: tiles, planks, stone or fabric.
Material floor_covering(std::uint64_t seed, std::uint32_t look) {
  CounterRandom random(seed, 2);
  constexpr std::array kFloors{Pattern::kTiles, Pattern::kPlanks, Pattern::kStone, Pattern::kTiles};
  const Pattern pattern = kFloors[static_cast<std::size_t>(4.0 * random.uniform())];
  const double hue = random.uniform(), value = random.uniform(0.5, 0.85);
  return {pattern, hsv(hue, 0.22, value), hsv(hue, 0.3, 0.55 * value), look, 0.55F};
}

/// Returns a saturated colour, as used for door frames.
Material lacquer(std::uint64_t seed, std::uint32_t look) {
  CounterRandom random(seed, 3);
  const double hue = random.uniform(), value = random.uniform(0.45, 0.9);
  return {Pattern::kPortable, hsv(hue, 0.65, value), hsv(hue, 0.65, 0.7 * value), look, 0.5F};
}

/// Returns a poster or landscape.
Material picture_of(std::uint32_t look) {
  CounterRandom random(look, 4);
  const double hue = random.uniform(), kind = random.uniform();
  if (kind < 0.3) return {Pattern::kLandscape, hsv(0.5 + 0.2 * hue, 0.4, 0.85), {90, 128, 60}, look, 0.6F};
  return {Pattern::kPoster, hsv(hue, 0.15, 0.92), hsv(std::fmod(hue + 0.4, 1.0), 0.7, 0.45), look, 0.6F};
}

Material frame_of(std::uint32_t look) {
  CounterRandom random(look, 5);
  const double value = random.uniform(0.2, 0.8);
  return {Pattern::kWood, hsv(0.08, 0.4, value), hsv(0.08, 0.5, 0.6 * value), look + 1, 0.5F};
}

/// Max depth of the furniture along a corridor's walls.
constexpr double kCorridorFurniture_m = 0.45;

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

/// Adds a piece of a corridor: its shell, a lamp, coloured frames around doorways, and pictures, boards,
/// cupboards, benches and plants along its walls. Colours and furniture are chosen at random by the
/// building's seed, floor and piece, the floor covering by seed and floor.
/// @param look  seed of the materials, different for each piece
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

/// Height of the stairwell's ceiling above the world's origin.
double stairwell_top_m(const BuildingPlan& plan) {
  return floor_height_m(plan.size.floors - 1) + kTopStorey_m;
}

/// Adds a stairwell over all floors, with its lamps and pictures.
/// @param look  seed of its materials
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

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::uint32_t kLooks = 10'000;  ///< more than the materials of a room

/// Lamps of each part, beside Room::lamps.
using LampsOfParts = std::vector<std::vector<int>>;

void append(Room& building, Room&& part, const Eigen::AlignedBox3d& bounds_world, LampsOfParts& lamps) {
  RoomPart& entry = building.parts.emplace_back();
  entry.bounds_world = bounds_world;
  entry.solids_begin = building.solids.size();
  building.solids.insert(building.solids.end(), part.solids.begin(), part.solids.end());
  building.materials.insert(building.materials.end(), part.materials.begin(), part.materials.end());
  entry.solids_end = building.solids.size();
  std::vector<int>& own = lamps.emplace_back();
  for (const Lamp& lamp : part.lamps) {
    own.push_back(static_cast<int>(building.lamps.size()));
    building.lamps.push_back(lamp);
  }
}

Eigen::AlignedBox3d bounds_of_room(const PlannedRoom& room) {
  const Vector2d half = room.half_m + Vector2d::Constant(kShellThickness_m);
  const double floor_m = floor_height_m(room.floor);
  Eigen::AlignedBox3d bounds;
  bounds.extend(
      Vector3d(room.middle_m.x() - half.x(), room.middle_m.y() - half.y(), floor_m - kShellThickness_m));
  bounds.extend(Vector3d(room.middle_m.x() + half.x(), room.middle_m.y() + half.y(),
                         floor_m + kStoreyHeight_m - kShellThickness_m));
  return bounds;
}

Eigen::AlignedBox3d bounds_of_piece(const CorridorPiece& piece, int floor) {
  Eigen::AlignedBox2d plan = piece.interior_m;
  double beyond_m[4] = {kShellThickness_m, kShellThickness_m, kShellThickness_m,
                        kShellThickness_m};  // pieces without a wall between them touch
  for (const PieceOpening& opening : piece.openings)
    if (opening.leads_to == LeadsTo::kPiece) beyond_m[opening.side] = 0.0;
  plan.max() += Vector2d(beyond_m[3], beyond_m[0]);
  plan.min() -= Vector2d(beyond_m[2], beyond_m[1]);
  const double floor_m = floor_height_m(floor);
  return {Vector3d(plan.min().x(), plan.min().y(), floor_m - kShellThickness_m),
          Vector3d(plan.max().x(), plan.max().y(), floor_m + kStoreyHeight_m - kShellThickness_m)};
}

Eigen::AlignedBox3d bounds_of_stairs(const BuildingPlan& plan, const PlannedStairs& stairs) {
  constexpr double kOuterHalf_m = 0.5 * kStairwellWidth_m + kShellThickness_m;
  Eigen::AlignedBox3d bounds;
  bounds.extend(stairs.T_world_stairs * Vector3d(-kShellThickness_m, -kOuterHalf_m, -kShellThickness_m));
  bounds.extend(stairs.T_world_stairs * Vector3d(kStairwellLength_m + kShellThickness_m, kOuterHalf_m,
                                                 stairwell_top_m(plan) + kShellThickness_m));
  return bounds;
}

/// Adds an opening of a corridor's piece to the piece and to the part behind it.
void open(Room& building, const BuildingPlan& plan, int piece, const PieceOpening& opening, int floor) {
  const auto rooms = static_cast<int>(plan.rooms.size()), pieces = static_cast<int>(plan.pieces.size());
  const int here = rooms + floor * pieces + piece;
  int behind = rooms + floor * pieces + opening.number;
  if (opening.leads_to == LeadsTo::kRoom)
    behind = plan.first_of_floor[static_cast<std::size_t>(floor)] + opening.number;
  if (opening.leads_to == LeadsTo::kStairs) behind = rooms + plan.size.floors * pieces + opening.number;
  // In the plane between the two parts' walls.
  const Eigen::AlignedBox3d& bounds = building.parts[static_cast<std::size_t>(here)].bounds_world;
  PartOpening added;
  added.low_m = floor_height_m(floor);
  added.high_m = added.low_m + (opening.leads_to == LeadsTo::kPiece ? kCorridorHeight_m : kDoorwayHeight_m);
  added.part = behind;
  if (opening.side < 2) {
    const double y_m = opening.side == 0 ? bounds.max().y() : bounds.min().y();
    added.from_m = {opening.from_m, y_m};
    added.to_m = {opening.to_m, y_m};
  } else {
    const double x_m = opening.side == 3 ? bounds.max().x() : bounds.min().x();
    added.from_m = {x_m, opening.from_m};
    added.to_m = {x_m, opening.to_m};
  }
  building.parts[static_cast<std::size_t>(here)].openings.push_back(added);
  if (opening.leads_to == LeadsTo::kPiece) return;  // the piece behind has an opening of its own
  added.part = here;
  building.parts[static_cast<std::size_t>(behind)].openings.push_back(added);
}

/// Lights each part by the lamps of the parts within two openings of it, if they are near.
void assign_lamps(Room& building, const LampsOfParts& lamps) {
  constexpr double kFarthest_m = 10.0;
  for (std::size_t i = 0; i < building.parts.size(); ++i) {
    std::vector<int> parts{static_cast<int>(i)};
    for (std::size_t begin = 0, hop = 0; hop < 2; ++hop) {
      const std::size_t end = parts.size();
      for (; begin < end; ++begin)
        for (const PartOpening& opening : building.parts[static_cast<std::size_t>(parts[begin])].openings)
          if (std::find(parts.begin(), parts.end(), opening.part) == parts.end())
            parts.push_back(opening.part);
    }
    const Eigen::AlignedBox3d& bounds = building.parts[i].bounds_world;
    for (const int part : parts)
      for (const int lamp : lamps[static_cast<std::size_t>(part)])
        if (bounds.exteriorDistance(building.lamps[static_cast<std::size_t>(lamp)].position_world) <=
            kFarthest_m)
          building.parts[i].lamps.push_back(lamp);
  }
}

/// Makes a single furnished room of a building, at its pose in the building.
Room make_building_room(const BuildingPlan& plan, int number) {
  const PlannedRoom& planned = plan.rooms[static_cast<std::size_t>(number)];
  const double aside_m = planned.door_aside_m;
  const Doorway door =
      planned.is_north ? Doorway{1, -aside_m, kDoorWidth_m} : Doorway{0, aside_m, kDoorWidth_m};
  Room room = make_random_room(planned.look_seed, {planned.half_m, {door}});
  const Vector3d shift(planned.middle_m.x(), planned.middle_m.y(), floor_height_m(planned.floor));
  for (Solid& solid : room.solids) solid.T_world_solid.pretranslate(shift);
  const int first_alike = planned.twin >= 0 ? std::min(planned.twin, number) : number;
  for (Material& material : room.materials) material.seed += kLooks * static_cast<std::uint32_t>(first_alike);
  for (Lamp& lamp : room.lamps) lamp.position_world += shift;
  for (Vector3d* const p :
       {&room.interior_min_world, &room.interior_max_world, &room.focus_world, &room.walk_centre_world,
        &room.ball_from_world, &room.ball_to_world, &room.person_from_world, &room.person_to_world})
    *p += shift;
  return room;
}

}  // namespace

Room make_building(const BuildingPlan& plan, int walk, bool crate) {
  Room building;
  building.parts.reserve(plan.rooms.size() + plan.pieces.size() * static_cast<std::size_t>(plan.size.floors) +
                         plan.stairs.size());
  LampsOfParts lamps;
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
    Room room = make_building_room(plan, static_cast<int>(i));
    if (i == 0) {
      if (crate) {
        room.solids.push_back(crate_in(room));
        room.materials.push_back(crate_material());
      }
      building.focus_world = room.focus_world;
      building.view_azimuth_rad = room.view_azimuth_rad;
      building.walk_half_m = room.walk_half_m;
      building.walk_centre_world = room.walk_centre_world;
      building.ball_from_world = room.ball_from_world;
      building.ball_to_world = room.ball_to_world;
      building.person_from_world = room.person_from_world;
      building.person_to_world = room.person_to_world;
    }
    append(building, std::move(room), bounds_of_room(plan.rooms[i]), lamps);
  }
  auto look = kLooks * static_cast<std::uint32_t>(plan.rooms.size());
  for (int floor = 0; floor < plan.size.floors; ++floor)
    for (std::size_t i = 0; i < plan.pieces.size(); ++i, look += kLooks) {
      Room piece;
      add_corridor_piece(piece, plan, static_cast<int>(i), floor, look);
      append(building, std::move(piece), bounds_of_piece(plan.pieces[i], floor), lamps);
    }
  for (const PlannedStairs& stairs : plan.stairs) {
    Room stairwell;
    add_stairwell(stairwell, plan, stairs, look);
    look += kLooks;
    append(building, std::move(stairwell), bounds_of_stairs(plan, stairs), lamps);
  }
  for (int floor = 0; floor < plan.size.floors; ++floor)
    for (std::size_t i = 0; i < plan.pieces.size(); ++i)
      for (const PieceOpening& opening : plan.pieces[i].openings)
        if (is_open_on(plan, opening, floor)) open(building, plan, static_cast<int>(i), opening, floor);
  assign_lamps(building, lamps);

  Eigen::AlignedBox3d bounds;
  for (const RoomPart& part : building.parts) bounds.extend(part.bounds_world);
  building.interior_min_world = bounds.min() + Vector3d::Constant(kShellThickness_m);
  building.interior_max_world = bounds.max() - Vector3d::Constant(kShellThickness_m);
  building.name = kBuildingRoom;
  building.walk = plan_walk(plan, walk);
  building.walk_step_s = kWalkStep_s;
  building.walk_centre_world.z() = kEyeHeight_m;
  building.tree = SolidTree(building.solids);
  return building;
}

}  // namespace roomradar
