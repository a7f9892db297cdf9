// room.hpp: a simulated furnished room: solids, materials, lamps, and endpoints of the paths of the camera
// and moving objects.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/sim/room/material.hpp"
#include "app/sim/solids/solid.hpp"
#include "app/sim/solids/solid_tree.hpp"

namespace roomradar {

struct Lamp {
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();
  /// Irradiance at 1 m, in relative units.
  float power = 1.0F;
  /// Radius of the light source. It determines the softness of shadows.
  double radius_m = 0.2;
};

/// A point of a walk (camera trajectory) through several rooms.
struct WalkPoint {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< x and y in the world frame
  double yaw_rad = 0.0;  ///< azimuth of the view, counter-clockwise from +x; not wrapped along the walk
  double floor_m = 0.0;  ///< height of the floor or step below the camera
};

/// A vertical rectangle through which one part of a building is seen from another.
struct PartOpening {
  Eigen::Vector2d from_m = Eigen::Vector2d::Zero(), to_m = Eigen::Vector2d::Zero();  ///< its ends, x and y
  double low_m = 0.0, high_m = 0.0;  ///< its lower and upper edge, z
  int part = 0;                      ///< index of the part behind it
};

/// A box-shaped part of a building: a room, a piece of a corridor, a stairwell.
struct RoomPart {
  /// Bounds of the interior and of the part's own walls. They end where an adjacent part begins.
  Eigen::AlignedBox3d bounds_world;
  /// Index range of its solids in Room::solids; solids_end is exclusive.
  std::size_t solids_begin = 0, solids_end = 0;
  std::vector<PartOpening> openings;
  /// Indices in Room::lamps of the lamps that light this part.
  std::vector<int> lamps;
};

/// A simulated room. z is up, the floor is at z = 0, units are metres. Solids may touch but not overlap. The
/// room's surface is the solids' surfaces without the areas where two solids touch. Solids must not change
/// after make_room().
struct Room {
  std::string name;
  std::vector<Solid> solids;
  /// Materials, one per solid.
  std::vector<Material> materials;
  /// Bounding volume hierarchy over `solids`.
  SolidTree tree;
  std::vector<Lamp> lamps;
  /// Lower corner of the volume inside floor, walls and ceiling.
  Eigen::Vector3d interior_min_world = Eigen::Vector3d::Zero();
  /// Upper corner of the volume inside floor, walls and ceiling.
  Eigen::Vector3d interior_max_world = Eigen::Vector3d::Zero();
  /// Surface point at which the camera of CameraPathKind::kView looks.
  Eigen::Vector3d focus_world = Eigen::Vector3d::Zero();
  /// Azimuth of the kView camera's position as seen from focus_world.
  double view_azimuth_rad = 0.0;
  /// Centre, at eye height, of the ellipse along which the camera moves during a scan.
  Eigen::Vector3d walk_centre_world = Eigen::Vector3d::Zero();
  /// Semi-axes of the ellipse along x and y, m.
  Eigen::Vector2d walk_half_m = Eigen::Vector2d::Ones();
  /// Control points of a walk through several rooms, which replaces the ellipse. About 0.7 m apart in a flat,
  /// at most 0.42 m apart in a building. Empty: the ellipse.
  std::vector<WalkPoint> walk;
  /// Time between control points of an open walk, which runs from the first point to the last. 0: the walk is
  /// closed.
  double walk_step_s = 0.0;
  /// Number of full turns of the view on the closed walk.
  int walk_turns = 0;
  /// Surface point at which a ball's path begins.
  Eigen::Vector3d ball_from_world = Eigen::Vector3d::Zero();
  /// Surface point at which a ball's path ends.
  Eigen::Vector3d ball_to_world = Eigen::Vector3d::Zero();
  /// Floor point at which a person's path begins.
  Eigen::Vector3d person_from_world = Eigen::Vector3d::Zero();
  /// Floor point at which a person's path ends.
  Eigen::Vector3d person_to_world = Eigen::Vector3d::Zero();
  /// Parts of a building, each with solids of its own. Empty: a single room.
  std::vector<RoomPart> parts;
};

/// Returns the names of the fixed furnished rooms that make_room() accepts.
const std::vector<std::string>& room_names();
/// Further name that make_room() accepts: a room with furniture drawn at random from the seed.
inline constexpr std::string_view kRandomRoom = "random";
/// Further name that make_room() accepts: a room with a checkerboard on a stand, for camera calibration.
inline constexpr std::string_view kBoardRoom = "board";
/// Further name that make_room() accepts: a flat of four rooms in a ring, with doorways between them and
/// furniture drawn at random from the seed.
inline constexpr std::string_view kFlatRoom = "flat";
/// Name of a building with many rooms, which make_building() makes; make_room() does not.
inline constexpr std::string_view kBuildingRoom = "building";
/// Throws Error listing the known names if `name` is none of them. kBuildingRoom is a known name.
void require_room(std::string_view name);
/// Builds the solids, materials and lamps of a named room.
/// @param crate  true: adds a crate on the ball's path
/// @param seed   selects the furniture of kRandomRoom and kFlatRoom; other rooms do not depend on it
/// @param moved  share of the pieces of furniture of kRandomRoom that stand elsewhere than they do at 0
/// @throws Error if `name` is unknown (listing the known names), or if it is kBuildingRoom
Room make_room(std::string_view name, bool crate = false, std::uint64_t seed = 1, double moved = 0.0);

/// Size of the crate that make_room() can add.
inline const Eigen::Vector3d kCrateSize_m{0.24, 0.18, 0.22};
/// Returns the crate that make_room() can add to this room.
Solid crate_in(const Room& room);
Material crate_material();

/// Returns the signed distance (m) from a point to the nearest surface, negative inside a solid. The distance
/// is exact outside. Inside, its magnitude is the max of the depths in the individual solids. This is a lower
/// bound of the depth in the union of touching solids.
double signed_distance_m(const Room& room, const Eigen::Vector3d& p_world);

/// Returns the exact first intersection at which a ray enters a solid from outside. RayHit::range_m is in
/// units of the length of direction_world.
std::optional<RayHit> cast_ray(const Room& room, const Eigen::Vector3d& origin_world,
                               const Eigen::Vector3d& direction_world);

}  // namespace roomradar
