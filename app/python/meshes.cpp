// meshes.cpp: meshes from arrays, as arrays, from files and to files.
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "app/python/arrays.hpp"
#include "app/python/bindings.hpp"
#include "app/python/long_calls.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar::python {
namespace {

template <typename Element, typename Item>
std::vector<Item> items_of(py::handle value, const char* name, py::ssize_t count, const char* shape) {
  const py::array array = required_array<Element>(value, name, {{count, 3}, shape});
  std::vector<Item> items(static_cast<std::size_t>(array.shape(0)));
  if (!items.empty())
    std::memcpy(static_cast<void*>(items.data()), array.data(), items.size() * sizeof(Item));
  return items;
}

void require_usable(const Mesh& mesh) {
  if (mesh.vertices.size() > std::numeric_limits<std::uint32_t>::max())
    throw py::value_error("vertices: has too many rows");
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (!mesh.vertices[i].allFinite())
      throw py::value_error("vertices: row " + std::to_string(i) + " is not finite");
  for (std::size_t i = 0; i < mesh.normals.size(); ++i)
    if (!mesh.normals[i].allFinite())
      throw py::value_error("normals: row " + std::to_string(i) + " is not finite");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (!is_usable(mesh, mesh.triangles[i]))
      throw py::value_error("triangles: row " + std::to_string(i) +
                            " names a vertex that does not exist; there are " +
                            std::to_string(mesh.vertices.size()));
}

std::shared_ptr<Mesh> make_mesh(const py::object& vertices, const py::object& triangles,
                                const py::object& origin, const py::object& normals,
                                const py::object& colours) {
  auto mesh = std::make_shared<Mesh>();
  mesh->vertices = items_of<float, Eigen::Vector3f>(vertices, "vertices", -1, "(N, 3)");
  mesh->triangles = items_of<std::uint32_t, Triangle>(triangles, "triangles", -1, "(M, 3)");
  const auto count = static_cast<py::ssize_t>(mesh->vertices.size());
  const std::string rows = "(" + std::to_string(count) + ", 3), a row per vertex";
  if (!origin.is_none()) mesh->origin = vector_of(origin, "origin");
  if (!normals.is_none())
    mesh->normals = items_of<float, Eigen::Vector3f>(normals, "normals", count, rows.c_str());
  if (!colours.is_none())
    mesh->colours = items_of<std::uint8_t, Rgb>(colours, "colours", count, rows.c_str());
  require_usable(*mesh);
  return mesh;
}

/// Returns a view of one of the mesh's lists, or None for an optional list that is empty.
template <auto list, bool kOptional>
py::object list_view(const py::object& self) {
  const auto& items = self.cast<const Mesh&>().*list;
  if (kOptional && items.empty()) return py::none();
  return view_of(items, self);
}

std::string repr(const Mesh& mesh) {
  return "<roomradar.Mesh of " + std::to_string(mesh.vertices.size()) + " vertices and " +
         std::to_string(mesh.triangles.size()) + " triangles>";
}

}  // namespace

void bind_meshes(py::module_& module) {
  py::class_<Mesh, std::shared_ptr<Mesh>>(
      module, "Mesh",
      "Indexed triangles. Vertex i is at origin + vertices[i]. Immutable. Arrays are read-only views.")
      .def(py::init(&make_mesh), py::arg("vertices"), py::arg("triangles"), py::kw_only(),
           py::arg("origin") = py::none(), py::arg("normals") = py::none(), py::arg("colours") = py::none(),
           "Copies the arrays: vertices and normals (N, 3) float32, triangles (M, 3) uint32, colours (N, 3) "
           "uint8,\n"
           "origin (3,) float64.")
      .def_property_readonly("vertices", &list_view<&Mesh::vertices, false>,
                             "(N, 3) float32, m, relative to the origin.")
      .def_property_readonly("triangles", &list_view<&Mesh::triangles, false>,
                             "(M, 3) uint32, counter-clockwise seen from outside.")
      .def_property_readonly("normals", &list_view<&Mesh::normals, true>,
                             "(N, 3) float32, unit, outward, or None.")
      .def_property_readonly("colours", &list_view<&Mesh::colours, true>, "(N, 3) uint8, RGB, or None.")
      .def_property_readonly(
          "origin", [](const Mesh& mesh) { return array_of(mesh.origin); }, "(3,) float64, m.")
      .def(
          "transformed",
          [](const Mesh& mesh, const py::object& T_to_mesh) {
            return std::make_shared<Mesh>(transformed(mesh, pose_of(T_to_mesh, "T_to_mesh")));
          },
          py::arg("T_to_mesh"), "Returns the mesh in another frame.")
      .def_static(
          "read",
          [](const std::filesystem::path& path) {
            return without_gil([&] { return std::make_shared<Mesh>(read_mesh(path)); });
          },
          py::arg("path"), "Reads a .ply, .obj, .stl or .glb file.")
      .def(
          "write",
          [](const Mesh& mesh, const std::filesystem::path& path) {
            without_gil([&] { write_mesh(mesh, path); });
          },
          py::arg("path"), "Writes a .ply, .obj, .stl or .glb file.")
      .def("__repr__", [](const Mesh& mesh) { return repr(mesh); });
}

}  // namespace roomradar::python
