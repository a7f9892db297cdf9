// gl_thread.hpp: a thread for one OpenGL context, for callers on any thread.
#pragma once
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace roomradar {

/// Owns a thread that makes all calls of one OpenGL context. The callers' own contexts are never touched.
/// Calls from several threads are serialised.
class GlThread {
 public:
  GlThread();
  ~GlThread();
  GlThread(const GlThread&) = delete;
  GlThread& operator=(const GlThread&) = delete;

  /// Calls work() on the thread, waits for it, and rethrows its exception. Must not be called from inside
  /// `work`.
  void run(const std::function<void()>& work);

 private:
  std::mutex callers_;  ///< held by the caller whose work is running
  std::mutex mutex_;    ///< guards the members below
  std::condition_variable changed_;
  const std::function<void()>* work_ = nullptr;  ///< null: nothing to do
  std::exception_ptr fault_;
  bool is_stopping_ = false;
  std::thread thread_;  ///< declared last because it uses the members above

  void serve();
};

}  // namespace roomradar
