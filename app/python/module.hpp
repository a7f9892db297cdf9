// module.hpp: the Python module's classes and functions, in the order of their dependencies.
#pragma once
#include <pybind11/pybind11.h>

namespace roomradar::python {

void bind_module(pybind11::module_& module);

}  // namespace roomradar::python
