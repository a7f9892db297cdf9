// mesh_raster.hpp: depth image of a mesh, rendered without GL, to check meshes made from depth images.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar::test {

/// Returns the image with depth 0 where the mask is 0.
inline DepthImage masked_depth(DepthImage depth_m, const MaskImage& mask) {
  for (std::size_t i = 0; i < depth_m.pixels.size(); ++i)
    if (mask.pixels[i] == 0) depth_m.pixels[i] = 0.0F;
  return depth_m;
}

/// Renders the nearest depth at each pixel's centre, 0 without a triangle; triangles cover their edges. All
/// vertices must be in front of the camera.
inline DepthImage rasterise(const Mesh& mesh, const Intrinsics& camera,
                            const Eigen::Isometry3d& T_world_camera) {
  DepthImage depth_m(camera.width_px, camera.height_px);
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  for (const Triangle& t : mesh.triangles) {
    Eigen::Vector2d p[3];
    double w[3];
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d at = T_camera_world * (mesh.origin + mesh.vertices[t[k]].cast<double>());
      p[k] = project(camera, at);
      w[k] = 1.0 / at.z();
    }
    const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
      return a.x() * b.y() - a.y() * b.x();
    };
    const double area = cross(p[1] - p[0], p[2] - p[0]);
    if (std::abs(area) < 1e-9) continue;
    constexpr double kSlack = 1e-3;  // vertices are float: rounding could drop pixels on an edge
    const auto [x0, x1] = std::minmax({p[0].x(), p[1].x(), p[2].x()});
    const auto [y0, y1] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
    for (int y = std::max(0, static_cast<int>(std::ceil(y0 - kSlack)));
         y <= std::min(camera.height_px - 1, static_cast<int>(std::floor(y1 + kSlack))); ++y) {
      for (int x = std::max(0, static_cast<int>(std::ceil(x0 - kSlack)));
           x <= std::min(camera.width_px - 1, static_cast<int>(std::floor(x1 + kSlack))); ++x) {
        const Eigen::Vector2d q(x, y);
        const double b = cross(q - p[0], p[2] - p[0]) / area, c = cross(p[1] - p[0], q - p[0]) / area;
        const double slack = kSlack / std::sqrt(std::abs(area));
        if (b < -slack || c < -slack || b + c > 1.0 + slack) continue;
        const auto z = static_cast<float>(1.0 / ((1.0 - b - c) * w[0] + b * w[1] + c * w[2]));
        float& at = depth_m.at(x, y);
        if (at <= 0.0F || z < at) at = z;
      }
    }
  }
  return depth_m;
}

}  // namespace roomradar::test
