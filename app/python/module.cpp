// module.cpp: binds the exceptions, then all classes and functions in the order of their dependencies.
#include <exception>
#include <string>
#include <utility>

#include "app/python/arrays.hpp"
#include "app/python/bindings.hpp"
#include "app/session/object_overlap.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/version.hpp"

namespace roomradar::python {

namespace {

/// Exception types, which live as long as the process.
PyObject* error_type = nullptr;
PyObject* place_refused_type = nullptr;

void set_error(PyObject* type, const std::string& sentence) {
  PyErr_SetObject(type, text_of(sentence).ptr());
}

void bind_errors(py::module_& module) {
  error_type = PyErr_NewExceptionWithDoc(
      "roomradar.Error",
      "A failure that a user can repair. The sentence says what failed, where, and what to do.",
      PyExc_RuntimeError, nullptr);
  place_refused_type = PyErr_NewExceptionWithDoc(
      "roomradar.PlaceRefused", "An object cannot be placed at the requested pose; its pose is unchanged.",
      error_type, nullptr);
  module.attr("Error") = py::handle(error_type);
  module.attr("PlaceRefused") = py::handle(place_refused_type);
  py::register_exception_translator([](std::exception_ptr fault) {
    try {
      std::rethrow_exception(std::move(fault));
    } catch (const PlaceRefused& refused) {
      set_error(place_refused_type, refused.what());
    } catch (const Error& error) {
      set_error(error_type, error.what());
    }
  });
}

}  // namespace

void bind_module(py::module_& module) {
  module.attr("__version__") = kVersion;
  bind_errors(module);
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
