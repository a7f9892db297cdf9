// mesh_raster.cpp: clips, projects and fills triangles.
#include "mapping/texture/mesh_raster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace roomradar {
namespace {

constexpr float kNear_m = 0.05F;

/// Corner of a polygon in the image: pixel coordinates and 1 / depth, which is linear in them.
using Corner = Eigen::Vector3f;

/// The part of a triangle in front of the near plane: 0, 3 or 4 points in the camera frame.
struct Clipped {
  std::array<Eigen::Vector3f, 4> points;
  std::size_t count = 0;
};

Clipped clipped(const std::array<Eigen::Vector3f, 3>& triangle) {
  Clipped kept;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3f &a = triangle[i], &b = triangle[(i + 1) % 3];
    if (a.z() >= kNear_m) kept.points[kept.count++] = a;
    if ((a.z() >= kNear_m) != (b.z() >= kNear_m))
      kept.points[kept.count++] = a + (kNear_m - a.z()) / (b.z() - a.z()) * (b - a);
  }
  return kept;
}

void fill(Corner a, Corner b, Corner c, std::uint32_t triangle, MeshRaster& raster) {
  float area = cross(b.head<2>() - a.head<2>(), c.head<2>() - a.head<2>());
  if (area < 0.0F) {
    std::swap(b, c);
    area = -area;
  }
  if (!(area > 0.0F) || !std::isfinite(area)) return;
  const auto bound = [](float value, int size) {
    return static_cast<int>(std::clamp(value, 0.0F, static_cast<float>(size)));
  };
  const int width = raster.depth_m.width, height = raster.depth_m.height;
  const int left = bound(std::ceil(std::min({a.x(), b.x(), c.x()})), width);
  const int right = bound(std::floor(std::max({a.x(), b.x(), c.x()})) + 1.0F, width);
  const int top = bound(std::ceil(std::min({a.y(), b.y(), c.y()})), height);
  const int bottom = bound(std::floor(std::max({a.y(), b.y(), c.y()})) + 1.0F, height);
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      const Eigen::Vector2f p(static_cast<float>(x), static_cast<float>(y));
      const float of_a = cross(c.head<2>() - b.head<2>(), p - b.head<2>());
      const float of_b = cross(a.head<2>() - c.head<2>(), p - c.head<2>());
      const float of_c = cross(b.head<2>() - a.head<2>(), p - a.head<2>());
      if (of_a < 0.0F || of_b < 0.0F || of_c < 0.0F) continue;
      const float depth_m = area / (of_a * a.z() + of_b * b.z() + of_c * c.z());
      float& nearest_m = raster.depth_m.at(x, y);
      if (nearest_m > 0.0F && nearest_m <= depth_m) continue;
      nearest_m = depth_m;
      raster.triangle.at(x, y) = triangle;
    }
  }
}

}  // namespace

MeshRaster rasterise(const Mesh& mesh, const Intrinsics& camera, const Eigen::Isometry3d& T_camera_mesh) {
  MeshRaster raster{DepthImage(camera.width_px, camera.height_px),
                    Image<std::uint32_t>(camera.width_px, camera.height_px, kNoTriangle)};
  const Eigen::Isometry3f T_camera_local = (T_camera_mesh * Eigen::Translation3d(mesh.origin)).cast<float>();
  std::vector<Eigen::Vector3f> points_camera(mesh.vertices.size());
  for (std::size_t i = 0; i < points_camera.size(); ++i) points_camera[i] = T_camera_local * mesh.vertices[i];
  const auto fx = static_cast<float>(camera.fx_px), fy = static_cast<float>(camera.fy_px);
  const auto cx = static_cast<float>(camera.cx_px), cy = static_cast<float>(camera.cy_px);
  const auto corner = [&](const Eigen::Vector3f& p) {
    return Corner(fx * p.x() / p.z() + cx, fy * p.y() / p.z() + cy, 1.0F / p.z());
  };
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    const Clipped part = clipped({points_camera[t[0]], points_camera[t[1]], points_camera[t[2]]});
    for (std::size_t k = 2; k < part.count; ++k)
      fill(corner(part.points[0]), corner(part.points[k - 1]), corner(part.points[k]), i, raster);
  }
  return raster;
}

}  // namespace roomradar
