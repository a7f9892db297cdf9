// long_calls.cpp: signals and callbacks.
#include "app/python/long_calls.hpp"

namespace roomradar::python {

void throw_if_interrupted() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

void require_callback(const py::object& value, const char* name) {
  if (!value.is_none() && PyCallable_Check(value.ptr()) == 0)
    throw py::type_error(std::string(name) + ": must be a function or None");
}

}  // namespace roomradar::python
