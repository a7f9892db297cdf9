// building_walls.cpp: builds walls from boxes that touch but do not overlap.
#include "app/sim/building/building_walls.hpp"

#include <algorithm>
#include <numbers>

#include "app/sim/room/furniture.hpp"

namespace roomradar {
namespace {

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

}  // namespace

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

bool is_open_on(const BuildingPlan& plan, const PieceOpening& opening, int floor) {
  const auto at = static_cast<std::size_t>(floor);
  return opening.leads_to != LeadsTo::kRoom ||
         opening.number < plan.first_of_floor[at + 1] - plan.first_of_floor[at];
}

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

WallOpening opening_in_side(const CorridorPiece& piece, const PieceOpening& opening) {
  const double middle_m = piece.interior_m.center()[opening.side < 2 ? 0 : 1];
  const double high_m = opening.leads_to == LeadsTo::kPiece ? kCorridorHeight_m : kDoorwayHeight_m;
  if (opening.side == 0 || opening.side == 2)
    return {opening.from_m - middle_m, opening.to_m - middle_m, high_m};
  return {middle_m - opening.to_m, middle_m - opening.from_m, high_m};
}

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

}  // namespace roomradar
