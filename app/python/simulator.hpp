// simulator.hpp: Python bindings of the simulated Kinect with its ground truth.
#pragma once
#include <pybind11/pybind11.h>

namespace roomradar::python {

/// Call after bind_sources() and bind_meshes().
void bind_simulator(pybind11::module_& module);

}  // namespace roomradar::python
