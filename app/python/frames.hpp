// frames.hpp: Python bindings of cameras, noise, timing and frames.
#pragma once
#include <pybind11/pybind11.h>

namespace roomradar::python {

void bind_frames(pybind11::module_& module);

}  // namespace roomradar::python
