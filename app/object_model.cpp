// object_model.cpp: makes the model of a mesh.
#include "app/object_model.hpp"

#include <utility>

#include "app/object_levels.hpp"
#include "mapping/types/error.hpp"

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

ObjectModel::ObjectModel(GlContext& context, const std::string& name, Mesh mesh_object)
    : mesh(std::move(mesh_object)), shape(context), surface(spread_points(mesh)) {
  shape.set(mesh, MeshUsage::kStatic);
  if (shape.touched.empty()) throw Error(name + ": has no triangles; a virtual object is a surface");
  corners = corners_of(shape.drawn);
  mass = mass_properties(mesh, shape.touched.is_closed());
  middle = shape.drawn.bounds().center();
  for (const ObjectLevel& level : object_levels(mesh)) {
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
