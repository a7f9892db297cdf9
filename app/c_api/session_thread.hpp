// session_thread.hpp: a thread that owns an OpenGL context, and does one task at a time for other threads.
// The callers' own contexts (an engine's) are never touched.
#pragma once
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace roomradar::c_api {

/// Owns a thread that sleeps between calls of run(). run() may be called from any thread, by one at a time.
class SessionThread {
 public:
  SessionThread();
  ~SessionThread();
  SessionThread(const SessionThread&) = delete;
  SessionThread& operator=(const SessionThread&) = delete;

  /// Calls work() on the thread, waits for it, and rethrows its exception.
  template <typename Work>
  void run(const Work& work) {
    run_and_wait([](const void* task) { (*static_cast<const Work*>(task))(); }, &work);
  }

 private:
  using Call = void (*)(const void*);
  std::mutex mutex_;
  std::condition_variable changed_;
  Call call_ = nullptr;  ///< null: nothing to do
  const void* task_ = nullptr;
  bool is_done_ = false, stops_ = false;
  std::exception_ptr fault_;
  std::thread thread_;  ///< declared last because it uses the members above

  void run_and_wait(Call call, const void* task);
  void serve();
};

}  // namespace roomradar::c_api
