// locator.hpp: finding the camera in a saved map, in Python.
#pragma once
#include <pybind11/pybind11.h>

namespace roomradar::python {

/// Call after bind_maps().
void bind_locator(pybind11::module_& module);

}  // namespace roomradar::python
