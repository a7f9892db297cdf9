// simulator.cpp: simulated frames, their truth, and recordings of them.
#include <memory>
#include <string>

#include "app/python/arrays.hpp"
#include "app/python/bindings.hpp"
#include "app/python/long_calls.hpp"
#include "app/python/sources.hpp"
#include "app/sim/room/room.hpp"
#include "app/sim/room/room_mesh.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "app/sim/simulate.hpp"
#include "mapping/map/map_files.hpp"

namespace roomradar::python {
namespace {

class Simulator final : public Source {
 public:
  explicit Simulator(const std::string& spec)
      : Simulator(std::make_unique<SimulatedSource>(parse_sim_spec(required_text(spec, "spec")))) {}

  std::shared_ptr<SimTruth> truth() {
    const UseFlag::Lock lock(use(), "the source");
    static_cast<void>(opened());
    return std::make_shared<SimTruth>(simulated_.truth());
  }
  std::shared_ptr<Frame> look(std::int64_t index, const py::object& T_world_camera) {
    const Eigen::Isometry3d T = pose_of(T_world_camera, "T_world_camera");
    const UseFlag::Lock lock(use(), "the source");
    static_cast<void>(opened());
    if (index < 0 || index >= *simulated_.frame_count())
      throw py::index_error("frame " + std::to_string(index) + " of " +
                            std::to_string(*simulated_.frame_count()));
    auto frame = std::make_shared<Frame>();
    without_gil([&] { simulated_.look(index, T, *frame); });
    return frame;
  }
  std::shared_ptr<Mesh> mesh() {
    const UseFlag::Lock lock(use(), "the source");
    static_cast<void>(opened());
    return without_gil([&] { return std::make_shared<Mesh>(room_mesh(simulated_.room())); });
  }

 private:
  explicit Simulator(std::unique_ptr<SimulatedSource> source)
      : Source(std::move(source)), simulated_(dynamic_cast<SimulatedSource&>(opened())) {}

  SimulatedSource& simulated_;  ///< valid until close()
};

RecordingFormat format_of(const std::string& name) {
  for (const RecordingFormat format : {RecordingFormat::kTum, RecordingFormat::kSevenScenes,
                                       RecordingFormat::kFakenect, RecordingFormat::kRosBag})
    if (to_string(format) == name) return format;
  throw py::value_error("format: is \"" + required_text(name, "format") +
                        "\"; must be tum, 7scenes, fakenect or rosbag");
}

void simulate_into(const std::filesystem::path& folder, const std::string& spec, const std::string& format,
                   const py::object& progress) {
  require_callback(progress, "progress");
  const RecordingFormat its_format = format_of(format);
  const SimOptions options = parse_sim_spec(required_text(spec, "spec"));
  require_contents_outside_maps(folder);
  without_gil([&] {
    simulate(folder, options, its_format,
             [&](std::int64_t done, std::int64_t total) { report_progress(progress, done, total); });
  });
}

template <MaskImage SimTruth::*mask>
py::array mask_view(const py::object& self) {
  return view_of(self.cast<const SimTruth&>().*mask, self);
}

}  // namespace

void bind_simulator(py::module_& module) {
  py::class_<SimTruth, std::shared_ptr<SimTruth>>(module, "SimTruth",
                                                  "Ground truth of a simulated frame. Arrays are views.")
      .def_property_readonly(
          "depth_m",
          [](const py::object& self) { return view_of(self.cast<const SimTruth&>().depth_m, self); },
          "(H, W) float32: exact depth, m; 0 outside the sensor's range.")
      .def_property_readonly("moved", &mask_view<&SimTruth::moved>,
                             "(H, W) uint8: 255 where the nearest surface is a moving object.")
      .def_property_readonly("mover", &mask_view<&SimTruth::mover>,
                             "(H, W) uint8: 0 for the room, else the number of the moving object, from 1.")
      .def_property_readonly("revealed", &mask_view<&SimTruth::revealed>,
                             "(H, W) uint8: 255 where a crate that has gone would be the nearest surface.")
      .def_property_readonly(
          "T_world_camera", [](const SimTruth& truth) { return array_of(truth.T_world_camera); },
          "(4, 4) float64: exact pose of the depth camera.");

  py::class_<Simulator, Source>(module, "Simulator",
                                "A simulated Kinect in a simulated room, with the truth of each frame. Its "
                                "world has z up, the floor at z = 0.")
      .def(py::init([](const std::string& spec) {
             return without_gil([&] { return std::make_unique<Simulator>(spec); });
           }),
           py::arg("spec"),
           "spec: \"sim:ROOM?key=value&...\", as on the command line; see `roomradar help sources`.")
      .def_property_readonly("truth", method(&Simulator::truth), "SimTruth of the frame that was read last.")
      .def("look", method(&Simulator::look), py::arg("index"), py::arg("T_world_camera"),
           "Returns a frame from another pose at the time of frame `index`. The order of frames is "
           "unaffected.")
      .def("room_mesh", method(&Simulator::mesh),
           "Returns the exact surface of the room, without moving objects.");

  module.def("simulate", &simulate_into, py::arg("folder"), py::arg("spec"), py::kw_only(),
             py::arg("format") = "tum", py::arg("progress") = py::none(),
             "Writes a simulated recording with its ground truth into a new or empty folder.\n\n"
             "format: tum, 7scenes, fakenect or rosbag\n"
             "progress: called with the number of finished frames and the total");
}

}  // namespace roomradar::python
