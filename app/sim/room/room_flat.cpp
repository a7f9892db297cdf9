// room_flat.cpp: joins four random rooms, and plans a walk through them.
#include "app/sim/room/room_flat.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "app/sim/room/furniture.hpp"
#include "app/sim/room/room_random.hpp"
#include "app/sim/solids/angles.hpp"
#include "mapping/types/system/counter_random.hpp"

namespace roomradar {
namespace {

using Eigen::Vector2d;

const Vector2d kHalf_m(2.75, 2.5);
constexpr double kQuarter_rad = 0.5 * std::numbers::pi;

/// Appends the walk through one room: in through one doorway, three quarters of the ellipse, and half way to
/// the next room.
/// @param in_rad  azimuth, from the room's middle, of the doorway into the room; the doorway out is a quarter
///                turn before it, counter-clockwise
/// @param yaw_rad  in: azimuth of the view in the doorway. out: the same for the next room
void walk_through(const Vector2d& middle, const Vector2d& half_m, double in_rad, double& yaw_rad,
                  std::vector<WalkPoint>& walk) {
  constexpr int kSteps = 9;  // along the ellipse
  constexpr double kStep_rad = 3.0 * kQuarter_rad / kSteps;
  constexpr int kTurnSteps = 5;  // steps at each end of the way out over which the view turns round
  const double out_rad = in_rad + 3.0 * kQuarter_rad;
  const Vector2d out(std::round(std::cos(out_rad)), std::round(std::sin(out_rad)));
  for (int i = 0; i <= kSteps; ++i) {
    const double angle_rad = in_rad + kStep_rad * i;
    const double turned = std::max(0, i - (kSteps - kTurnSteps));
    walk.push_back({middle + half_m.cwiseProduct(Vector2d(std::cos(angle_rad), std::sin(angle_rad))),
                    yaw_rad + kStep_rad * i + turned * kQuarter_rad / kTurnSteps});
  }
  const double last_rad = walk.back().yaw_rad;
  const Vector2d way = kHalf_m + Vector2d::Constant(kShellThickness_m) - half_m;
  for (int i = 1; i <= 2; ++i) {
    const double part = i / 2.0;
    walk.push_back({middle + out.cwiseProduct(half_m + part * way), last_rad + part * kQuarter_rad});
  }
  const double ahead = walk.back().yaw_rad;
  walk.push_back({middle + out.cwiseProduct(half_m + 1.5 * way), ahead});
  yaw_rad = ahead;
}

}  // namespace

Room make_flat(std::uint64_t seed) {
  Room flat;
  const Vector2d pitch = kHalf_m + Vector2d::Constant(kShellThickness_m);
  const std::array<Vector2d, 4> middles{Vector2d(-pitch.x(), -pitch.y()), Vector2d(pitch.x(), -pitch.y()),
                                        pitch, Vector2d(-pitch.x(), pitch.y())};
  // Walls with a doorway, as in Doorway::wall: room i leads to room i + 1 and back to room i - 1.
  constexpr unsigned kDoorways[4][2] = {{0, 3}, {0, 2}, {1, 2}, {1, 3}};
  constexpr std::uint32_t kLooks = 10'000;  // more than the materials of a room
  double yaw_rad = -kQuarter_rad;
  for (std::size_t i = 0; i < 4; ++i) {
    Room room = make_random_room(hash_of(seed, i), {kHalf_m, {{kDoorways[i][0]}, {kDoorways[i][1]}}});
    const Eigen::Vector3d shift(middles[i].x(), middles[i].y(), 0.0);
    for (Solid& solid : room.solids) solid.T_world_solid.pretranslate(shift);
    for (Material& material : room.materials) material.seed += kLooks * static_cast<std::uint32_t>(i);
    for (Lamp& lamp : room.lamps) lamp.position_world += shift;
    flat.solids.insert(flat.solids.end(), room.solids.begin(), room.solids.end());
    flat.materials.insert(flat.materials.end(), room.materials.begin(), room.materials.end());
    flat.lamps.insert(flat.lamps.end(), room.lamps.begin(), room.lamps.end());
    flat.interior_max_world = flat.interior_max_world.cwiseMax(room.interior_max_world + shift);
    walk_through(middles[i], room.walk_half_m, kQuarter_rad * (1.0 + static_cast<double>(i)), yaw_rad,
                 flat.walk);
    if (i > 0) continue;
    flat.focus_world = room.focus_world + shift;
    flat.view_azimuth_rad = room.view_azimuth_rad;
    flat.walk_centre_world = room.walk_centre_world + shift;
    flat.walk_half_m = room.walk_half_m;
    flat.ball_from_world = room.ball_from_world + shift;
    flat.ball_to_world = room.ball_to_world + shift;
    flat.person_from_world = room.person_from_world + shift;
    flat.person_to_world = room.person_to_world + shift;
    flat.interior_min_world = room.interior_min_world + shift;
  }
  flat.walk_turns = static_cast<int>(std::lround((yaw_rad + kQuarter_rad) / kFullTurn_rad));
  flat.name = kFlatRoom;
  return flat;
}

}  // namespace roomradar
