// next_view.cpp: casts few rays from many views through the grid.
#include "app/scan/live/next_view.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "mapping/types/system/classic_locale.hpp"

namespace roomradar {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kNearestUseful_m = 0.5, kFarthestUseful_m = 3.5;
constexpr double kUsualSurface_m = 1.3;  // behind a nearer border, surface is expected at this distance
constexpr double kLeastGain_m2 = 0.15;
constexpr double kWalk_mps = 0.4, kTurn_rad_s = 45.0 * kPi / 180.0, kPause_s = 0.5;
// Half the field of view of a Kinect, and the rays within it.
constexpr double kTanX = 0.54, kTanY = 0.41;
constexpr int kRaysX = 14, kRaysY = 10;

/// Returns a camera that looks in a direction, with a level x axis. The direction must not be along `up`.
Isometry3d looking(const Vector3d& at_world, const Vector3d& ahead, const Vector3d& up) {
  Isometry3d T_world_camera = Isometry3d::Identity();
  const Vector3d right = ahead.cross(up).normalized();
  T_world_camera.linear().col(0) = right;
  T_world_camera.linear().col(1) = ahead.cross(right);
  T_world_camera.linear().col(2) = ahead;
  T_world_camera.translation() = at_world;
  return T_world_camera;
}

/// Two level directions at right angles.
struct Level {
  Vector3d forward, left;
};
Level level_axes(const Isometry3d& T_world_camera, const Vector3d& up) {
  Vector3d forward = T_world_camera.linear().col(2);
  forward -= forward.dot(up) * up;
  // A camera that looks down is turned by its image's upper side.
  if (forward.norm() < 0.2)
    forward = -T_world_camera.linear().col(1) + T_world_camera.linear().col(1).dot(up) * up;
  forward.normalize();
  return {forward, up.cross(forward)};
}

/// Returns true if a neighbour of the cell is occupied: then the cell is a gap between the rays that met a
/// surface, or the surface's own.
bool is_at_surface(const ExplorationGrid& grid, const Vector3d& p_world) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-ExplorationGrid::kCell_m, ExplorationGrid::kCell_m})
      if (grid.at(p_world + side * Vector3d::Unit(axis)) == CellState::kOccupied) return true;
  return false;
}

/// Returns the area of the border to unknown space that a view shows and none of the earlier views.
double gain_of(const ExplorationGrid& grid, const Isometry3d& T_world_camera,
               const std::vector<Isometry3d>& T_earlier_world) {
  const double solid_angle = 4.0 * kTanX * kTanY / (kRaysX * kRaysY);
  const auto is_seen_earlier = [&](const Vector3d& p_world) {
    return std::any_of(T_earlier_world.begin(), T_earlier_world.end(), [&](const Isometry3d& T_camera_world) {
      const Vector3d p = T_camera_world * p_world;
      return p.z() > 0.0 && std::abs(p.x()) < kTanX * p.z() && std::abs(p.y()) < kTanY * p.z();
    });
  };
  double gain_m2 = 0.0;
  for (int j = 0; j < kRaysY; ++j)
    for (int i = 0; i < kRaysX; ++i) {
      const Vector3d ray = T_world_camera.linear() * Vector3d(kTanX * (2.0 * (i + 0.5) / kRaysX - 1.0),
                                                              kTanY * (2.0 * (j + 0.5) / kRaysY - 1.0), 1.0);
      for (double depth_m = 0.2; depth_m < kFarthestUseful_m; depth_m += ExplorationGrid::kCell_m) {
        const Vector3d p_world = T_world_camera.translation() + depth_m * ray;
        const CellState state = grid.at(p_world);
        if (state == CellState::kFree || (state == CellState::kUnknown && depth_m < kNearestUseful_m))
          continue;
        if (state == CellState::kUnknown && !is_at_surface(grid, p_world) && !is_seen_earlier(p_world))
          gain_m2 += solid_angle * std::pow(std::max(depth_m, kUsualSurface_m), 2);
        break;
      }
    }
  return gain_m2;
}

/// Returns the area that a motion shows: at its end, and in views on the way, 25 degrees apart.
double gain_of_motion(const ExplorationGrid& grid, const Isometry3d& from, const Isometry3d& to) {
  constexpr double kStep_rad = 25.0 * kPi / 180.0;
  const Eigen::Quaterniond turn_from(from.linear()), turn_to(to.linear());
  const int steps = std::max(1, static_cast<int>(std::ceil(turn_from.angularDistance(turn_to) / kStep_rad)));
  std::vector<Isometry3d> earlier;
  double gain_m2 = 0.0;
  for (int i = 1; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    Isometry3d T_world_camera(turn_from.slerp(share, turn_to));
    T_world_camera.translation() = from.translation() + share * (to.translation() - from.translation());
    gain_m2 += gain_of(grid, T_world_camera, earlier);
    earlier.push_back(T_world_camera.inverse());
  }
  return gain_m2;
}

/// Returns true if the camera can be moved to the place along a straight line: all cells around it are free.
bool is_reachable(const ExplorationGrid& grid, const Vector3d& from, const Vector3d& to) {
  constexpr double kRound_m = 0.25;
  const double length_m = (to - from).norm();
  for (double s = kRound_m; s <= length_m; s += ExplorationGrid::kCell_m) {
    const Vector3d p = from + s / length_m * (to - from);
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {-kRound_m, kRound_m})
        if (grid.at(p + side * Vector3d::Unit(axis)) == CellState::kOccupied) return false;
    if (grid.at(p) != CellState::kFree) return false;
  }
  return true;
}

