// surface_score.cpp: samples points on the mesh, and computes exact distances to the room's solids.
#include "app/sim/scenarios/surface_score.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

Eigen::Vector3i cell_of(const Eigen::Vector3d& p) {
  return (p / kSurfaceFound_m).array().floor().cast<int>();
}

/// Points on a lattice of each triangle, each with the area it represents.
struct SpreadPoints {
  std::vector<Eigen::Vector3d> points;
  std::vector<double> areas_m2;
};

SpreadPoints spread_points(const Mesh& mesh, const Eigen::Isometry3d& T_room_map, double spacing_m) {
  SpreadPoints spread;
  for (const Triangle& triangle : mesh.triangles) {
    const auto corner = [&](std::size_t i) -> Eigen::Vector3d {
      return T_room_map * (mesh.origin + mesh.vertices[triangle[i]].cast<double>());
    };
    const Eigen::Vector3d a = corner(0), ab = corner(1) - a, ac = corner(2) - a;
    const double longest_m = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
    const int parts = std::max(1, static_cast<int>(std::ceil(longest_m / spacing_m)));
    const double area_m2 = 0.5 * ab.cross(ac).norm();
    const double step = 1.0 / parts;
    const auto add = [&](double u, double v) {
      spread.points.push_back(a + u * ab + v * ac);
      spread.areas_m2.push_back(area_m2 / (parts * parts));
    };
    for (int i = 0; i < parts; ++i) {
      for (int j = 0; i + j < parts; ++j) {
        add((i + 1.0 / 3.0) * step, (j + 1.0 / 3.0) * step);
        if (i + j + 1 < parts) add((i + 2.0 / 3.0) * step, (j + 2.0 / 3.0) * step);
      }
    }
  }
  return spread;
}

/// Returns the size below which a fraction `part` of the total weight is; sizes are ascending.
double weighted_quantile(const std::vector<std::pair<double, double>>& size_and_weight, double part) {
  double total = 0.0;
  for (const auto& [size, weight] : size_and_weight) total += weight;
  double sum = 0.0;
  for (const auto& [size, weight] : size_and_weight) {
    sum += weight;
    if (sum >= part * total) return size;
  }
  return 0.0;
}

/// Returns the fraction of `points` with a point of `spread` within kSurfaceFound_m.
double covered_part(const std::vector<Eigen::Vector3d>& points, const SpreadPoints& spread) {
  std::unordered_multimap<std::uint64_t, std::size_t> near;
  for (std::size_t i = 0; i < spread.points.size(); ++i)
    near.emplace(voxel_key(cell_of(spread.points[i])), i);
  std::size_t covered = 0;
  for (const Eigen::Vector3d& point : points) {
    bool found = false;
    for (int n = 0; n < kCellsRound && !found; ++n) {
      const auto [begin, end] = near.equal_range(voxel_key(cell_of(point) + neighbour_offset(n)));
      found = std::any_of(begin, end, [&](const auto& entry) {
        return (spread.points[entry.second] - point).squaredNorm() <= kSurfaceFound_m * kSurfaceFound_m;
      });
    }
    covered += found ? 1 : 0;
  }
  return points.empty() ? 0.0 : static_cast<double>(covered) / static_cast<double>(points.size());
}

}  // namespace

void SeenSurface::add(const Frame& frame, const SimTruth& truth) {
  constexpr float kFarthest_m = 5.0F;  // FusionConfig::max_range_m
  constexpr int kStride_px = 4;
  const Intrinsics& camera = frame.depth_camera;
  for (int y = 0; y < frame.depth_m.height; y += kStride_px) {
    for (int x = 0; x < frame.depth_m.width; x += kStride_px) {
      const float measured_m = frame.depth_m.at(x, y);
      const double z = truth.depth_m.at(x, y);
      if (!(measured_m > 0.0F && measured_m <= kFarthest_m && z > 0.0) || truth.moved.at(x, y) != 0) continue;
      const Eigen::Vector3d p_camera((x - camera.cx_px) / camera.fx_px * z,
                                     (y - camera.cy_px) / camera.fy_px * z, z);
      const Eigen::Vector3d p_room = truth.T_world_camera * p_camera;
      Seen& seen = cells_.try_emplace(voxel_key(cell_of(p_room)), Seen{p_room}).first->second;
      if (seen.last_frame == frame.index) continue;
      seen.last_frame = frame.index;
      ++seen.frames;
    }
  }
}

std::vector<Eigen::Vector3d> SeenSurface::points() const {
  constexpr int kFramesSeen = 3;
  std::vector<Eigen::Vector3d> points;
  for (const auto& [cell, seen] : cells_)
    if (seen.frames >= kFramesSeen) points.push_back(seen.point);
  return points;
}

SurfaceScore score_surface(const Mesh& mesh, const Eigen::Isometry3d& T_room_map, const Room& room,
                           const std::vector<Eigen::Vector3d>& seen, double spacing_m) {
  const SpreadPoints spread = spread_points(mesh, T_room_map, spacing_m);
  std::vector<std::pair<double, double>> distances;
  double area_m2 = 0.0, precise_m2 = 0.0;
  for (std::size_t i = 0; i < spread.points.size(); ++i) {
    const double distance_m = std::abs(signed_distance_m(room, spread.points[i]));
    distances.emplace_back(distance_m, spread.areas_m2[i]);
    area_m2 += spread.areas_m2[i];
    if (distance_m <= kSurfaceFound_m) precise_m2 += spread.areas_m2[i];
  }
  std::sort(distances.begin(), distances.end());
  return {.error_median_m = weighted_quantile(distances, 0.5),
          .error_p95_m = weighted_quantile(distances, 0.95),
          .precision = area_m2 > 0.0 ? precise_m2 / area_m2 : 0.0,
          .cover = covered_part(seen, spread)};
}

}  // namespace roomradar
