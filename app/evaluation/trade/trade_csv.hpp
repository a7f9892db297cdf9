// trade_csv.hpp: everything that a sweep measured, as it is measured.
#pragma once
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "app/evaluation/pareto/choose_presets.hpp"

namespace roomradar {

/// A field as RFC 4180 has it: in quotes where it holds a comma, a quote or a line's end.
std::string csv_field(const std::string& text);

/// One header for all kinds of work; what a row has nothing to say of is empty.
class TradeCsv {
 public:
  /// Nothing is written for an empty path, nor before the first line: what was there may be hours of work.
  TradeCsv(const std::filesystem::path& path, const std::vector<MeasuredWork>& works);

  /// A measurement; it is on the disk afterwards. Throws Error if the file cannot be written.
  void write(const MeasuredWork& work, const std::vector<Setting>& settings, const SweepRow& row);
  /// All measurements of each setting together, their loss, and what the setting is: front, default, a
  /// preset.
  void write(const MeasuredWork& work, const std::vector<SettingSummary>& summaries, std::size_t defaults,
             const PresetChoice& choice);

 private:
  void open();
  void write_line(const std::vector<std::string>& start, const MeasuredWork& work, const Setting& setting,
                  const Readings& figures);

  std::filesystem::path path_;
  std::ofstream file_;
  std::vector<std::string> parameters_, figures_;  ///< of all works, each once
};

}  // namespace roomradar
