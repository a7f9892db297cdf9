// surface_walk.hpp: nearest point of a mesh, searched along its surface.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Point of a mesh's surface.
struct SurfaceFoot {
  std::uint32_t triangle = 0;
  Eigen::Vector3f weights = Eigen::Vector3f::Zero();  ///< barycentric coordinates in the triangle
};

/// Finds nearest points by walking between triangles that share a vertex. The search does not cross seams
/// (edges with duplicated vertices), and does not reach the far side of a thin sheet. The search may end in a
/// local minimum of the distance.
class SurfaceWalk {
 public:
  /// @param mesh  must outlive the walk; all triangles valid
  explicit SurfaceWalk(const Mesh& mesh);

  /// Returns a triangle that uses `vertex`. At least one triangle must use it.
  [[nodiscard]] std::uint32_t triangle_at(std::uint32_t vertex) const { return triangles_[first_[vertex]]; }
  /// Walks from triangle `start` to the point nearest to p.
  [[nodiscard]] SurfaceFoot nearest(std::uint32_t start, const Eigen::Vector3f& p) const;

 private:
  const Mesh& mesh_;
  std::vector<std::uint32_t>
      first_;  // per vertex: index of its first entry in triangles_; then triangles_.size()
  std::vector<std::uint32_t> triangles_;  // triangles of each vertex, vertex by vertex

  [[nodiscard]] float squared_distance(std::uint32_t triangle, const Eigen::Vector3f& p) const;
};

}  // namespace roomradar
