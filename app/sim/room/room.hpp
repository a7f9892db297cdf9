// room.hpp: a furnished room made in code: solids, what they look like, and where things may happen in it.
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
  float power = 1.0F;     ///< irradiance at 1 m, relative
  double radius_m = 0.2;  ///< of the glowing ball: how soft shadows are
};

/// +z is up, the floor's surface is z = 0, metres. Solids touch but do not overlap, so that each one's
/// surface is, but for what it stands on, the room's surface. No solid is changed after the room is made.
struct Room {
  std::string name;
  std::vector<Solid> solids;
  std::vector<Material> materials;  ///< one a solid
  SolidTree tree;                   ///< of the solids
  std::vector<Lamp> lamps;
  Eigen::Vector3d interior_min_world = Eigen::Vector3d::Zero();  ///< the air between floor, walls and ceiling
  Eigen::Vector3d interior_max_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d focus_world = Eigen::Vector3d::Zero();  ///< what a visitor looks at; a surface point
  double view_azimuth_rad = 0.0;                          ///< from the focus towards where a visitor stands
  /// Of the ellipse that a scan walks along, eye height.
  Eigen::Vector3d walk_centre_world = Eigen::Vector3d::Zero();
  Eigen::Vector2d walk_half_m = Eigen::Vector2d::Ones();  ///< its half axes along x and y
  /// Surface points between which a ball can roll.
  Eigen::Vector3d ball_from_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d ball_to_world = Eigen::Vector3d::Zero();
  /// Floor points between which a person can walk.
  Eigen::Vector3d person_from_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d person_to_world = Eigen::Vector3d::Zero();
};

/// The furnished rooms that make_room knows.
const std::vector<std::string>& room_names();
/// It also knows one that it furnishes by seed,
inline constexpr std::string_view kRandomRoom = "random";
/// and a checkerboard on a stand, to calibrate cameras with.
inline constexpr std::string_view kBoardRoom = "board";
/// Throws Error listing the known names if `name` is none of them.
void require_room(std::string_view name);
/// @param crate  one more thing than usual: a crate where else a ball could roll
/// @param seed   of the furniture of kRandomRoom; other rooms are always the same
/// Throws Error listing the known names if `name` is none of them.
Room make_room(std::string_view name, bool crate = false, std::uint64_t seed = 1);

/// How large that crate is.
inline const Eigen::Vector3d kCrateSize_m{0.24, 0.18, 0.22};
/// Where it stands, and what it looks like.
Solid crate_in(const Room& room);
Material crate_material();

/// Distance (m) from a point to the nearest surface; negative inside a solid. Exact outside, and inside as
/// long as no touching neighbour is deeper: there the depth within one solid, which is a lower bound of the
/// depth in all.
double signed_distance_m(const Room& room, const Eigen::Vector3d& p_world);

/// First surface that a ray meets from outside; range_m in units of the direction's length. Exact.
std::optional<RayHit> cast_ray(const Room& room, const Eigen::Vector3d& origin_world,
                               const Eigen::Vector3d& direction_world);

}  // namespace roomradar
