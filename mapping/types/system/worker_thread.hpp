// second_thread.hpp: one more thread that works beside the caller's for as long as a call lasts.
#pragma once
#include <atomic>
#include <exception>
#include <thread>

namespace roomradar {

/// Owns the thread, which sleeps between calls. Where the machine has one processor there is no thread, and
/// the two pieces of work are done one after the other: whoever splits work must not depend on which. Calls
/// from one thread only, and none from within a call.
class SecondThread {
 public:
  SecondThread();
  ~SecondThread();
  SecondThread(const SecondThread&) = delete;
  SecondThread& operator=(const SecondThread&) = delete;

  /// Calls here() on the caller's thread and beside() on the other; returns when both are done. What either
  /// throws is thrown then, here()'s first.
  template <typename Here, typename Beside>
  void run(const Here& here, const Beside& beside) {
    start([](const void* work) { (*static_cast<const Beside*>(work))(); }, &beside);
    std::exception_ptr fault;
    try {
      here();
    } catch (...) {
      fault = std::current_exception();
    }
    finish();
    if (!fault) fault = fault_;
    if (fault) std::rethrow_exception(fault);
  }

 private:
  enum State : int { kIdle, kWork, kStop };
  using Call = void (*)(const void*);

  std::atomic<int> state_{kIdle};
  Call call_ = nullptr;
  const void* work_ = nullptr;
  std::exception_ptr fault_;  ///< of the last call's beside()
  std::thread thread_;        ///< last: it uses the others

  void start(Call call, const void* work);
  void finish();
  void serve();
  void do_work() noexcept;
};

}  // namespace roomradar