std::vector<Vector3d> reachable_places(const ExplorationGrid& grid, const Isometry3d& T_world_camera,
                                       const Vector3d& up) {
  const Vector3d here = T_world_camera.translation();
  const Level level = level_axes(T_world_camera, up);
  std::vector<Vector3d> places{here};
  for (int i = 0; i < 8; ++i)
    for (const double far_m : {0.5, 1.0, 1.5}) {
      const double angle = 0.25 * kPi * i;
      const Vector3d to = here + far_m * (std::cos(angle) * level.forward + std::sin(angle) * level.left);
      if (is_reachable(grid, here, to)) places.push_back(to);
    }
  for (const double higher_m : {-0.4, 0.4})
    if (is_reachable(grid, here, here + higher_m * up)) places.push_back(here + higher_m * up);
  return places;
}

}  // namespace

std::optional<NextView> best_next_view(const ExplorationGrid& grid, const Isometry3d& T_world_camera,
                                       const Vector3d& up_world) {
  const Level level = level_axes(T_world_camera, up_world);
  std::optional<NextView> best;
  double most = 0.0;
  for (const Vector3d& place : reachable_places(grid, T_world_camera, up_world))
    for (int i = 0; i < 12; ++i)
      for (const double rise : {-0.75, -0.3, 0.1}) {
        const double angle = kPi / 6.0 * i;
        const Vector3d ahead =
            std::cos(rise) * (std::cos(angle) * level.forward + std::sin(angle) * level.left) +
            std::sin(rise) * up_world;
        const Isometry3d view = looking(place, ahead, up_world);
        const double gain_m2 = gain_of_motion(grid, T_world_camera, view);
        if (gain_m2 < kLeastGain_m2) continue;
        const double turn_rad = std::acos(std::clamp(ahead.dot(T_world_camera.linear().col(2)), -1.0, 1.0));
        const double takes_s = kPause_s + std::max((place - T_world_camera.translation()).norm() / kWalk_mps,
                                                   turn_rad / kTurn_rad_s);
        if (gain_m2 / takes_s <= most) continue;
        most = gain_m2 / takes_s;
        best = NextView{view, gain_m2, takes_s};
      }
  return best;
}

NextView view_of(const Vector3d& point_world, const Vector3d& viewpoint_world, const Vector3d& up_world) {
  Vector3d ahead = point_world - viewpoint_world;
  if (ahead.cross(up_world).norm() < 1e-6 * ahead.norm() || ahead.norm() < 1e-9)  // straight up or down
    ahead += (1e-3 * ahead.norm() + 1e-9) * up_world.unitOrthogonal();
  return {looking(viewpoint_world, ahead.normalized(), up_world), 0.0, 0.0};
}

std::string way_to(const NextView& next, const Isometry3d& T_world_camera, const Vector3d& up_world) {
  constexpr double kTurn_deg = 12.0, kMove_m = 0.15;
  const Level level = level_axes(T_world_camera, up_world);
  const Vector3d ahead = next.T_world_camera.linear().col(2);
  const Vector3d moved = next.T_world_camera.translation() - T_world_camera.translation();
  const double to_left_deg = std::atan2(ahead.dot(level.left), ahead.dot(level.forward)) * 180.0 / kPi;
  const double up_deg = (std::asin(std::clamp(ahead.dot(up_world), -1.0, 1.0)) -
                         std::asin(std::clamp(T_world_camera.linear().col(2).dot(up_world), -1.0, 1.0))) *
                        180.0 / kPi;
  std::string way;
  const auto add = [&](const char* form, double value) {
    char text[60];
    format_classic(text, sizeof text, form, value);
    way += (way.empty() ? "" : ", ") + std::string(text);
  };
  const auto tens = [](double degrees) { return 10.0 * std::round(std::abs(degrees) / 10.0); };
  if (moved.dot(level.forward) > kMove_m) add("go forward %.1f m", moved.dot(level.forward));
  if (moved.dot(level.forward) < -kMove_m) add("go back %.1f m", -moved.dot(level.forward));
  if (moved.dot(level.left) > kMove_m) add("go left %.1f m", moved.dot(level.left));
  if (moved.dot(level.left) < -kMove_m) add("go right %.1f m", -moved.dot(level.left));
  if (moved.dot(up_world) > kMove_m) add("hold higher by %.1f m", moved.dot(up_world));
  if (moved.dot(up_world) < -kMove_m) add("hold lower by %.1f m", -moved.dot(up_world));
  if (to_left_deg > kTurn_deg) add("turn left %.0f\u00B0", tens(to_left_deg));
  if (to_left_deg < -kTurn_deg) add("turn right %.0f\u00B0", tens(to_left_deg));
  if (up_deg > kTurn_deg) add("tilt up %.0f\u00B0", tens(up_deg));
  if (up_deg < -kTurn_deg) add("tilt down %.0f\u00B0", tens(up_deg));
  return way.empty() ? "hold still" : way;
}

}  // namespace roomradar
