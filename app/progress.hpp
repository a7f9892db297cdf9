// progress.hpp: how far a long piece of work is, on stderr.
#pragma once
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace roomradar {

/// A bar that redraws itself where stderr is a terminal, a line every few seconds where it is not.
class Progress {
 public:
  /// @param what   "tracking", "fusing": what the user waits for
  /// @param total  steps in all, where known
  Progress(std::string what, std::optional<std::int64_t> total);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Ends the line that is being redrawn.
  ~Progress();

  /// One more step is done; `note` is shown behind the count ("tracked", "lost", ...).
  void step(const std::string& note = {});

 private:
  void show(bool last);

  std::string what_;
  std::optional<std::int64_t> total_;
  std::int64_t done_ = 0;
  std::string note_;
  bool is_terminal_;
  std::chrono::steady_clock::time_point started_;
  std::chrono::steady_clock::time_point shown_;
};

}  // namespace roomradar
