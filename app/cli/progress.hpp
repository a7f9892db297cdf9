// progress.hpp: displays the progress of long operations on stderr.
#pragma once
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace roomradar {

/// Content of a progress line.
struct ProgressState {
  /// Name of the operation, such as "track" or "fuse".
  std::string what;
  /// Number of finished steps.
  std::int64_t done = 0;
  /// Total number of steps; unset if unknown.
  std::optional<std::int64_t> total;
  /// Recent steps per second; 0 if not measured so far.
  double per_s = 0.0;
  /// Text after the count, such as "tracked; 12.4 m2 seen".
  std::string note;
  /// Remaining time, s; < 0: unknown.
  double left_s = -1.0;
};

/// Returns a line such as "track [###### ] 120/300, 24.1/s, 0:07 left, tracked; 12.4 m2 seen". The bar
/// appears only if the total is known and with_bar is true.
std::string progress_line(const ProgressState& state, bool with_bar);

/// Speed of an operation, averaged over about the last 15 s, or over the last quarter of its time if that is
/// longer, so that a few slow or fast steps hardly affect the remaining time.
class SmoothRate {
 public:
  /// Adds a number of steps that together took `seconds`.
  void add(double steps, double seconds);
  /// Returns steps per second; 0 before the first call with seconds > 0.
  [[nodiscard]] double per_s() const { return seconds_ > 0.0 ? steps_ / seconds_ : 0.0; }

 private:
  double steps_ = 0.0, seconds_ = 0.0;  ///< sums with weights that decay with age
  double total_s_ = 0.0;
};

/// Remaining time of an operation, smoothed so that it does not jump with the speed. Counts down between
/// estimates. The logarithm of the remaining time follows that of the estimates by exponential smoothing. The
/// time constant is the least of 15 s, the estimate and the shown time, but at least 1 s.
class SmoothRemaining {
 public:
  /// @param estimate_s  remaining steps divided by the recent speed, s
  /// @param passed_s    time since the last call, s
  /// @return remaining time to show, s
  double add(double estimate_s, double passed_s);

 private:
  double left_s_ = -1.0;  ///< < 0: no estimate so far
};

/// Shows a progress line on stderr. Redraws it in place if stderr is a terminal. Otherwise prints a line
/// every few seconds.
class Progress {
 public:
  Progress(std::string what, std::optional<std::int64_t> total);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Ends the line on the terminal.
  ~Progress();

  /// Counts one finished step.
  /// @param note  text after the count, such as "tracked" or "lost"
  void step(const std::string& note = {});

 private:
  using Time = std::chrono::steady_clock::time_point;
  void show(bool last);
  /// Returns true if enough steps are done to estimate the remaining time.
  [[nodiscard]] bool is_foreseeable() const;

  ProgressState state_;
  bool is_terminal_;
  Time started_;
  Time shown_;
  std::int64_t shown_done_ = 0;  ///< number of finished steps when the line was last shown
  SmoothRate rate_;
  SmoothRemaining remaining_;
};

}  // namespace roomradar
