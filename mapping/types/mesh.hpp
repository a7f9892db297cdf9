// mesh.hpp: triangle meshes. Vertices are floats relative to a local origin, and thus precise far from zero.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Vertex indices, counter-clockwise as seen from outside (the sensor's side).
using Triangle = std::array<std::uint32_t, 3>;

/// Indexed triangles. Vertex i is at origin + vertices[i] in the mesh's frame (world or object frame).
struct Mesh {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m
  std::vector<Eigen::Vector3f> vertices;             ///< m, relative to origin
  std::vector<Eigen::Vector3f> normals;              ///< unit, outward; empty or one per vertex
  std::vector<Rgb> colours;                          ///< empty or one per vertex
  std::vector<Triangle> triangles;
};

}  // namespace roomradar
