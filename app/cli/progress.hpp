// progress.hpp: displays the progress of long work on stderr.
#pragma once
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace roomradar {

/// Content of a progress line.
struct ProgressState {
  /// Name of the work, for example "track" or "fuse".
  std::string what;
  /// Number of finished steps.
  std::int64_t done = 0;
  /// Total number of steps; unset if unknown.
  std::optional<std::int64_t> total;
  /// Recent steps per second; 0 if not measured so far.
  double per_s = 0.0;
  /// Text after the count, for example "tracked; 12.4 m2 seen".
  std::string note;
  /// True if the work has ended, even if done < total.
  bool is_over = false;
};

/// Returns the line, for example "track [######      ] 120/300, 24.1/s, 0:07 left, tracked; 12.4 m2 seen".
/// Bar and remaining time appear only if the total is known, and the bar only if requested.
std::string progress_line(const ProgressState& state, bool with_bar);

/// Shows a progress line on stderr. Redraws it in place if stderr is a terminal; otherwise prints a line
/// every few seconds.
class Progress {
 public:
  Progress(std::string what, std::optional<std::int64_t> total);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Ends the line that is redrawn.
  ~Progress();

  /// Counts one finished step.
  /// @param note  shown after the count, for example "tracked" or "lost"
  void step(const std::string& note = {});

 private:
  using Time = std::chrono::steady_clock::time_point;
  void show(bool last);

  ProgressState state_;
  bool is_terminal_;
  Time started_;
  Time shown_;
  /// Start of the interval over which the rate is measured.
  Time counted_;
  /// Number of finished steps at the start of that interval.
  std::int64_t counted_from_ = 0;
};

}  // namespace roomradar
