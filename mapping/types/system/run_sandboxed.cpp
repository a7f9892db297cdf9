// run_sandboxed.cpp: fork, resource limits, and a pipe for the result.
#include "mapping/types/system/run_sandboxed.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <clocale>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <locale>
#include <optional>
#include <string_view>
#include <utility>

#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr char kAnswer = 'a', kError = 'e';
// Sanitizers reserve most of the address space, so no limit fits.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kMemoryCanBeLimited = false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kMemoryCanBeLimited = false;
#else
constexpr bool kMemoryCanBeLimited = true;
#endif
#else
constexpr bool kMemoryCanBeLimited = true;
#endif

void write_all(int to, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(to, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return;  // the reading end is closed
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

/// Start of an answer: its kind, and the number of bytes that follow.
struct Head {
  char kind;
  std::uint64_t size_bytes;

  [[nodiscard]] std::string bytes() const {
    std::string all(1, kind);
    return all.append(reinterpret_cast<const char*>(&size_bytes), sizeof size_bytes);
  }
  static constexpr std::size_t kBytes = 1 + sizeof(std::uint64_t);
};

bool is_whole(std::string_view answer) {
  if (answer.size() < Head::kBytes) return false;
  std::uint64_t size_bytes = 0;
  std::memcpy(&size_bytes, answer.data() + 1, sizeof size_bytes);
  return answer.size() - Head::kBytes >= size_bytes;
}

/// Returns an answer, or the bytes received until the pipe was closed; nullopt if this takes longer than
/// most_s. Does not wait for the pipe to close, because another thread's child may also have it open.
std::optional<std::string> read_answer(int from, std::chrono::seconds most_s) {
  const auto end = std::chrono::steady_clock::now() + most_s;
  std::string bytes;
  std::array<char, 1U << 16U> buffer;
  for (;;) {
    const auto left_ms =
        std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now()).count();
    pollfd ready{from, POLLIN, 0};
    const int polled = left_ms > 0 ? ::poll(&ready, 1, static_cast<int>(left_ms)) : 0;
    if (polled < 0 && errno == EINTR) continue;
    if (polled <= 0) return std::nullopt;
    const ssize_t count = ::read(from, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return bytes;
    bytes.append(buffer.data(), static_cast<std::size_t>(count));
    if (is_whole(bytes)) return bytes;
  }
}

/// Address space in use by this process.
std::size_t taken_bytes() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

[[noreturn]] void be_child(const std::function<std::string()>& work, int to, unsigned most_s,
                           std::size_t max_bytes, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // otherwise an orphan would never be ended
  if (::getppid() != parent) _exit(1);
  std::setlocale(LC_ALL, "C");  // libraries that read numbers would otherwise use the host program's locale
  std::locale::global(std::locale::classic());
  for (const int number : {SIGINT, SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL}) std::signal(number, SIG_DFL);
  const int nowhere = ::open("/dev/null", O_WRONLY);  // discards output of `work`
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  const rlimit no_core{0, 0}, time{most_s, most_s};
  setrlimit(RLIMIT_CORE, &no_core);
  setrlimit(RLIMIT_CPU, &time);
  if (const std::size_t taken = taken_bytes(); kMemoryCanBeLimited && taken > 0) {
    const rlimit memory{taken + max_bytes, taken + max_bytes};
    setrlimit(RLIMIT_AS, &memory);
  }
  try {
    const std::string answer = work();
    write_all(to, Head{kAnswer, answer.size()}.bytes());
    write_all(to, answer);
  } catch (const Error& error) {
    const std::string_view sentence = error.what();
    write_all(to, Head{kError, sentence.size()}.bytes());
    write_all(to, sentence);
  } catch (...) {
    _exit(1);  // most likely out of memory
  }
  _exit(0);  // skips the parent's exit handlers
}

}  // namespace

std::string run_sandboxed(const std::function<std::string()>& work, const std::string& complaint,
                          unsigned most_s, std::size_t max_bytes) {
  const auto fail = [&](const std::string& reason) { throw Error(complaint + " (" + reason + ")"); };
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) fail("no pipe can be made: " + system_reason(errno));
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ends[0]);
    be_child(work, ends[1], most_s, max_bytes, parent);
  }
  const int fork_fault = errno;
  ::close(ends[1]);
  // A waiting child uses no processor time, and on a busy machine a second of processor time takes longer.
  constexpr unsigned kWallPerProcessor = 10;
  std::optional<std::string> read =
      child > 0 ? read_answer(ends[0], std::chrono::seconds(kWallPerProcessor * most_s)) : std::string{};
  if (!read) ::kill(child, SIGKILL);
  std::string answer = std::move(read).value_or(std::string{});
  ::close(ends[0]);
  if (child < 0) fail("no process can be started: " + system_reason(fork_fault));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    const bool took_long = signal == SIGXCPU || signal == SIGKILL;  // the OOM killer sends SIGKILL, too
    fail(took_long ? "it takes more than " + std::to_string(most_s) + " s, or too much memory"
                   : std::string("crashed: ") + strsignal(signal));
  }
  if (status != 0 || !is_whole(answer)) fail("it takes more memory than it is allowed");
  const bool is_answer = answer.front() == kAnswer;
  answer.erase(0, Head::kBytes);
  if (!is_answer) throw Error(answer);
  return answer;
}

}  // namespace roomradar
