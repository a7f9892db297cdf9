// interrupt.cpp: a flag set by a signal handler.
#include "app/cli/interrupt.hpp"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <string_view>
#include <utility>

namespace roomradar {
namespace {

enum Asked { kNothing, kToEnd, kEnds };
// Set by the signal handler, taken by the thread that reads the source.
std::atomic<int> asked = kNothing;
static_assert(std::atomic<int>::is_always_lock_free);
constexpr const char* kEndsWithWhatItHas =
    "\nroomradar: reads no more frames and finishes with those so far; press Ctrl-C again to end at once\n";
std::atomic<const char*> said = kEndsWithWhatItHas;
static_assert(std::atomic<const char*>::is_always_lock_free);

std::atomic<const char*> said_when_ended = "";

void print(const char* sentence) {
  const std::string_view text(sentence);
  static_cast<void>(::write(STDERR_FILENO, text.data(), text.size()) + 1);
}

/// Calls only functions that are allowed in a signal handler.
void on_interrupt(int signal) {
  if (asked != kNothing) {
    print(said_when_ended);
    std::signal(signal, SIG_DFL);
    std::raise(signal);
    return;
  }
  asked = kToEnd;
  const int errno_before = errno;
  print(said);
  errno = errno_before;
}

class EndedByInterrupt final : public WrappedSource {
 public:
  explicit EndedByInterrupt(std::unique_ptr<FrameSource> source) : WrappedSource(std::move(source)) {}

  ReadResult next(Frame& frame) override {
    at_end_ = at_end_ || Interrupt::take();
    return at_end_ ? ReadResult{ReadStatus::kEnd, {}} : source_.next(frame);
  }

 private:
  bool at_end_ = false;
};

}  // namespace

Interrupt::Interrupt() {
  asked = kNothing;
  said = kEndsWithWhatItHas;
  said_when_ended = "";
  std::signal(SIGINT, on_interrupt);
}

Interrupt::~Interrupt() { std::signal(SIGINT, SIG_DFL); }

void Interrupt::say(const char* sentence) { said = sentence; }

void Interrupt::say_when_ended(const char* sentence) { said_when_ended = sentence; }

bool Interrupt::take() {
  int to_end = kToEnd;
  return asked.compare_exchange_strong(to_end, kEnds);
}

bool Interrupt::is_asked() { return asked == kToEnd; }

bool Interrupt::was_pressed() { return asked != kNothing; }

std::unique_ptr<FrameSource> ended_by_interrupt(std::unique_ptr<FrameSource> source) {
  return std::make_unique<EndedByInterrupt>(std::move(source));
}

}  // namespace roomradar
