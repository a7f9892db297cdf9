// line_stream.cpp: writes as many bytes as the pipe accepts without blocking.
#include "app/run/line_stream.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <climits>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

Error cannot_be_written(const std::filesystem::path& path, int fault) {
  if (path == "-") return Error("standard output: cannot be written: " + system_reason(fault));
  const std::string known = why_not_writable(path);
  return Error(path.string() + ": cannot be written: " + (known.empty() ? system_reason(fault) : known));
}

/// Returns a second descriptor of standard output, and directs standard output itself to standard error.
int take_standard_output() {
  std::fflush(stdout);
  const int taken = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
  if (taken >= 0) dup2(STDERR_FILENO, STDOUT_FILENO);
  return taken;
}

int open_file(const std::filesystem::path& path) {
  if (path == "-") return take_standard_output();
  // Opened for writing alone, a named pipe would wait for its reader.
  const bool is_pipe = std::filesystem::is_fifo(path);
  return open(path.c_str(), (is_pipe ? O_RDWR : O_WRONLY | O_CREAT | O_TRUNC) | O_CLOEXEC, 0666);
}

}  // namespace

LineStream::LineStream(std::filesystem::path path) : path_(std::move(path)), file_(open_file(path_)) {
  if (file_ < 0) throw cannot_be_written(path_, errno);
  thread_ = std::thread([this] { serve(); });
}

LineStream::~LineStream() {
  stop();
  ::close(file_);
}

bool LineStream::offer(std::string line) {
  return offer(MakeLine([line = std::move(line)] { return line; }));
}

bool LineStream::offer(MakeLine line) {
  {
    const std::lock_guard lock(mutex_);
    if (!is_closing_ && !is_reader_gone_ && fault_ == 0 && waiting_.size() < kMaxWaiting) {
      waiting_.push_back(std::move(line));
      changed_.notify_one();
      return true;
    }
  }
  ++dropped_;
  return false;
}

void LineStream::close() {
  using namespace std::chrono_literals;
  std::unique_lock lock(mutex_);
  is_closing_ = true;
  for (std::size_t left = waiting_.size() + 1; !waiting_.empty() && waiting_.size() < left;) {
    left = waiting_.size();
    changed_.wait_for(lock, 1s, [&] { return waiting_.size() < left; });
  }
  lock.unlock();
  stop();
  if (fault_ != 0) throw cannot_be_written(path_, fault_);
}

void LineStream::stop() {
  {
    const std::lock_guard lock(mutex_);
    is_closing_ = is_stopping_ = true;
    dropped_ += static_cast<std::int64_t>(waiting_.size());
    waiting_.clear();
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void LineStream::serve() {
  sigset_t broken_pipe;  // write() then returns EPIPE instead of ending the program
  sigemptyset(&broken_pipe);
  sigaddset(&broken_pipe, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &broken_pipe, nullptr);
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return is_stopping_ || !waiting_.empty(); });
    if (is_stopping_) return;
    const MakeLine line = waiting_.front();
    lock.unlock();
    const bool is_written = write(line() + '\n');
    lock.lock();
    if (!is_written) {
      dropped_ += static_cast<std::int64_t>(waiting_.size());
      waiting_.clear();
    } else if (!waiting_.empty()) {
      waiting_.pop_front();
    }
    changed_.notify_all();
  }
}

bool LineStream::write(const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    if (!wait_until_writable()) return false;
    // A pipe that poll() calls writable takes PIPE_BUF bytes without waiting.
    const std::size_t piece = std::min<std::size_t>(text.size() - at, PIPE_BUF);
    const ssize_t written = ::write(file_, text.data() + at, piece);
    if (written > 0) at += static_cast<std::size_t>(written);
    if (written >= 0 || errno == EINTR || errno == EAGAIN) continue;
    if (errno == EPIPE)
      is_reader_gone_ = true;
    else
      fault_ = errno;
    return false;
  }
  return true;
}

bool LineStream::wait_until_writable() {
  constexpr int kPoll_ms = 50;
  for (;;) {
    pollfd file{file_, POLLOUT, 0};
    if (poll(&file, 1, kPoll_ms) > 0) return true;  // also if write() will fail
    const std::lock_guard lock(mutex_);
    if (is_stopping_) return false;
  }
}

}  // namespace roomradar
