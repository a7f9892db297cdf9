// trade_csv.hpp: writes a sweep's measurements to a CSV file as they are made.
#pragma once
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "app/evaluation/pareto/choose_presets.hpp"

namespace roomradar {

/// Returns a field as in RFC 4180: quoted if it contains a comma, a quote or a line break.
std::string csv_field(const std::string& text);

/// CSV file with one header for all kinds of work; fields that do not apply are empty.
class TradeCsv {
 public:
  /// Writes nothing if the path is empty. An existing file, possibly hours of work, is overwritten only when
  /// the first line is written.
  TradeCsv(const std::filesystem::path& path, const std::vector<MeasuredWork>& works);

  /// Writes and flushes one measurement. Throws Error if the file cannot be written.
  void write(const MeasuredWork& work, const std::vector<Setting>& settings, const SweepRow& row);
  /// Writes a line per setting: the summary of its measurements, its loss, and whether it is the default, a
  /// preset or on the front.
  void write(const MeasuredWork& work, const std::vector<SettingSummary>& summaries, std::size_t defaults,
             const PresetChoice& choice);

 private:
  void open();
  void write_line(const std::vector<std::string>& start, const MeasuredWork& work, const Setting& setting,
                  const Readings& figures);

  std::filesystem::path path_;
  std::ofstream file_;
  std::vector<std::string> parameters_, figures_;  ///< of all works, without duplicates
};

}  // namespace roomradar
