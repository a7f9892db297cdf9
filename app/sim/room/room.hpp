// room.hpp: a simulated furnished room: solids, materials, lamps, and the paths of the camera and of moving
// objects.
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
  /// Relative irradiance at 1 m.
  float power = 1.0F;
  /// Radius of the light source, which determines the softness of shadows.
  double radius_m = 0.2;
};

/// A simulated room: z is up, the floor is at z = 0, units are metres. Solids do not overlap but may touch;
/// each solid's surface is part of the room's surface except where solids touch. Solids must not change after
/// the room is made.
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
  /// Surface point that a viewer looks at.
  Eigen::Vector3d focus_world = Eigen::Vector3d::Zero();
  /// Azimuth of the viewer as seen from focus_world.
  double view_azimuth_rad = 0.0;
  /// Centre, at eye height, of the ellipse along which the camera moves during a scan.
  Eigen::Vector3d walk_centre_world = Eigen::Vector3d::Zero();
  /// Semi-axes of the ellipse along x and y, m.
  Eigen::Vector2d walk_half_m = Eigen::Vector2d::Ones();
  /// Surface point at which a ball's path begins.
  Eigen::Vector3d ball_from_world = Eigen::Vector3d::Zero();
  /// Surface point at which a ball's path ends.
  Eigen::Vector3d ball_to_world = Eigen::Vector3d::Zero();
  /// Floor point at which a person's path begins.
  Eigen::Vector3d person_from_world = Eigen::Vector3d::Zero();
  /// Floor point at which a person's path ends.
  Eigen::Vector3d person_to_world = Eigen::Vector3d::Zero();
};

/// Returns the names of the furnished rooms that make_room() makes.
const std::vector<std::string>& room_names();
/// Another name that make_room() accepts: a room with furniture drawn at random from the seed.
inline constexpr std::string_view kRandomRoom = "random";
/// Another name that make_room() accepts: a room with a checkerboard on a stand, for camera calibration.
inline constexpr std::string_view kBoardRoom = "board";
/// Throws Error listing the known names if `name` is none of them.
void require_room(std::string_view name);
/// Makes the room with this name.
/// @param crate  true: adds a crate on the ball's path
/// @param seed   selects the furniture of kRandomRoom; other rooms do not depend on it
/// @throws Error listing the known names if `name` is none of them
Room make_room(std::string_view name, bool crate = false, std::uint64_t seed = 1);

/// Size of the crate that make_room() can add.
inline const Eigen::Vector3d kCrateSize_m{0.24, 0.18, 0.22};
/// Returns the crate that make_room() can add to this room.
Solid crate_in(const Room& room);
/// Returns the crate's material.
Material crate_material();

/// Returns the distance (m) from a point to the nearest surface, negative inside a solid. It is exact
/// outside. Inside, it is the depth in the deepest single solid, which is a lower bound of the depth in the
/// union of touching solids.
double signed_distance_m(const Room& room, const Eigen::Vector3d& p_world);

/// Returns the first surface that a ray enters from outside, computed exactly. RayHit::range_m is in units of
/// the direction's length.
std::optional<RayHit> cast_ray(const Room& room, const Eigen::Vector3d& origin_world,
                               const Eigen::Vector3d& direction_world);

}  // namespace roomradar
