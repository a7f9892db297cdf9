// mesh_raster.hpp: CPU rasteriser: depth and triangle index of a mesh at each pixel of a camera.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Returns twice the signed area of the triangle (0, a, b).
inline float cross(const Eigen::Vector2f& a, const Eigen::Vector2f& b) {
  return a.x() * b.y() - a.y() * b.x();
}

inline constexpr std::uint32_t kNoTriangle = ~std::uint32_t{0};

struct MeshRaster {
  DepthImage depth_m;             ///< of the nearest triangle; 0: none
  Image<std::uint32_t> triangle;  ///< index in Mesh::triangles; kNoTriangle: none
};

/// Renders the mesh with a depth buffer; both sides of triangles are visible. Triangles that reach behind the
/// camera are clipped 5 cm in front of it.
/// @param T_camera_mesh  maps mesh coordinates (origin added) to camera coordinates
MeshRaster rasterise(const Mesh& mesh, const Intrinsics& camera, const Eigen::Isometry3d& T_camera_mesh);

}  // namespace roomradar
