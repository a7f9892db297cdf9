// long_calls.cpp: signals, callbacks, and work handed to a thread.
#include "app/python/long_calls.hpp"

#include <utility>

namespace roomradar::python {

void throw_if_interrupted() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

void require_callback(const py::object& value, const char* name) {
  if (!value.is_none() && PyCallable_Check(value.ptr()) == 0)
    throw py::type_error(std::string(name) + ": must be a function or None");
}

GlThread::GlThread() : thread_([this] { serve(); }) {}

GlThread::~GlThread() {
  {
    const std::lock_guard lock(mutex_);
    is_stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void GlThread::run(const std::function<void()>& work) {
  const std::lock_guard caller(callers_);
  std::unique_lock lock(mutex_);
  work_ = &work;
  changed_.notify_all();
  changed_.wait(lock, [this] { return work_ == nullptr; });
  if (const std::exception_ptr fault = std::exchange(fault_, nullptr)) std::rethrow_exception(fault);
}

void GlThread::serve() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return work_ != nullptr || is_stopping_; });
    if (work_ == nullptr) return;
    lock.unlock();
    std::exception_ptr fault;
    try {
      (*work_)();
    } catch (...) {
      fault = std::current_exception();
    }
    lock.lock();
    fault_ = fault;
    work_ = nullptr;
    changed_.notify_all();
  }
}

}  // namespace roomradar::python
