// mesh.hpp: triangle meshes. Vertices are floats relative to a local origin, so they stay precise far from
// the world's origin.
#pragma once
#include <Eigen/Geometry>
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

/// Returns the area of a triangle of the mesh, m2.
inline double triangle_area_m2(const Mesh& mesh, const Triangle& t) {
  const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
  return 0.5 * (mesh.vertices[t[1]].cast<double>() - a).cross(mesh.vertices[t[2]].cast<double>() - a).norm();
}

/// Returns the sum of the areas of all triangles, m2.
inline double surface_area_m2(const Mesh& mesh) {
  double sum_m2 = 0.0;
  for (const Triangle& t : mesh.triangles) sum_m2 += triangle_area_m2(mesh, t);
  return sum_m2;
}

/// Returns the mesh in the frame `to`. Vertices stay relative to a local origin.
inline Mesh transformed(Mesh mesh, const Eigen::Isometry3d& T_to_mesh) {
  const Eigen::Matrix3f R = T_to_mesh.linear().cast<float>();
  mesh.origin = T_to_mesh * mesh.origin;
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex = R * vertex;
  for (Eigen::Vector3f& normal : mesh.normals) normal = R * normal;
  return mesh;
}

}  // namespace roomradar
