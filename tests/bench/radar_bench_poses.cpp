// radar_bench_poses.cpp: seeded poses that are verified to be free.
#include "radar_bench_poses.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/exact_travel.hpp"

namespace roomradar::bench {
namespace {

/// Squared distance from p to the triangle. Source: Ericson, Real-Time Collision Detection, 5.1.5.
double squared_distance_m2(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                           const Eigen::Vector3d& c) {
  const Eigen::Vector3d n = (b - a).cross(c - a);
  const auto is_inside = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    return n.dot((to - from).cross(p - from)) >= 0.0;
  };
  if (n.squaredNorm() > 0.0 && is_inside(a, b) && is_inside(b, c) && is_inside(c, a)) {
    return std::pow(n.dot(p - a), 2) / n.squaredNorm();
  }
  const auto to_edge = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const Eigen::Vector3d d = to - from;
    const double t = std::clamp(d.dot(p - from) / std::max(d.squaredNorm(), 1e-300), 0.0, 1.0);
    return (p - from - t * d).squaredNorm();
  };
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

/// Returns true if no triangle of the frame is within radius_m of the centre. The ball must be in front of
/// the camera; only cells that it can project into are tested.
bool is_ball_free(const FrameScene& frame, const Eigen::Vector3d& centre, double radius_m) {
  if (centre.z() <= radius_m) return false;
  const int columns = (frame.camera.width_px - 1) / frame.stride_px + 1;
  const int rows = (frame.camera.height_px - 1) / frame.stride_px + 1;
  Eigen::AlignedBox2d box;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
    box.extend(project(frame.camera, centre + radius_m * corner));
  }
  const auto cell = [&](double pixel, int count) {
    return static_cast<int>(std::clamp(std::floor(pixel / frame.stride_px), 0.0, count - 2.0));
  };
  for (int j = cell(box.min().y(), rows); j <= cell(box.max().y(), rows); ++j) {
    for (int i = cell(box.min().x(), columns); i <= cell(box.max().x(), columns); ++i) {
      for (int half = 0; half < 2; ++half) {
        const Triangle& t =
            frame.mesh.triangles[2 * (static_cast<std::size_t>(j) * (columns - 1) + i) + half];
        const auto corner = [&](std::size_t k) -> Eigen::Vector3d {
          return frame.mesh.vertices[t[k]].cast<double>();
        };
        if (squared_distance_m2(centre, corner(0), corner(1), corner(2)) < radius_m * radius_m) return false;
      }
    }
  }
  return true;
}

Eigen::Quaterniond random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return Eigen::Quaterniond(w, x, y, z).normalized();
}

}  // namespace

std::vector<Pose> free_poses(const FrameScene& coarse, const FrameScene& fine, double clear_m, int count) {
  const Intrinsics& camera = coarse.camera;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::normal_distribution<double> normal;
  std::vector<Pose> poses;
  while (static_cast<int>(poses.size()) < count) {
    const int u = 320 + static_cast<int>(220.0 * uniform(random)),
              v = 260 + static_cast<int>(150.0 * uniform(random));
    const Eigen::Vector3d surface = back_project(camera, u, v, coarse.depth_m.at(u, v));
    const Eigen::Vector3d centre = surface - (0.275 + 0.125 * uniform(random)) * surface.normalized();
    const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
    Pose pose;
    pose.T_world_sensor = Eigen::Translation3d(centre) * Eigen::Quaterniond(w, x, y, z).normalized();
    const double dx = uniform(random), dy = uniform(random), dz = uniform(random);
    pose.direction_world = (surface.normalized() + 0.5 * Eigen::Vector3d(dx, dy, dz)).normalized();
    if (is_ball_free(coarse, centre, clear_m) && is_ball_free(fine, centre, clear_m)) poses.push_back(pose);
  }
  return poses;
}

std::vector<Pose> steady_poses(const FrameScene& coarse, const FrameScene& fine, double clear_m, int count) {
  std::vector<Pose> poses = free_poses(coarse, fine, clear_m, count);
  for (Pose& pose : poses) {
    pose.T_world_sensor.linear() = Eigen::Quaterniond(0.8, 0.3, -0.4, 0.2).normalized().toRotationMatrix();
    pose.direction_world = Eigen::Vector3d(0.1, 0.3, 1.0).normalized();
  }
  return poses;
}

std::vector<Pose> hollow_poses(const Mesh& object, const Mesh& sticks,
                               const std::vector<Eigen::Vector3d>& tips_m, int count, unsigned seed) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : object.vertices) box.extend(vertex.cast<double>());
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::uniform_int_distribution<std::size_t> any_tip(0, tips_m.size() - 1);
  std::vector<Pose> poses;
  while (static_cast<int>(poses.size()) < count) {
    const double a = uniform(random), b = uniform(random), c = uniform(random);
    const Eigen::Vector3d tip_object = box.min() + Eigen::Vector3d(a, b, c).cwiseProduct(box.sizes());
    const Eigen::Vector3d tip = tips_m[any_tip(random)];
    Pose pose;
    pose.T_world_sensor = Eigen::Isometry3d(random_rotation(random));
    pose.T_world_sensor.translation() = tip - pose.T_world_sensor.linear() * tip_object;
    pose.direction_world = random_rotation(random) * Eigen::Vector3d::UnitZ();
    // Surfaces that cross are in contact at once, whatever the direction.
    const std::optional<double> contact_distance_m = exact_travel(
        object, pose.T_world_sensor, pose.direction_world, 0.01, sticks, Eigen::Isometry3d::Identity());
    if (!contact_distance_m || *contact_distance_m > 1e-5) poses.push_back(pose);
  }
  return poses;
}

}  // namespace roomradar::bench
