// progress.hpp: displays the progress of long work on stderr.
#pragma once
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace roomradar {

/// Content of a progress line.
struct ProgressState {
  std::string what;                   ///< name of the work: "track", "fuse"
  std::int64_t done = 0;              ///< number of steps
  std::optional<std::int64_t> total;  ///< unset: unknown
  double per_s = 0.0;                 ///< recent steps per second; 0: not measured so far
  std::string note;                   ///< such as "tracked; 12.4 m2 seen"
  bool is_over = false;               ///< finished, even if done < total
};

/// Returns "track [######      ] 120/300, 24.1/s, 0:07 left, tracked; 12.4 m2 seen". Bar and time left appear
/// only if the total is known, and the bar only if requested.
std::string progress_line(const ProgressState& state, bool with_bar);

/// Redraws a bar in place if stderr is a terminal; otherwise prints a line every few seconds.
class Progress {
 public:
  Progress(std::string what, std::optional<std::int64_t> total);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Ends the line being redrawn.
  ~Progress();

  /// Counts one finished step; `note` is shown after the count ("tracked", "lost", ...).
  void step(const std::string& note = {});

 private:
  using Time = std::chrono::steady_clock::time_point;
  void show(bool last);

  ProgressState state_;
  bool is_terminal_;
  Time started_;
  Time shown_;
  Time counted_;                   ///< start of the interval over which the rate is measured
  std::int64_t counted_from_ = 0;  ///< number of steps done at that time
};

}  // namespace roomradar
