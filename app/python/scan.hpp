// scan.hpp: Python bindings of the prescan.
#pragma once
#include <pybind11/pybind11.h>

namespace roomradar::python {

/// Call after bind_sources() and bind_maps().
void bind_scan(pybind11::module_& module);

}  // namespace roomradar::python
