// building_plan.hpp: floor plan of a simulated building: rooms along corridors, and stairs between its
// floors.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

namespace roomradar {

/// Size of a simulated building.
struct BuildingSize {
  /// Number of rooms, 2 to 1000, at least one per floor.
  int rooms = 10;
  /// Number of floors, 1 to 10.
  int floors = 2;
  /// Number of rooms that look like another room: an even number, 0 to most_alike(). Unset: about a fifth.
  std::optional<int> alike;
  friend bool operator==(const BuildingSize&, const BuildingSize&) = default;
};
/// Throws Error naming the value and its range if one is out of range.
void require_valid(const BuildingSize& size);
/// Returns the max number of rooms that can have a twin (a room that looks the same). Twins are on adjacent
/// floors, or on the same floor if the building has only one.
int most_alike(const BuildingSize& size);

/// Height from floor to floor: 18 steps.
inline constexpr double kStoreyHeight_m = 3.06;
inline constexpr double kCorridorWidth_m = 2.2, kCorridorHeight_m = 2.6;
/// Width of the doorways of rooms and stairwells. Their height is kDoorwayHeight_m.
inline constexpr double kDoorWidth_m = 1.0, kStairDoorWidth_m = 1.2;
/// Interior of a stairwell: two flights side by side between two landings.
inline constexpr double kLanding_m = 1.4, kTread_m = 0.28, kFlightWidth_m = 1.2, kFlightGap_m = 0.2;
inline constexpr int kRisersPerFlight = 9;
inline constexpr double kStairwellLength_m = 2.0 * kLanding_m + (kRisersPerFlight - 1) * kTread_m;
inline constexpr double kStairwellWidth_m = 2.0 * kFlightWidth_m + kFlightGap_m;

struct PlannedRoom {
  int floor = 0;
  Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();  ///< middle of the interior, x and y in the world frame
  Eigen::Vector2d half_m = Eigen::Vector2d::Zero();    ///< half the size of the interior
  int corridor = 0;                                    ///< index of the corridor that the door leads to
  bool is_north = false;                               ///< true: north of the corridor
  double door_aside_m = 0.0;  ///< distance of the door's middle from the room's middle, to the east
  /// Seed of its furniture and materials. Rooms of equal seeds are equal up to a translation.
  std::uint64_t look_seed = 0;
  /// Number of the room that looks the same; -1: none.
  int twin = -1;
};

enum class LeadsTo { kPiece, kRoom, kStairs };
/// Returns the x coordinate of the middle of a room's door.
inline double door_x_m(const PlannedRoom& room) { return room.middle_m.x() + room.door_aside_m; }
/// Opening in a side of a corridor's piece.
struct PieceOpening {
  unsigned side = 0;                ///< 0 to 3: +y, -y, -x or +x
  double from_m = 0.0, to_m = 0.0;  ///< range along x or y of the world frame
  LeadsTo leads_to = LeadsTo::kPiece;
  int number = 0;  ///< number of the piece or stairs, or of the room on the lowest floor
};

/// A box-shaped piece of a corridor. All floors have the same pieces.
struct CorridorPiece {
  Eigen::AlignedBox2d interior_m;
  /// Openings to pieces extend over the whole side and height; the others are doorways.
  std::vector<PieceOpening> openings;
};

/// A stairwell at the end of a corridor, in its own frame (T_world_stairs). At y < 0, a flight leads from the
/// landing along +x to a half landing. At y > 0, the next flight leads back.
struct PlannedStairs {
  /// x points away from the corridor into the stairwell, y to the left. The origin is at the middle of the
  /// doorway, on the stairwell's side, on the lowest floor.
  Eigen::Isometry3d T_world_stairs = Eigen::Isometry3d::Identity();
  int corridor = 0;
};

/// Plan of a building. x is along the corridors, floor i is at z = i * kStoreyHeight_m.
struct BuildingPlan {
  std::uint64_t seed = 1;
  BuildingSize size;
  /// Rooms, floor by floor. On each floor, they are in the order of their doors along the corridors: eastward
  /// along corridor 0, westward along corridor 1 and so on.
  std::vector<PlannedRoom> rooms;
  /// Number of the first room of each floor, followed by the total number of rooms.
  std::vector<int> first_of_floor;
  std::vector<CorridorPiece> pieces;
  std::vector<PlannedStairs> stairs;
  /// y coordinates of the corridors' centrelines, from south to north. If there are several corridors, cross
  /// corridors connect them at both ends.
  std::vector<double> corridor_y_m;
  /// Corridors extend from x = 0 to this length; cross corridors are beyond both ends.
  double length_m = 0.0;
};

/// Makes the plan of a building. Its rooms are furnished by make_building().
/// @throws Error as require_valid()
BuildingPlan plan_building(std::uint64_t seed, const BuildingSize& size);

/// Height of a floor above the world's origin.
inline double floor_height_m(int floor) { return floor * kStoreyHeight_m; }
/// Returns the x coordinate of the centreline of the cross corridor at the west or east end.
double cross_corridor_x_m(const BuildingPlan& plan, bool is_east);

/// Floor and room of a point in a building.
struct BuildingPlace {
  int floor = 0;
  int room = -1;  ///< number of the room: index in BuildingPlan::rooms; -1: a corridor or stairs
};
/// Returns the floor and room of a point in the interior of a room, a corridor or a stairwell; unset for
/// other points. Stairs belong to the floor below them.
std::optional<BuildingPlace> place_at(const BuildingPlan& plan, const Eigen::Vector3d& p_world);

}  // namespace roomradar
