// camera_path.cpp: an ellipse or a standpoint, plus the sway of a walking or standing person.
#include "app/sim/sensor/camera_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "app/sim/solids/angles.hpp"
#include "mapping/types/system/counter_random.hpp"

namespace roomradar {
namespace {

using Eigen::Vector3d;

double at(const Sway& sway, double t_s) {
  return sway.amplitude * std::sin(kFullTurn_rad * sway.rate_hz * t_s + sway.phase_rad);
}

template <std::size_t N>
double at(const std::array<Sway, N>& sways, double t_s) {
  double sum = 0.0;
  for (const Sway& sway : sways) sum += at(sway, t_s);
  return sum;
}

/// Ramanujan's second approximation; its error is below 1e-5 of the length for our ellipses.
double ellipse_length_m(const Eigen::Vector2d& half_m) {
  const double a = half_m.x(), b = half_m.y();
  const double h = (a - b) * (a - b) / ((a + b) * (a + b));
  return std::numbers::pi * (a + b) * (1.0 + 3.0 * h / (10.0 + std::sqrt(4.0 - 3.0 * h)));
}

/// Returns the time per round such that, if possible at walking speed, a whole number of rounds fills the
/// duration.
double loop_time_s(double length_m, double duration_s) {
  constexpr double kSpeed_m_s = 0.42;
  constexpr double kFastest_m_s = 0.5;  // leaves room for sway, up to 0.6
  const double rounds = std::max(1.0, std::round(kSpeed_m_s * duration_s / length_m));
  const double speed_m_s = rounds * length_m / duration_s;
  return speed_m_s <= kFastest_m_s ? duration_s / rounds : length_m / kSpeed_m_s;
}

/// Returns the weights of the four control points around a place of a uniform cubic B-spline.
std::array<double, 4> spline_weights(double t) {
  return {(1.0 - t) * (1.0 - t) * (1.0 - t) / 6.0, (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0,
          (-3.0 * t * t * t + 3.0 * t * t + 3.0 * t + 1.0) / 6.0, t * t * t / 6.0};
}

/// Returns the point of an open walk t_s seconds after its begin; before and after it, its ends.
WalkPoint open_walk_at(const CameraPath& path, double t_s) {
  const auto last = static_cast<std::int64_t>(path.walk.size()) - 1;
  const double steps = std::clamp(t_s / path.walk_step_s, 0.0, static_cast<double>(last));
  const double first = std::floor(steps);
  const std::array<double, 4> weights = spline_weights(steps - first);
  WalkPoint point;
  for (std::int64_t i = 0; i < 4; ++i) {
    const std::int64_t at = std::clamp<std::int64_t>(static_cast<std::int64_t>(first) + i - 1, 0, last);
    const WalkPoint& control = path.walk[static_cast<std::size_t>(at)];
    const double weight = weights[static_cast<std::size_t>(i)];
    point.position_m += weight * control.position_m;
    point.yaw_rad += weight * control.yaw_rad;
    point.floor_m += weight * control.floor_m;
  }
  return point;
}

/// Returns the point of a closed walk at `phase_rad`, where a full turn is the whole walk.
WalkPoint closed_walk_at(const CameraPath& path, double phase_rad) {
  const auto count = static_cast<std::int64_t>(path.walk.size());
  const double steps = phase_rad / kFullTurn_rad * static_cast<double>(count);
  const double first = std::floor(steps), t = steps - first;
  const std::array<double, 4> weights = spline_weights(t);
  WalkPoint point;
  for (std::int64_t i = 0; i < 4; ++i) {
    const std::int64_t at = static_cast<std::int64_t>(first) + i - 1;
    const std::int64_t round = at >= 0 ? at / count : (at + 1) / count - 1;
    const WalkPoint& control = path.walk[static_cast<std::size_t>(at - round * count)];
    const double turned_rad = kFullTurn_rad * static_cast<double>(round * path.walk_turns);
    point.position_m += weights[static_cast<std::size_t>(i)] * control.position_m;
    point.yaw_rad += weights[static_cast<std::size_t>(i)] * (control.yaw_rad + turned_rad);
  }
  return point;
}

double walk_length_m(const std::vector<WalkPoint>& walk) {
  double length_m = 0.0;
  for (std::size_t i = 0; i < walk.size(); ++i)
    length_m += (walk[(i + 1) % walk.size()].position_m - walk[i].position_m).norm();
  return length_m;
}

CameraPath draw_path(const Room& room, CameraPathKind kind, std::uint64_t seed, std::uint64_t draw,
                     double duration_s) {
  CounterRandom random(hash_of(seed, 0x70617468), draw);
  const auto sway = [&random](double amplitude, double low_hz, double high_hz) {
    return Sway{amplitude * random.uniform(0.7, 1.0), random.uniform(low_hz, high_hz),
                random.uniform(0.0, kFullTurn_rad)};
  };
  constexpr double kDegree_rad = std::numbers::pi / 180.0;
  CameraPath path;
  path.kind = kind;
  if (kind == CameraPathKind::kScan) {
    path.centre_world = room.walk_centre_world + Vector3d(0, 0, random.uniform(-0.05, 0.1));
    path.half_m = room.walk_half_m * random.uniform(0.92, 1.0);
    path.start_rad = random.uniform(0.0, kFullTurn_rad);
    path.walk = room.walk;
    path.walk_turns = room.walk_turns;
    path.walk_step_s = room.walk_step_s;
    const double length_m = path.walk.empty() ? ellipse_length_m(path.half_m) : walk_length_m(path.walk);
    path.loop_s = loop_time_s(length_m, duration_s) * (random.uniform() < 0.5 ? -1.0 : 1.0);
    path.target_world = {room.walk_centre_world.x(), room.walk_centre_world.y(), 0.8};
    path.target_sway = {sway(0.35, 0.07, 0.09), sway(0.3, 0.06, 0.08), sway(0.4, 0.09, 0.11)};
    for (std::size_t axis = 0; axis < 2; ++axis)
      path.position_sway[axis] = {sway(0.02, 0.15, 0.25), sway(0.008, 0.8, 1.0), Sway{}};
    path.position_sway[2] = {sway(0.12, 0.07, 0.1), sway(0.006, 1.7, 2.0), sway(0.01, 0.3, 0.4)};
    path.turn_sway = {{{sway(0.8 * kDegree_rad, 0.4, 0.6), sway(0.15 * kDegree_rad, 1.7, 2.0)},
                       {sway(0.8 * kDegree_rad, 0.4, 0.6), sway(0.15 * kDegree_rad, 1.7, 2.0)},
                       {sway(1.5 * kDegree_rad, 0.2, 0.3), sway(0.15 * kDegree_rad, 0.8, 1.0)}}};
    if (path.walk_step_s > 0.0) {  // stairs and doorways leave less space
      path.position_sway[2][0].amplitude *= 0.5;
      path.centre_world.z() = room.walk_centre_world.z();
    }
    return path;
  }
  if (kind == CameraPathKind::kSwing) {
    const Vector3d before(std::cos(room.view_azimuth_rad), std::sin(room.view_azimuth_rad), 0.0);
    const Vector3d aside(-before.y(), before.x(), 0.0);
    path.centre_world = room.focus_world + 1.5 * before;
    path.target_world = room.focus_world;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double near_and_far_m = 0.75 * std::abs(before[static_cast<Eigen::Index>(axis)]);
      const double to_the_side_m = 0.9 * std::abs(aside[static_cast<Eigen::Index>(axis)]);
      path.position_sway[axis] = {sway(near_and_far_m, 0.028, 0.036), sway(to_the_side_m, 0.05, 0.065),
                                  sway(axis == 2 ? 0.7 : 0.0, 0.075, 0.095)};
      path.target_sway[axis] = sway(0.4, 0.06, 0.085);
    }
    path.turn_sway[2] = {sway(30.0 * kDegree_rad, 0.045, 0.06), Sway{}};
    return path;
  }
  const double distance_m = random.uniform(1.25, 1.7);
  const double elevation_rad = random.uniform(25.0, 40.0) * kDegree_rad;
  const double azimuth_rad = room.view_azimuth_rad + random.uniform(-0.4, 0.4);
  path.centre_world =
      room.focus_world + distance_m * Vector3d(std::cos(elevation_rad) * std::cos(azimuth_rad),
                                               std::cos(elevation_rad) * std::sin(azimuth_rad),
                                               std::sin(elevation_rad));
  path.target_world = room.focus_world + Vector3d(0, 0, 0.05);
  path.target_sway = {sway(0.02, 0.1, 0.2), sway(0.02, 0.1, 0.2), sway(0.01, 0.1, 0.2)};
  for (auto& sways : path.position_sway)
    sways = {sway(0.02, 0.12, 0.2), sway(0.006, 0.3, 0.5), sway(0.0015, 0.8, 1.2)};
  for (auto& sways : path.turn_sway)
    sways = {sway(0.5 * kDegree_rad, 0.2, 0.3), sway(0.15 * kDegree_rad, 0.8, 1.2)};
  return path;
}

double clearance_m(const Room& room, const CameraPath& path, double duration_s) {
  double least_m = std::numeric_limits<double>::infinity();
  constexpr double kLongest_s = 1800.0;  // the rest of a longer walk repeats the same paths
  const double last_s = std::min(duration_s, kLongest_s);
  const int samples = std::max(static_cast<int>(last_s * 5.0), 20);
  for (int i = 0; i <= samples; ++i) {
    const Vector3d p_world = T_world_camera_at(path, last_s * i / samples).translation();
    least_m = std::min(least_m, signed_distance_m(room, p_world));
  }
  return least_m;
}

}  // namespace

CameraPath plan_camera_path(const Room& room, CameraPathKind kind, std::uint64_t seed, double duration_s) {
  // 0.5 m, or 0.4 m in the doorways of a walk, plus 2 cm, more than samples can miss.
  const double clearance_wanted_m = kind == CameraPathKind::kScan && room.walk_step_s > 0.0 ? 0.42 : 0.52;
  CameraPath best;
  double best_clearance_m = -std::numeric_limits<double>::infinity();
  for (std::uint64_t draw = 0; draw < 64 && best_clearance_m < clearance_wanted_m; ++draw) {
    const CameraPath path = draw_path(room, kind, seed, draw, duration_s);
    const double clear_m = clearance_m(room, path, duration_s);
    if (clear_m <= best_clearance_m) continue;
    best = path;
    best_clearance_m = clear_m;
  }
  return best;
}

void add_turns(CameraPath& path, double turn_dps) {
  constexpr double kSwing_deg = 25.0, kDegree_rad = std::numbers::pi / 180.0;
  if (turn_dps == 0.0) return;
  path.turn_sway[1][0] = {kSwing_deg * kDegree_rad, turn_dps / (kSwing_deg * kFullTurn_rad), 0.0};
}

Eigen::Isometry3d looking_at(const Vector3d& eye_world, const Vector3d& target_world) {
  const Vector3d z = (target_world - eye_world).normalized();
  const Vector3d x = z.cross(Vector3d::UnitZ()).normalized();  // horizontal; y = z cross x points down
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.linear() << x, z.cross(x), z;
  T_world_camera.translation() = eye_world;
  return T_world_camera;
}

Eigen::Isometry3d T_world_camera_at(const CameraPath& path, double t_s) {
  // The second sine evens out the speed: the angle advances faster where the ellipse is narrow.
  const double a = path.half_m.x(), b = path.half_m.y();
  const double phase_rad = path.start_rad + kFullTurn_rad * t_s / path.loop_s;
  const double evenness = a + b > 0.0 ? (a - b) / (2.0 * (a + b)) : 0.0;
  const double angle_rad = phase_rad + evenness * std::sin(2.0 * phase_rad);
  Vector3d position_world =
      path.centre_world + Vector3d(a * std::cos(angle_rad), b * std::sin(angle_rad), 0.0);
  Vector3d target_world = path.target_world;
  if (!path.walk.empty()) {
    constexpr double kAhead_m = 1.5;
    const WalkPoint walker =
        path.walk_step_s > 0.0 ? open_walk_at(path, t_s) : closed_walk_at(path, phase_rad);
    position_world.head<2>() = walker.position_m;
    position_world.z() += walker.floor_m;
    target_world.z() += walker.floor_m;
    target_world.head<2>() =
        walker.position_m + kAhead_m * Eigen::Vector2d(std::cos(walker.yaw_rad), std::sin(walker.yaw_rad));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    position_world[static_cast<Eigen::Index>(axis)] += at(path.position_sway[axis], t_s);
    target_world[static_cast<Eigen::Index>(axis)] += at(path.target_sway[axis], t_s);
  }
  Eigen::Isometry3d T_world_camera = looking_at(position_world, target_world);
  for (int axis = 0; axis < 3; ++axis)
    T_world_camera.linear() *=
        Eigen::AngleAxisd(at(path.turn_sway[static_cast<std::size_t>(axis)], t_s), Vector3d::Unit(axis))
            .toRotationMatrix();
  return T_world_camera;
}

}  // namespace roomradar
