// module.cpp: exceptions, and all subjects in order.
#include "app/python/module.hpp"

#include "app/python/frames.hpp"
#include "app/python/locator.hpp"
#include "app/python/maps.hpp"
#include "app/python/meshes.hpp"
#include "app/python/octree.hpp"
#include "app/python/radar.hpp"
#include "app/python/scan.hpp"
#include "app/python/session.hpp"
#include "app/python/session_values.hpp"
#include "app/python/simulator.hpp"
#include "app/python/sources.hpp"
#include "app/session/object_overlap.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/version.hpp"

namespace roomradar::python {

namespace py = pybind11;

void bind_module(py::module_& module) {
  module.attr("__version__") = kVersion;
  const auto& error = py::register_exception<Error>(module, "Error", PyExc_RuntimeError);
  error.doc() = "A failure that a user can repair. The sentence says what failed, where, and what to do.";
  py::register_exception<PlaceRefused>(module, "PlaceRefused", error);
  bind_frames(module);
  bind_sources(module);
  bind_meshes(module);
  bind_simulator(module);
  bind_octree(module);
  bind_maps(module);
  bind_scan(module);
  bind_radar(module);
  bind_locator(module);
  bind_session_values(module);
  bind_session(module);
}

}  // namespace roomradar::python
