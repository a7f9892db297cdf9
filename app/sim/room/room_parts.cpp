// room_parts.cpp: follows sight lines through the openings between the parts of a building.
#include "app/sim/room/room_parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/sim/solids/angles.hpp"

namespace roomradar {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Directions of sight lines that passed all openings so far.
struct Sight {
  double azimuth_rad = 0.0;                               ///< first azimuth of the range, counter-clockwise
  double width_rad = kFullTurn_rad;                       ///< of the range of azimuths
  double low = -std::numeric_limits<double>::infinity();  ///< range of slopes, height per horizontal distance
  double high = std::numeric_limits<double>::infinity();
  [[nodiscard]] bool is_empty() const { return width_rad <= 0.0 || low >= high; }
};

double distance_m(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d along = b - a;
  const double part = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (a + part * along - p).norm();
}

/// Returns the sight lines that pass the opening, too.
Sight narrowed(const Sight& sight, const PartOpening& opening, const Vector3d& eye_world, double margin_m) {
  const Vector2d eye = eye_world.head<2>();
  const double nearest_m = distance_m(eye, opening.from_m, opening.to_m) - margin_m;
  if (nearest_m <= margin_m) return sight;
  const Vector2d from = opening.from_m - eye, to = opening.to_m - eye;
  const double farthest_m = std::max(from.norm(), to.norm()) + margin_m;
  Sight result = sight;
  const double below_m = opening.low_m - eye_world.z() - margin_m,
               above_m = opening.high_m - eye_world.z() + margin_m;
  result.low = std::max(sight.low, std::min(below_m / nearest_m, below_m / farthest_m));
  result.high = std::min(sight.high, std::max(above_m / nearest_m, above_m / farthest_m));

  const double between_rad = std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
  const Vector2d first = between_rad >= 0.0 ? from : to;
  const double widened_rad = std::asin(std::min(1.0, margin_m / nearest_m));
  const double begin_rad = std::atan2(first.y(), first.x()) - widened_rad;
  const double width_rad = std::abs(between_rad) + 2.0 * widened_rad;
  if (width_rad > std::numbers::pi) return result;  // close to the opening: it leaves nearly everything
  if (sight.width_rad > std::numbers::pi) {
    result.azimuth_rad = begin_rad;
    result.width_rad = width_rad;
    return result;
  }
  const double shift_rad = std::remainder(begin_rad - sight.azimuth_rad, kFullTurn_rad);
  const double end_rad = std::min(shift_rad + width_rad, sight.width_rad);
  const double start_rad = std::max(shift_rad, 0.0);
  result.azimuth_rad = sight.azimuth_rad + start_rad;
  result.width_rad = end_rad - start_rad;
  return result;
}

/// One walk over the parts, depth first. A sight line enters a convex part once, so the parts on the way from
/// the eye are not entered again.
struct SightWalk {
  const Room& room;
  const Vector3d& eye_world;
  double margin_m;
  std::vector<char> is_seen, is_on_way;

  void enter(int part, const Sight& sight) {
    const auto index = static_cast<std::size_t>(part);
    is_seen[index] = is_on_way[index] = 1;
    for (const PartOpening& opening : room.parts[index].openings) {
      if (is_on_way[static_cast<std::size_t>(opening.part)] != 0) continue;
      const Sight through = narrowed(sight, opening, eye_world, margin_m);
      if (!through.is_empty()) enter(opening.part, through);
    }
    is_on_way[index] = 0;
  }
};

}  // namespace

int part_at(const Room& room, const Vector3d& p_world) {
  for (std::size_t i = 0; i < room.parts.size(); ++i)
    if (room.parts[i].bounds_world.contains(p_world)) return static_cast<int>(i);
  return -1;
}

int part_of_solid(const Room& room, std::size_t solid) {
  const auto after =
      std::upper_bound(room.parts.begin(), room.parts.end(), solid,
                       [](std::size_t index, const RoomPart& part) { return index < part.solids_begin; });
  return static_cast<int>(after - room.parts.begin()) - 1;
}

std::vector<int> visible_parts(const Room& room, const Vector3d& eye_world, double margin_m) {
  const int here = part_at(room, eye_world);
  SightWalk walk{room, eye_world, margin_m, std::vector<char>(room.parts.size(), static_cast<char>(here < 0)),
                 std::vector<char>(room.parts.size(), 0)};
  if (here >= 0) walk.enter(here, {});
  std::vector<int> parts;
  for (std::size_t i = 0; i < walk.is_seen.size(); ++i)
    if (walk.is_seen[i] != 0) parts.push_back(static_cast<int>(i));
  return parts;
}

}  // namespace roomradar
