// locator.hpp: Python bindings of localisation in a saved map.
#pragma once
#include <pybind11/pybind11.h>

namespace roomradar::python {

/// Call after bind_maps().
void bind_locator(pybind11::module_& module);

}  // namespace roomradar::python
