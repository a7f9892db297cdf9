// session.hpp: Python bindings of sessions of augmented reality in a saved room.
#pragma once
#include <pybind11/pybind11.h>

namespace roomradar::python {

/// Call after bind_maps(), bind_radar() and bind_session_values().
void bind_session(pybind11::module_& module);

}  // namespace roomradar::python
