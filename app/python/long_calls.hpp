// long_calls.hpp: long calls without the interpreter's lock (GIL): exclusive use, progress callbacks, Ctrl-C.
#pragma once
#include <pybind11/pybind11.h>

#include <atomic>
#include <string>
#include <utility>

#include "mapping/types/system/error.hpp"

namespace roomradar::python {

namespace py = pybind11;

/// Flag that restricts an object to one call at a time.
class UseFlag {
 public:
  /// Sets the flag until destruction. Throws Error naming the object if another call has set the flag.
  class Lock {
   public:
    Lock(UseFlag& flag, const char* name) : flag_(flag) {
      if (flag_.is_used_.exchange(true))
        throw Error(std::string(name) + " is in use by another thread; wait for that call, or use two");
    }
    ~Lock() { flag_.is_used_ = false; }
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;

   private:
    UseFlag& flag_;
  };

 private:
  std::atomic<bool> is_used_ = false;
};

/// Calls work() without the interpreter's lock. `work` must not use Python objects.
template <typename Work>
decltype(auto) without_gil(Work&& work) {
  const py::gil_scoped_release release;
  return std::forward<Work>(work)();
}

/// Return a member function as a function of an object. Python may call a method with None in place of its
/// object; pybind11 passes a null pointer to members, but rejects None for references.
template <typename Class, typename Result, typename... Arguments>
auto method(Result (Class::*member)(Arguments...)) {
  return [member](Class& self, Arguments... arguments) -> Result {
    return (self.*member)(std::forward<Arguments>(arguments)...);
  };
}
template <typename Class, typename Result, typename... Arguments>
auto method(Result (Class::*member)(Arguments...) const) {
  return [member](const Class& self, Arguments... arguments) -> Result {
    return (self.*member)(std::forward<Arguments>(arguments)...);
  };
}

/// Throws the exception of a pending signal, such as KeyboardInterrupt. Call with the interpreter's lock.
void throw_if_interrupted();

/// Calls progress(arguments...) unless it is None, and throws its exceptions and those of pending signals.
/// Call without the interpreter's lock. Returns false if the callback returned False.
template <typename... Arguments>
bool report_progress(const py::object& progress, const Arguments&... arguments) {
  const py::gil_scoped_acquire acquire;
  throw_if_interrupted();
  return progress.is_none() || !progress(arguments...).is(py::bool_(false));
}

/// Throws TypeError unless the value is None or can be called.
void require_callback(const py::object& value, const char* name);

}  // namespace roomradar::python
