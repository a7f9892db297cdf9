// progress.hpp: how far a long piece of work is, on stderr.
#pragma once
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace roomradar {

/// What a line of progress shows.
struct ProgressState {
  std::string what;                   ///< "track", "fuse": what the user waits for
  std::int64_t done = 0;              ///< steps
  std::optional<std::int64_t> total;  ///< where known
  double per_s = 0.0;                 ///< steps a second, of late; 0: not known yet
  std::string note;                   ///< "tracked; 12.4 m2 seen"
  bool is_over = false;               ///< no more is to come, whatever the total was
};

/// "track [######      ] 120/300, 24.1/s, 0:07 left, tracked; 12.4 m2 seen". The bar only if asked for, and
/// only where the total is known, as is the time left.
std::string progress_line(const ProgressState& state, bool with_bar);

/// A bar that redraws itself where stderr is a terminal, a line every few seconds where it is not.
class Progress {
 public:
  Progress(std::string what, std::optional<std::int64_t> total);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Ends the line that is being redrawn.
  ~Progress();

  /// One more step is done; `note` is shown behind the count ("tracked", "lost", ...).
  void step(const std::string& note = {});

 private:
  using Time = std::chrono::steady_clock::time_point;
  void show(bool last);

  ProgressState state_;
  bool is_terminal_;
  Time started_;
  Time shown_;
  Time counted_;                   ///< since when steps are counted for the rate
  std::int64_t counted_from_ = 0;  ///< steps that were done then
};

}  // namespace roomradar
