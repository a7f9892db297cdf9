// line_stream.hpp: sends text lines to another program, which may read them slowly or not at all.
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace roomradar {

/// Writes lines to a file, a named pipe or standard output, on a thread of its own. A slow reader never
/// delays the caller. At most kMaxWaiting lines are queued. Further lines are dropped and counted.
class LineStream {
 public:
  static constexpr std::size_t kMaxWaiting = 256;

  /// Opens the file, and replaces its content if it is a regular file. A named pipe need not have a reader.
  /// "-" is standard output. All other output of the program to standard output is then redirected to
  /// standard error. Throws Error naming the file if it cannot be opened.
  explicit LineStream(std::filesystem::path path);
  /// Ends the thread and discards queued lines.
  ~LineStream();
  LineStream(const LineStream&) = delete;
  LineStream& operator=(const LineStream&) = delete;

  /// Returns a line, without its end of line. Called on the stream's thread.
  using MakeLine = std::function<std::string()>;
  /// Queues a line. Returns false if the line was dropped, because the queue is full, the reader has closed
  /// its end, or writing has failed.
  bool offer(MakeLine line);
  bool offer(std::string line);
  /// Returns how many times offer() dropped a line.
  [[nodiscard]] std::int64_t dropped() const { return dropped_; }
  /// Returns true if the reader has closed its end.
  [[nodiscard]] bool is_reader_gone() const { return is_reader_gone_; }
  /// Writes the queued lines. Stops if the reader reads nothing for a second. Throws Error naming the file if
  /// a regular file could not be written. Later calls of offer() drop their lines.
  void close();

 private:
  std::filesystem::path path_;
  int file_ = -1;
  bool is_closing_ = false, is_stopping_ = false;  ///< both guarded by mutex_
  std::deque<MakeLine> waiting_;                   ///< guarded by mutex_
  std::mutex mutex_;
  std::condition_variable changed_;
  std::atomic<std::int64_t> dropped_ = 0;
  std::atomic<bool> is_reader_gone_ = false;
  std::atomic<int> fault_ = 0;  ///< errno of a failed write
  std::thread thread_;          ///< declared last because it uses the members above

  void serve();
  bool write(const std::string& text);
  /// Waits until the file accepts bytes, and returns true. Returns false if the stream must stop first.
  bool wait_until_writable();
  void stop();
};

}  // namespace roomradar
