// building_walls.hpp: walls with openings, and the floor, ceiling and walls of a corridor segment
// (CorridorPiece).
#pragma once
#include <vector>

#include "app/sim/building/building_plan.hpp"
#include "app/sim/room/room.hpp"

namespace roomradar {

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
inline constexpr double kDado_m = 1.1;

/// Materials of a corridor segment.
struct ShellMaterials {
  Material ground, ceiling;
  WallPaint walls;
};

/// Adds a wall of thickness kShellThickness_m. In the wall's frame, x is along the inner edge of the wall's
/// bottom face, to the right as seen from inside. -y points into the room.
/// @param openings  without overlap, at least kDado_m high
void add_wall(Room& room, const Eigen::Isometry3d& T_world_wall, const WallExtent& extent,
              std::vector<WallOpening> openings, const WallPaint& paint);

/// Returns true if `opening` exists on this floor. An upper floor without the last room has no opening to it.
bool is_open_on(const BuildingPlan& plan, const PieceOpening& opening, int floor);

/// Frame of one wall of a corridor segment. The axes are those of add_wall(). The origin is the midpoint of
/// the wall's inner bottom edge.
Eigen::Isometry3d T_world_side(const CorridorPiece& piece, unsigned side, int floor);

/// Returns an opening in the frame of its side's wall.
WallOpening opening_in_side(const CorridorPiece& piece, const PieceOpening& opening);

/// Adds floor, ceiling and walls of a corridor segment.
void add_piece_shell(Room& room, const BuildingPlan& plan, const CorridorPiece& piece, int floor,
                     const ShellMaterials& materials);

}  // namespace roomradar
