// object_model.cpp: makes the model of a mesh.
#include "app/objects/object_model.hpp"

#include <utility>

#include "mapping/types/system/error.hpp"

namespace roomradar {

namespace {

std::vector<Eigen::Vector3d> corners_of(const GpuMesh& mesh) {
  std::vector<bool> is_corner(mesh.vertices().size());
  for (const Triangle& triangle : mesh.triangles())
    for (const std::uint32_t vertex : triangle) is_corner[vertex] = true;
  std::vector<Eigen::Vector3d> corners;
  for (std::size_t vertex = 0; vertex < is_corner.size(); ++vertex)
    if (is_corner[vertex]) corners.push_back(mesh.origin() + mesh.vertices()[vertex].cast<double>());
  return corners;
}

}  // namespace

ObjectParts object_parts(const std::string& name, Mesh mesh) {
  ObjectParts parts;
  parts.mesh = std::move(mesh);
  parts.touched.build_by_place(parts.mesh);
  if (parts.touched.empty()) throw Error(name + ": has no triangles; a virtual object is a surface");
  parts.mass = mass_properties(parts.mesh, parts.touched.is_closed());
  parts.surface = spread_points(parts.mesh);
  parts.levels = levels_of_detail(parts.mesh);
  return parts;
}

ObjectModel::ObjectModel(GlContext& context, ObjectParts parts)
    : mesh(std::move(parts.mesh)), shape(context), mass(parts.mass), surface(std::move(parts.surface)) {
  shape.set(mesh, std::move(parts.touched));
  corners = corners_of(shape.drawn);
  middle = shape.drawn.bounds().center();
  for (const LevelOfDetail& level : parts.levels) {
    levels.push_back({level.deviation_m, std::make_unique<GpuMesh>(context)});
    levels.back().mesh->upload(level.mesh, MeshUsage::kStatic);
  }
}

bool is_model_of(const ObjectModel& model, const Mesh& mesh) {
  const Mesh& own = model.mesh;
  return own.origin == mesh.origin && own.vertices == mesh.vertices && own.triangles == mesh.triangles &&
         own.normals == mesh.normals && own.colours == mesh.colours;
}

}  // namespace roomradar
