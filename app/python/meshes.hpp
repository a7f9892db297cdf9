// meshes.hpp: Python bindings of triangle meshes.
#pragma once
#include <pybind11/pybind11.h>

namespace roomradar::python {

void bind_meshes(pybind11::module_& module);

}  // namespace roomradar::python
