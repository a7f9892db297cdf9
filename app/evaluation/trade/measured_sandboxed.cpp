// measured_sandboxed.cpp: sends the figures' bytes from the child process through a pipe.
#include "app/evaluation/trade/measured_sandboxed.hpp"

#include <algorithm>
#include <cstring>

#include "app/cli/report.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/process_memory.hpp"
#include "mapping/types/system/run_sandboxed.hpp"

namespace roomradar {

Readings measured_sandboxed(const std::string& what, const std::function<Readings()>& work) {
  constexpr unsigned kMost_s = 3600;                          // CPU time; hours would not be a measurement
  constexpr std::size_t kMost_bytes = std::size_t{1} << 38U;  // address space, of which GL drivers take a lot
  const auto bytes_of_figures = [&] {
    const Readings figures = work();
    std::string bytes(figures.size() * sizeof(double), '\0');
    std::memcpy(bytes.data(), figures.data(), bytes.size());
    return bytes;
  };
  release_unused_memory();  // the child's peak starts at this process's memory
  const std::string bytes =
      run_sandboxed(bytes_of_figures, what + ": could not be measured", kMost_s, kMost_bytes);
  Readings figures(bytes.size() / sizeof(double));
  std::memcpy(figures.data(), bytes.data(), figures.size() * sizeof(double));
  return figures;
}

double peak_growth_mb(std::size_t start_bytes) {
  return std::max(0.0, peak_rss_mb() - static_cast<double>(start_bytes) / 1e6);
}

}  // namespace roomradar
