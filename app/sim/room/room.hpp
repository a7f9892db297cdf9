// room.hpp: a simulated furnished room: solids, materials, lamps, and the paths of camera and movers in it.
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
  float power = 1.0F;     ///< relative irradiance at 1 m
  double radius_m = 0.2;  ///< radius of the light source, which determines the softness of shadows
};

/// +z is up, the floor is at z = 0, units are metres. Solids touch but do not overlap. Every solid's surface
/// is thus part of the room's surface, except where solids touch. Solids must not change after the room is
/// made.
struct Room {
  std::string name;
  std::vector<Solid> solids;
  std::vector<Material> materials;  ///< one per solid
  SolidTree tree;                   ///< over `solids`
  std::vector<Lamp> lamps;
  Eigen::Vector3d interior_min_world = Eigen::Vector3d::Zero();  ///< volume inside floor, walls and ceiling
  Eigen::Vector3d interior_max_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d focus_world = Eigen::Vector3d::Zero();  ///< surface point that a viewer looks at
  double view_azimuth_rad = 0.0;                          ///< azimuth of the viewer as seen from the focus
  /// Centre, at eye height, of the ellipse that a scan follows.
  Eigen::Vector3d walk_centre_world = Eigen::Vector3d::Zero();
  Eigen::Vector2d walk_half_m = Eigen::Vector2d::Ones();  ///< half axes of the ellipse along x and y
  /// Surface points between which a ball rolls.
  Eigen::Vector3d ball_from_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d ball_to_world = Eigen::Vector3d::Zero();
  /// Floor points between which a person walks.
  Eigen::Vector3d person_from_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d person_to_world = Eigen::Vector3d::Zero();
};

/// Names of the furnished rooms of make_room().
const std::vector<std::string>& room_names();
/// make_room() also accepts this name: furniture drawn at random by seed.
inline constexpr std::string_view kRandomRoom = "random";
/// make_room() also accepts this name: a checkerboard on a stand, for camera calibration.
inline constexpr std::string_view kBoardRoom = "board";
/// Throws Error listing the known names if `name` is none of them.
void require_room(std::string_view name);
/// @param crate  adds a crate on the ball's path
/// @param seed   selects the furniture of kRandomRoom; other rooms do not depend on it
/// Throws Error listing the known names if `name` is none of them.
Room make_room(std::string_view name, bool crate = false, std::uint64_t seed = 1);

/// Size of that crate.
inline const Eigen::Vector3d kCrateSize_m{0.24, 0.18, 0.22};
/// Position and material of that crate.
Solid crate_in(const Room& room);
Material crate_material();

/// Returns the distance (m) from a point to the nearest surface; negative inside a solid. Exact outside.
/// Inside, it is the depth within the deepest single solid, a lower bound of the depth within touching solids
/// together.
double signed_distance_m(const Room& room, const Eigen::Vector3d& p_world);

/// Returns the first surface that a ray enters from outside; range_m is in units of the direction's length.
/// Exact.
std::optional<RayHit> cast_ray(const Room& room, const Eigen::Vector3d& origin_world,
                               const Eigen::Vector3d& direction_world);

}  // namespace roomradar
