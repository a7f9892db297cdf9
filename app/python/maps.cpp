// maps.cpp: maps as objects, and the functions of `roomradar map`.
#include "app/python/maps.hpp"

#include <algorithm>
#include <vector>

#include "app/page/room_page.hpp"
#include "app/python/arrays.hpp"
#include "app/python/bindings.hpp"
#include "app/python/long_calls.hpp"
#include "mapping/map/level_surfaces.hpp"
#include "mapping/map/map_diff.hpp"
#include "mapping/map/map_export.hpp"
#include "mapping/map/map_info.hpp"
#include "mapping/map/map_merge.hpp"
#include "mapping/map/map_writer.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar::python {

using MapPointer = std::shared_ptr<Map>;

std::shared_ptr<Octree> octree_of(Map& map) {
  const StaticMap& octree =
      without_gil([&]() -> const StaticMap& { return std::as_const(map.saved).octree.load(); });
  return std::make_shared<Octree>(std::shared_ptr<const StaticMap>(map.shared_from_this(), &octree));
}

namespace {

py::object dict_of(const MapInfo& info) {
  return py::module_::import("json").attr("loads")(text_of(to_json(info)));
}

MapPointer open_map(const std::filesystem::path& folder) {
  return without_gil([&] { return std::make_shared<Map>(load_map(folder), folder.string()); });
}

void save(Map& map, const std::filesystem::path& folder) {
  without_gil([&] { save_map(folder, map.saved); });
}

py::object trajectory_of(const Map& map) {
  const std::vector<TimedPose>& poses = map.saved.trajectory;
  const auto count = static_cast<py::ssize_t>(poses.size());
  py::array_t<double> stamp_s(count), T_world_camera({count, py::ssize_t{4}, py::ssize_t{4}});
  for (py::ssize_t i = 0; i < count; ++i) {
    const TimedPose& pose = poses[static_cast<std::size_t>(i)];
    stamp_s.mutable_at(i) = pose.stamp_s;
    Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(T_world_camera.mutable_data(i, 0, 0)) =
        pose.T_world_camera.matrix();
  }
  return py::make_tuple(stamp_s, T_world_camera);
}

/// Returns the keyframes, each of which keeps the map alive.
std::vector<std::shared_ptr<const MapKeyframe>> keyframes_of(Map& map) {
  std::vector<std::shared_ptr<const MapKeyframe>> keyframes;
  for (const MapKeyframe& keyframe : map.saved.keyframe_database.load().keyframes)
    keyframes.emplace_back(map.shared_from_this(), &keyframe);
  return keyframes;
}

std::shared_ptr<Mesh> unknown_mesh_of(const Map& map) {
  return without_gil([&] {
    const SavedMap& saved = map.saved;
    const std::shared_ptr<const UnknownSurface>& kept = saved.unknown.load();
    return std::make_shared<Mesh>(kept ? kept->mesh_world
                                       : unknown_surface(saved.octree.load(), saved.mesh).mesh_world);
  });
}

void export_to(const std::filesystem::path& folder, const std::filesystem::path& path) {
  without_gil([&] {
    if (!is_page(path.string())) return export_map(folder, path);
    require_outside_maps(path);
    write_map_page(load_map(folder), folder.string(), path);
  });
}

Registration registered(const Map& a, const Map& b) {
  const Registration found = register_maps(a.saved, b.saved);
  if (!found)
    throw Error("the maps cannot be registered: " + describe(found) +
                "; both must show a large common part of one room");
  return found;
}

MapPointer merge(const Map& a, const Map& b) {
  const bool same = &a == &b || (!octree_checksum(a.saved.info).empty() &&
                                 octree_checksum(a.saved.info) == octree_checksum(b.saved.info));
  if (same) throw Error("the maps are the same; merged with itself, one would count every observation twice");
  if (a.folder.empty()) throw Error("map a is not in a folder; save it first, and open it again");
  return without_gil([&] {
    const Registration found = registered(a, b);
    // The merged map takes over a's data, so it is read again.
    return std::make_shared<Map>(merge_maps(load_map(a.folder), b.saved, found.T_a_b), "");
  });
}

std::vector<Change> diff(const Map& a, const Map& b) {
  return without_gil([&] {
    const Registration found =
        share_world(a.saved.info, b.saved.info) ? Registration{} : registered(a, b);
    return diff_maps(a.saved.octree.load(), b.saved.octree.load(), found.T_a_b, found.T_b_a, {});
  });
}

py::array points_of(const Change& change) {
  py::array_t<double> points({static_cast<py::ssize_t>(change.surface_world.size()), py::ssize_t{3}});
  for (std::size_t i = 0; i < change.surface_world.size(); ++i)
    Eigen::Map<Eigen::Vector3d>(points.mutable_data(static_cast<py::ssize_t>(i), 0)) =
        change.surface_world[i];
  return points;
}

void bind_parts(py::module_& module) {
  py::class_<MapKeyframe, std::shared_ptr<MapKeyframe>>(module, "MapKeyframe",
                                                        "A place by which the camera is found in a map.")
      .def_readonly("frame_index", &MapKeyframe::frame_index)
      .def_property_readonly(
          "T_world_camera", [](const MapKeyframe& keyframe) { return array_of(keyframe.T_world_camera); },
          "(4, 4) float64.")
      .def_property_readonly("features",
                             [](const MapKeyframe& keyframe) { return keyframe.descriptors.size(); })
      .def_property_readonly("patches", [](const MapKeyframe& keyframe) { return keyframe.patches.size(); })
      .def_readonly("preview_camera", &MapKeyframe::preview_camera)
      .def_property_readonly(
          "preview_depth_mm",
          [](const py::object& self) {
            return view_of(self.cast<const MapKeyframe&>().preview_depth_mm, self);
          },
          "Reduced depth image, (H, W) uint16, mm; 0: none. A view.");

  py::class_<LevelSurface>(module, "LevelSurface", "Floor, table top or another level surface.")
      .def_readonly("height_m", &LevelSurface::height_m)
      .def_readonly("area_m2", &LevelSurface::area_m2)
      .def_property_readonly("middle_world",
                             [](const LevelSurface& surface) { return array_of(surface.middle_world); })
      .def("__repr__", [](const LevelSurface& surface) {
        return "<roomradar.LevelSurface of " + format_readable(surface.area_m2, 3) + " m2 around " +
               text_of_point(surface.middle_world) + ">";
      });

  py::class_<Change>(module, "Change",
                     "An object that appeared or vanished between two maps; world of map a.")
      .def_property_readonly(
          "kind", [](const Change& change) { return std::string(to_string(change.kind)); },
          "\"appeared\" or \"vanished\".")
      .def_property_readonly("position_world",
                             [](const Change& change) { return array_of(change.position_world); })
      .def_property_readonly(
          "box_world", [](const Change& change) { return array_of(change.box_world); },
          "Lower and upper corner, (2, 3) float64, m.")
      .def_readonly("area_m2", &Change::area_m2)
      .def_readonly("volume_m3", &Change::volume_m3)
      .def_property_readonly("surface_world", &points_of, "Centres of its surface voxels, (N, 3) float64.")
      .def("__repr__", [](const Change& change) {
        return "<roomradar.Change " + std::string(to_string(change.kind)) + " at " +
               text_of_point(change.position_world) + ": " + format_readable(change.volume_m3, 3) + " m3>";
      });
}

void bind_map(py::module_& module) {
  py::class_<Map, MapPointer>(module, "Map",
                              "A prescanned room: octree, mesh, keyframes, trajectory. Does not change.")
      .def_property_readonly(
          "folder", [](const Map& map) { return text_of(map.folder); },
          "Folder that it was loaded from; empty: none.")
      .def_property_readonly(
          "info", [](const Map& map) { return dict_of(map.saved.info); }, "Content of map.json as a dict.")
      .def_property_readonly(
          "mesh", [](Map& map) { return std::shared_ptr<Mesh>(map.shared_from_this(), &map.saved.mesh); },
          "The surface in the world. Shares the map's memory.")
      .def_property_readonly("octree", &octree_of, "The octree, read from disk at its first use.")
      .def_property_readonly(
          "resolution_m",
          [](Map& map) {
            return octree_of(map)->read([](const StaticMap& octree) { return octree.resolution_m(); });
          })
      .def(
          "occupancy",
          [](Map& map, const py::object& points_world) {
            return occupancy_of(*octree_of(map), points_world);
          },
          py::arg("points_world"),
          "Returns the occupancy at points (N, 3) float64 as (N,) uint8: 0 unknown, 1 free, 2 occupied.")
      .def_property_readonly("keyframes", &keyframes_of)
      .def_property_readonly("trajectory", &trajectory_of,
                             "Times (N,) and poses T_world_camera (N, 4, 4) of the scan, float64.")
      .def(
          "level_surfaces",
          [](const Map& map, double min_area_m2) {
            return without_gil([&] { return level_surfaces(map.saved.mesh, min_area_m2); });
          },
          py::kw_only(), py::arg("min_area_m2") = 0.05,
          "Returns floor, table tops and the like, largest first.")
      .def("unknown_surface", &unknown_mesh_of,
           "Returns the frontier between observed free space and unknown space as a mesh.")
      .def_property_readonly("coverage_png",
                             [](const Map& map) {
                               return py::bytes(reinterpret_cast<const char*>(map.saved.coverage_png.data()),
                                                map.saved.coverage_png.size());
                             })
      .def("save", &save, py::arg("folder"), "Saves the map atomically. The folder is new or holds a map.")
      .def("__repr__", [](const Map& map) {
        return text_of("<roomradar.Map " + (map.folder.empty() ? "in memory" : map.folder) + ": " +
                       std::to_string(map.saved.mesh.triangles.size()) + " triangles>");
      });
}

void bind_map_functions(py::module_& module) {
  module.def("open_map", &open_map, py::arg("folder"), "Reads a map, and verifies its files.");
  module.def(
      "map_info", [](const std::filesystem::path& folder) { return dict_of(load_map_info(folder)); },
      py::arg("folder"), "Reads only map.json, as a dict.");
  module.def(
      "verify_map",
      [](const std::filesystem::path& folder) {
        py::list faults;
        for (const std::string& fault : without_gil([&] { return verify_map(folder); }))
          faults.append(text_of(fault));
        return faults;
      },
      py::arg("folder"), "Returns a sentence per fault of a map's files; empty: the map is sound.");
  module.def("export_map", &export_to, py::arg("folder"), py::arg("path"),
             "Writes a map as .glb .obj .ply .stl (mesh), .ot .bt (octree) or .html (page).");
  module.def("merge_maps", &merge, py::arg("a"), py::arg("b"),
             "Returns the map of both scans of one room, in the world of a. Raises Error if they cannot be "
             "registered.");
  module.def("diff_maps", &diff, py::arg("a"), py::arg("b"),
             "Returns what appeared in b or vanished since a, largest first.");
  module.def(
      "register_maps",
      [](const Map& a, const Map& b) {
        return array_of(without_gil([&] { return registered(a, b); }).T_a_b);
      },
      py::arg("a"), py::arg("b"), "Returns T_a_b, (4, 4) float64, which maps points of b's world to a's.");
}

}  // namespace

void bind_maps(py::module_& module) {
  bind_parts(module);
  bind_map(module);
  bind_map_functions(module);
}

}  // namespace roomradar::python
