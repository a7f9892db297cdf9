// surface_points.cpp: uniform samples of a mesh, and depth pixels of keyframes.
#include "mapping/map/surface_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

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
  std::size_t pixels = 0;
  for (const MapKeyframe& place : keyframe_database.keyframes) pixels += place.preview_depth_mm.pixels.size();
  const std::size_t stride = 1 + pixels / std::max<std::size_t>(count, 1);
  std::vector<Eigen::Vector3d> points;
  std::size_t at = 0;
  for (const MapKeyframe& place : keyframe_database.keyframes) {
    const auto width = static_cast<std::size_t>(std::max(place.preview_depth_mm.width, 1));
    for (; at < place.preview_depth_mm.pixels.size(); at += stride) {
      const std::uint16_t depth_mm = place.preview_depth_mm.pixels[at];
      if (depth_mm == 0 || depth_mm > kFarthest_mm) continue;
      points.push_back(place.T_world_camera * back_project(place.preview_camera,
                                                           static_cast<double>(at % width),
                                                           static_cast<double>(at / width), 1e-3 * depth_mm));
    }
    at -= place.preview_depth_mm.pixels.size();
  }
  return points;
}

}  // namespace roomradar
