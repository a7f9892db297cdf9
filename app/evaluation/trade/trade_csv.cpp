// trade_csv.cpp: writes rows of measurements, then rows of settings.
#include "app/evaluation/trade/trade_csv.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

std::string csv_number(double value) {
  if (!std::isfinite(value)) return {};
  char text[40];
  format_classic(text, sizeof text, "%.6g", value);
  return text;
}

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

}  // namespace

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text) quoted += letter == '"' ? "\"\"" : std::string(1, letter);
  return quoted + "\"";
}

TradeCsv::TradeCsv(const std::filesystem::path& path, const std::vector<MeasuredWork>& works) : path_(path) {
  if (path.empty()) return;
  for (const MeasuredWork& work : works) {
    for (const Parameter& parameter : work.parameters) add_once(parameters_, parameter.name);
    for (const FigureName& figure : work.figures) add_once(figures_, figure.name);
  }
}

void TradeCsv::open() {
  file_.open(path_, std::ios::trunc);
  file_ << "row,work,setting,scene,repeat,rank,loss,time_ratio,least_ratio,most_ratio,default_before,default_"
           "after,"
           "fault";
  for (const std::string& name : parameters_) file_ << ',' << csv_field(name);
  for (const std::string& name : figures_) file_ << ',' << csv_field(name);
  file_ << std::endl;
  require_written(file_, path_);
}

void TradeCsv::write_line(const std::vector<std::string>& start, const MeasuredWork& work,
                          const Setting& setting, const Readings& figures) {
  if (!file_.is_open()) open();
  std::string line;
  for (const std::string& field : start) line += csv_field(field) + ",";
  for (const std::string& name : parameters_) {
    for (std::size_t i = 0; i < work.parameters.size(); ++i)
      if (work.parameters[i].name == name) line += csv_field(work.parameters[i].words[setting[i]]);
    line += ',';
  }
  for (const std::string& name : figures_) {
    for (std::size_t i = 0; i < work.figures.size(); ++i)
      if (work.figures[i].name == name) line += csv_number(figures[i]);
    line += ',';
  }
  line.back() = '\n';
  file_ << line << std::flush;
  require_written(file_, path_);
}

void TradeCsv::write(const MeasuredWork& work, const std::vector<Setting>& settings, const SweepRow& row) {
  if (path_.empty()) return;
  write_line({"measurement", work.name, std::to_string(row.setting), work.scenes[row.scene],
              std::to_string(row.repeat), "", "", csv_number(row.ratios[work.time]), "", "",
              csv_number(row.default_before[work.time]), csv_number(row.default_after[work.time]), row.fault},
             work, settings[row.setting], row.figures);
}

void TradeCsv::write(const MeasuredWork& work, const std::vector<SettingSummary>& summaries,
                     std::size_t defaults, const PresetChoice& choice) {
  if (path_.empty()) return;
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    const SettingSummary& summary = summaries[i];
    std::string rank = names_of(i, defaults, choice, " ");
    if (std::find(choice.front.begin(), choice.front.end(), i) != choice.front.end())
      rank += rank.empty() ? "front" : " front";
    write_line({"setting", work.name, std::to_string(i), summary.is_complete ? "all" : "some",
                std::to_string(summary.rows), rank, csv_number(loss_of(work, summary, summaries[defaults])),
                csv_number(summary.time_ratio), csv_number(summary.least_ratio),
                csv_number(summary.most_ratio), "", "", ""},
               work, summary.setting, summary.figures);
  }
}

}  // namespace roomradar
