// mesh.hpp: triangles in the world, kept near a local origin so that float vertices stay exact.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Counter-clockwise seen from outside (from where the sensor stood).
using Triangle = std::array<std::uint32_t, 3>;

/// Indexed triangles. A vertex stands at origin + vertices[i] in the mesh's frame (world, or an object's
/// own).
struct Mesh {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m; vertices are float and relative to it
  std::vector<Eigen::Vector3f> vertices;             ///< m
  std::vector<Eigen::Vector3f> normals;              ///< unit, outward; empty or one a vertex
  std::vector<Rgb> colours;                          ///< empty or one a vertex
  std::vector<Triangle> triangles;
};

}  // namespace roomradar
