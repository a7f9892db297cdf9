// model_triangles.cpp: renumbers the vertices in the order of their use.
#include "app/models/model_triangles.hpp"

#include <unordered_map>

namespace roomradar {

Model triangles_alone(const Model& model, std::span<const std::uint32_t> triangles) {
  const Mesh& mesh = model.mesh;
  Model alone;
  alone.mesh.origin = mesh.origin;
  alone.mesh.triangles.reserve(triangles.size());
  std::unordered_map<std::uint32_t, std::uint32_t> name;
  for (const std::uint32_t t : triangles) {
    Triangle triangle = mesh.triangles[t];
    for (std::uint32_t& vertex : triangle) {
      const auto [known, is_new] =
          name.try_emplace(vertex, static_cast<std::uint32_t>(alone.mesh.vertices.size()));
      if (is_new) {
        alone.mesh.vertices.push_back(mesh.vertices[vertex]);
        if (!mesh.normals.empty()) alone.mesh.normals.push_back(mesh.normals[vertex]);
        if (!mesh.colours.empty()) alone.mesh.colours.push_back(mesh.colours[vertex]);
        if (!model.texture_points.empty()) alone.texture_points.push_back(model.texture_points[vertex]);
      }
      vertex = known->second;
    }
    alone.mesh.triangles.push_back(triangle);
  }
  return alone;
}

}  // namespace roomradar
