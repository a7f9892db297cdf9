// trade_csv.hpp: appends each measurement of a sweep to a CSV file immediately.
#pragma once
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "app/evaluation/pareto/choose_presets.hpp"

namespace roomradar {

/// Returns `text` as a CSV field (RFC 4180), quoted if it contains a comma, a quote or a line break.
std::string csv_field(const std::string& text);

/// CSV file with one header for all works. Fields that do not apply to a work are empty.
class TradeCsv {
 public:
  /// Writes nothing if `path` is empty. An existing file may contain hours of measurements. It is overwritten
  /// only when the first line is written.
  TradeCsv(const std::filesystem::path& path, const std::vector<MeasuredWork>& works);

  /// Writes and flushes one measurement. Throws Error if the file cannot be written.
  void write(const MeasuredWork& work, const std::vector<Setting>& settings, const SweepRow& row);
  /// Writes a line per setting with the summary of its measurements and its loss. The line also states if the
  /// setting is the default, a preset or on the front.
  void write(const MeasuredWork& work, const std::vector<SettingSummary>& summaries, std::size_t defaults,
             const PresetChoice& choice);

 private:
  void open();
  void write_line(const std::vector<std::string>& start, const MeasuredWork& work, const Setting& setting,
                  const Readings& figures);

  std::filesystem::path path_;
  std::ofstream file_;
  std::vector<std::string> parameters_, figures_;  ///< names of all works, without duplicates
};

}  // namespace roomradar
