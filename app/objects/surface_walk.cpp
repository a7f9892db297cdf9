// surface_walk.cpp: steepest descent of the distance over adjacent triangles.
#include "app/objects/surface_walk.hpp"

#include "app/objects/triangle_weights.hpp"
#include "mapping/mesh/triangle_distance.hpp"

namespace roomradar {

SurfaceWalk::SurfaceWalk(const Mesh& mesh) : mesh_(mesh), first_(mesh.vertices.size() + 1, 0) {
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t vertex : t) ++first_[vertex + 1];
  for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
  triangles_.resize(3 * mesh.triangles.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t vertex : mesh.triangles[t]) triangles_[next[vertex]++] = t;
}

float SurfaceWalk::squared_distance(std::uint32_t triangle, const Eigen::Vector3f& p) const {
  const Triangle& t = mesh_.triangles[triangle];
  return squared_distance_to_triangle(p, mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
}

SurfaceFoot SurfaceWalk::nearest(std::uint32_t start, const Eigen::Vector3f& p) const {
  std::uint32_t at = start;
  float least = squared_distance(at, p);
  for (bool has_moved = true; has_moved;) {
    has_moved = false;
    const Triangle from = mesh_.triangles[at];
    for (const std::uint32_t vertex : from)
      for (std::uint32_t i = first_[vertex]; i < first_[vertex + 1]; ++i) {
        const float distance = squared_distance(triangles_[i], p);
        if (!(distance < least)) continue;
        least = distance;
        at = triangles_[i];
        has_moved = true;
      }
  }
  const Triangle& t = mesh_.triangles[at];
  return {at, triangle_weights(mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]], p)};
}

}  // namespace roomradar
