// octree.cpp: fusion into octrees; their occupancy and leaves as NumPy arrays.
#include "app/python/octree.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/python/arrays.hpp"
#include "app/python/bindings.hpp"
#include "app/python/long_calls.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "mapping/surface/unknown/unknown_surface.hpp"

namespace roomradar::python {

StaticMap& Octree::changeable() const {
  if (changing_ == nullptr)
    throw Error("the octree of a saved map does not change; fuse frames into a StaticMap of your own");
  return *changing_;
}

py::object occupancy_of(const Octree& octree, const py::object& points_world) {
  const py::array points = required_array<double>(points_world, "points_world", {{-1, 3}, "(N, 3)"});
  const auto count = static_cast<std::size_t>(points.shape(0));
  py::array_t<std::uint8_t> occupancy(points.shape(0));
  const auto* from = static_cast<const double*>(points.data());
  std::uint8_t* to = occupancy.mutable_data();
  octree.read([&](const StaticMap& map) {
    for (std::size_t i = 0; i < count; ++i)
      to[i] = static_cast<std::uint8_t>(map.occupancy_at(Eigen::Map<const Eigen::Vector3d>(from + 3 * i)));
  });
  return occupancy;
}

namespace {

std::string fuse(Octree& octree, const Frame& frame, const py::object& T_world_camera) {
  std::optional<Eigen::Isometry3d> T = optional_pose_of(T_world_camera, "T_world_camera");
  if (!T) T = frame.T_world_camera;
  if (!T) throw py::value_error("T_world_camera: is missing, and the frame has no pose");
  return std::string(to_string(octree.change([&](StaticMap& map) { return map.fuse(frame, *T); })));
}

template <typename Element>
py::array column(const std::vector<Element>& values, py::ssize_t width = 1) {
  const auto rows = static_cast<py::ssize_t>(values.size()) / width;
  if (width == 1) return py::array_t<Element>(rows, values.data());
  return py::array_t<Element>(std::vector<py::ssize_t>{rows, width}, values.data());
}

py::dict samples_of(const Octree& octree) {
  std::vector<std::int32_t> voxel;
  std::vector<float> distance_m, weight;
  std::vector<std::uint8_t> colour, has_colour, occupancy;
  octree.read([&](const StaticMap& map) {
    map.visit_samples([&](const SurfaceSample& sample) {
      voxel.insert(voxel.end(), sample.voxel.begin(), sample.voxel.end());
      distance_m.push_back(sample.distance_m);
      weight.push_back(sample.weight);
      colour.insert(colour.end(), {sample.colour.r, sample.colour.g, sample.colour.b});
      has_colour.push_back(sample.has_colour ? 1 : 0);
      occupancy.push_back(static_cast<std::uint8_t>(sample.occupancy));
    });
  });
  py::dict samples;
  samples["voxel"] = column(voxel, 3);
  samples["distance_m"] = column(distance_m);
  samples["weight"] = column(weight);
  samples["colour"] = column(colour, 3);
  samples["has_colour"] = column(has_colour).attr("view")(py::dtype::of<bool>());
  samples["occupancy"] = column(occupancy);
  return samples;
}

py::dict leaves_of(const Octree& octree) {
  std::vector<std::int32_t> lowest_voxel, edge_voxels;
  std::vector<float> log_odds;
  octree.read([&](const StaticMap& map) {
    map.visit_leaves([&](const MapLeaf& leaf) {
      lowest_voxel.insert(lowest_voxel.end(), leaf.lowest_voxel.begin(), leaf.lowest_voxel.end());
      edge_voxels.push_back(leaf.edge_voxels);
      log_odds.push_back(leaf.log_odds);
    });
  });
  py::dict leaves;
  leaves["lowest_voxel"] = column(lowest_voxel, 3);
  leaves["edge_voxels"] = column(edge_voxels);
  leaves["log_odds"] = column(log_odds);
  return leaves;
}

py::dict counts_of(const Octree& octree) {
  const MapCounts counts = octree.read([](const StaticMap& map) { return map.counts(); });
  py::dict dict;
  dict["occupied_leaves"] = counts.occupied_leaves;
  dict["free_leaves"] = counts.free_leaves;
  dict["sampled_leaves"] = counts.sampled_leaves;
  dict["nodes"] = counts.nodes;
  dict["memory_bytes"] = counts.memory_bytes;
  dict["known_world"] = counts.known_world.isEmpty() ? py::object(py::none()) : array_of(counts.known_world);
  return dict;
}

std::shared_ptr<Mesh> surface_of(const Octree& octree, double deviation_m) {
  SurfaceConfig config;
  config.max_deviation_m = static_cast<float>(deviation_m);
  return octree.read(
      [&](const StaticMap& map) { return std::make_shared<Mesh>(extract_surface(map, config)); });
}

/// Writes the octree in the format that the extension names.
void write(const Octree& octree, const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  octree.read([&](const StaticMap& map) {
    if (extension == ".ot") return map.write_ot(path);
    if (extension == ".bt") return map.write_bt(path);
    if (extension == ".bin") return map.write(path);
    throw Error(path.string() + ": the extension must be .bin (complete), .ot or .bt (of OctoMap)");
  });
}

std::shared_ptr<Octree> read(const std::filesystem::path& path) {
  const pybind11::gil_scoped_release release;
  return std::make_shared<Octree>(path.extension() == ".ot" ? StaticMap::read_ot(path)
                                                            : StaticMap::read(path));
}

std::shared_ptr<Octree> make_octree(double resolution_m, double max_range_m, int threads) {
  FusionConfig config;
  config.max_range_m = static_cast<float>(max_range_m);
  config.threads = threads;
  return std::make_shared<Octree>(StaticMap(resolution_m, config));
}

}  // namespace

void bind_octree(py::module_& module) {
  py::enum_<Occupancy>(module, "Occupancy", py::arithmetic(), "Values of occupancy arrays.")
      .value("UNKNOWN", Occupancy::kUnknown)
      .value("FREE", Occupancy::kFree)
      .value("OCCUPIED", Occupancy::kOccupied);

  py::class_<Octree, std::shared_ptr<Octree>>(
      module, "StaticMap",
      "Octree of a static room: occupancy and, near surfaces, signed distance. The lower corner of voxel i "
      "is at\n"
      "i * resolution_m in the world. Calls on several threads wait for each other where they must.")
      .def(py::init(&make_octree), py::arg("resolution_m"), py::kw_only(),
           py::arg("max_range_m") = static_cast<double>(FusionConfig{}.max_range_m), py::arg("threads") = 0,
           "max_range_m: greatest depth that is fused as a surface\n"
           "threads: 1 to 8; 0: one per core. The result does not depend on it.")
      .def("fuse", &fuse, py::arg("frame"), py::arg("T_world_camera") = py::none(),
           "Fuses one frame at a pose (4, 4) float64; None: the frame's own. Returns \"fused\", or why the "
           "map is\n"
           "unchanged.")
      .def("occupancy", &occupancy_of, py::arg("points_world"),
           "Returns the occupancy at points (N, 3) float64 as (N,) uint8: 0 unknown, 1 free, 2 occupied.")
      .def(
          "surface", &surface_of, py::kw_only(),
          py::arg("deviation_m") = static_cast<double>(SurfaceConfig{}.max_deviation_m),
          "Extracts the surface. deviation_m: max distance of the simplified mesh from the full one; 0: not\n"
          "simplified.")
      .def(
          "samples", &samples_of,
          "Returns arrays of all voxels with a signed distance: voxel (N, 3) int32, distance_m, weight (N,)\n"
          "float32, colour (N, 3) uint8, has_colour (N,) bool, occupancy (N,) uint8.")
      .def("leaves", &leaves_of,
           "Returns arrays of all free and occupied leaves: lowest_voxel (N, 3) int32, edge_voxels (N,) "
           "int32,\n"
           "log_odds (N,) float32.")
      .def("counts", &counts_of, "Returns numbers of leaves and nodes, memory, and the box of known space.")
      .def("write", &write, py::arg("path"), "Writes .bin (complete), or OctoMap's .ot or .bt.")
      .def_static("read", &read, py::arg("path"), "Reads what write() has written as .bin or .ot.")
      .def_property_readonly("resolution_m", [](const Octree& octree) {
        return octree.read([](const StaticMap& map) { return map.resolution_m(); });
      });
}

}  // namespace roomradar::python
