// surface_walk.hpp: nearest points of a mesh, found along its surface.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A point of a surface.
struct SurfaceFoot {
  std::uint32_t triangle = 0;
  Eigen::Vector3f weights = Eigen::Vector3f::Zero();  ///< barycentric
};

/// Finds nearest points by walking from triangle to triangle over common vertices. A walk does not cross a
/// seam, where vertices are there twice, and does not reach the far side of a thin sheet. It may end at a
/// point that is nearest only among its neighbours.
class SurfaceWalk {
 public:
  /// @param mesh  must outlive the walk; all triangles valid
  explicit SurfaceWalk(const Mesh& mesh);

  /// Returns a triangle at a vertex that some triangle uses.
  [[nodiscard]] std::uint32_t triangle_at(std::uint32_t vertex) const { return triangles_[first_[vertex]]; }
  /// Walks from a triangle to the point nearest to p.
  [[nodiscard]] SurfaceFoot nearest(std::uint32_t start, const Eigen::Vector3f& p) const;

 private:
  const Mesh& mesh_;
  std::vector<std::uint32_t>
      first_;  // per vertex: index of its first entry in triangles_; one more at the end
  std::vector<std::uint32_t> triangles_;  // triangles at the vertices

  [[nodiscard]] float squared_distance(std::uint32_t triangle, const Eigen::Vector3f& p) const;
};

}  // namespace roomradar
