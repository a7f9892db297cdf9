// report.cpp: assembles and writes a command's report.
#include "app/cli/report.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <string>
#include <system_error>

#include "mapping/map/map_folder.hpp"
#include "mapping/types/system/atomic_file.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/version.hpp"

namespace roomradar {

double process_cpu_ms() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto ms = [](const timeval& t) {
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_usec);
  };
  return ms(usage.ru_utime) + ms(usage.ru_stime);
}

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6;  // ru_maxrss is in KiB on Linux
}

nlohmann::json to_json(const Eigen::Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }

nlohmann::json to_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

nlohmann::json to_json(const Report& report) {
  nlohmann::json stages = nlohmann::json::object();
  for (const auto& [stage, s] : report.times.summaries()) {
    stages[stage] = {{"count", s.count},
                     {"median_ms", s.median_ms},
                     {"p95_ms", s.p95_ms},
                     {"p99_ms", s.p99_ms},
                     {"max_ms", s.max_ms}};
  }
  nlohmann::json json = {
      {"command", report.command},
      {"version", kVersion},
      {"source", report.source},
      {"settings", report.settings},
      {"renderer", report.renderer},
      {"frames_read", report.frames_read},
      {"frames_skipped", report.frames_skipped},
      {"stages", stages},
      {"peak_rss_mb", peak_rss_mb()},
      {"wall_s", report.seconds()},
  };
  json.update(report.results);
  return json;
}

void require_writable(const std::filesystem::path& path) {
  if (path.empty()) return;
  std::error_code fault;
  const bool is_pipe_or_device = std::filesystem::is_other(path, fault);
  if (is_pipe_or_device && access(path.c_str(), W_OK) == 0) return;
  if (const std::string why = why_not_writable(path); !why.empty())
    throw Error(path.string() + ": cannot be written: " + why);
  require_outside_maps(path);
}

void write_report(const Report& report, const std::filesystem::path& path) {
  if (path.empty()) return;
  AtomicFile file(path);
  // File names need not be valid UTF-8, but JSON must be.
  file.stream() << to_json(report).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
  file.commit();
}

}  // namespace roomradar
