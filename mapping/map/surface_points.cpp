// surface_points.cpp: uniform samples of a mesh, and depth pixels of keyframes.
#include "mapping/map/surface_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>

#include "mapping/types/voxel_key.hpp"

namespace roomradar {

std::vector<Eigen::Vector3d> sample_surface(const Mesh& mesh, std::size_t count) {
  std::vector<double> area_m2;
  double sum_m2 = 0.0;
  for (const Triangle& triangle : mesh.triangles) {
    const Eigen::Vector3f &p = mesh.vertices[triangle[0]], &q = mesh.vertices[triangle[1]],
                          &r = mesh.vertices[triangle[2]];
    area_m2.push_back(0.5 * static_cast<double>((q - p).cross(r - p).norm()));
    sum_m2 += area_m2.back();
  }
  std::vector<Eigen::Vector3d> points;
  if (!(sum_m2 > 0.0) || count == 0) return points;
  const double step_m2 = sum_m2 / static_cast<double>(count);
  double next_m2 = 0.5 * step_m2, passed_m2 = 0.0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    passed_m2 += area_m2[i];
    for (; next_m2 < passed_m2; next_m2 += step_m2) {
      // Position in the triangle from a low-discrepancy sequence. Source: Roberts, R2 sequence, 2018.
      const auto n = static_cast<double>(points.size());
      double u = std::fmod(0.5 + 0.7548776662466927 * n, 1.0),
             v = std::fmod(0.5 + 0.5698402909980532 * n, 1.0);
      if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
      const Triangle& triangle = mesh.triangles[i];
      const Eigen::Vector3d p = mesh.vertices[triangle[0]].cast<double>();
      const Eigen::Vector3d q = mesh.vertices[triangle[1]].cast<double>();
      const Eigen::Vector3d r = mesh.vertices[triangle[2]].cast<double>();
      points.emplace_back(mesh.origin + p + u * (q - p) + v * (r - p));
    }
  }
  return points;
}

std::vector<Eigen::Vector3d> surface_of(const KeyframeDatabase& keyframe_database, std::size_t count) {
  constexpr std::uint16_t kFarthest_mm = 3000;  // farther measurements are off by 1.5 cm and more
  constexpr double kCell_m = 0.03;
  std::unordered_set<std::uint64_t> cells;
  std::vector<Eigen::Vector3d> points;
  for (const MapKeyframe& place : keyframe_database.keyframes) {
    for (int y = 0; y < place.preview_depth_mm.height; ++y) {
      for (int x = 0; x < place.preview_depth_mm.width; ++x) {
        const std::uint16_t depth_mm = place.preview_depth_mm.at(x, y);
        if (depth_mm == 0 || depth_mm > kFarthest_mm) continue;
        const Eigen::Vector3d p =
            place.T_world_camera * back_project(place.preview_camera, x, y, 1e-3 * depth_mm);
        const Eigen::Array3d cell = (p / kCell_m).array().floor();
        if (!(cell.abs() < 1e6).all()) continue;  // a damaged camera
        if (cells.insert(voxel_key(cell.matrix().cast<int>())).second) points.push_back(p);
      }
    }
  }
  const std::size_t stride = 1 + points.size() / std::max<std::size_t>(count, 1);
  for (std::size_t i = 0; i * stride < points.size(); ++i) points[i] = points[i * stride];
  points.resize((points.size() + stride - 1) / stride);
  return points;
}

}  // namespace roomradar
