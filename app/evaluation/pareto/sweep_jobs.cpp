// sweep_jobs.cpp: writes the jobs' names and command lines; stores rows as JSON objects with a number per
// figure.
#include "app/evaluation/pareto/sweep_jobs.hpp"

#include <string_view>
#include <utility>

#include "app/farm/result_rows.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

using Json = nlohmann::json;

constexpr const char* kKind = "measurements";

/// Calls visit(scene, setting) for each job, with indices.
template <typename Visit>
void visit_jobs(const MeasuredWork& work, const std::vector<Setting>& settings, const Visit& visit) {
  for (std::size_t scene = 0; scene < work.scenes.size(); ++scene)
    for (std::size_t setting = 0; setting < settings.size(); ++setting) visit(scene, setting);
}

Json to_json(const MeasuredWork& work, const Readings& figures) {
  Json json = Json::object();
  for (std::size_t i = 0; i < figures.size(); ++i) json[work.figures[i].name] = json_number(figures[i]);
  return json;
}

Readings readings_from(const MeasuredWork& work, const Json& json) {
  Readings figures;
  for (const FigureName& figure : work.figures) figures.push_back(number_of(json.at(figure.name)));
  return figures;
}

SweepRow row_from(const MeasuredWork& work, const Json& json) {
  return {.repeat = json.at("repeat").get<int>(),
          .figures = readings_from(work, json.at("figures")),
          .default_before = readings_from(work, json.at("default_before")),
          .default_after = readings_from(work, json.at("default_after")),
          .ratios = readings_from(work, json.at("ratios")),
          .fault = json.at("fault").get<std::string>()};
}

/// Returns the row of a measurement that a failed job did not make.
SweepRow missing_row(const MeasuredWork& work, int repeat, const std::string& fault) {
  const Readings none(work.figures.size(), kNotMeasured);
  return {.repeat = repeat,
          .figures = none,
          .default_before = none,
          .default_after = none,
          .ratios = none,
          .fault = fault};
}

std::vector<SweepRow> rows_of_job(const MeasuredWork& work, int repeats, const std::filesystem::path& file) {
  auto rows = read_result_rows<SweepRow>(kKind, file, [&](const Json& json) { return row_from(work, json); });
  bool is_whole = rows.size() == static_cast<std::size_t>(repeats);
  for (std::size_t i = 0; i < rows.size(); ++i) is_whole = is_whole && rows[i].repeat == static_cast<int>(i);
  if (!is_whole) throw Error(file.string() + ": does not hold one row per repetition; delete its folder");
  return rows;
}

}  // namespace

std::string sweep_job_name(const MeasuredWork& work, std::size_t scene, const Setting& setting) {
  constexpr std::string_view kDigits = "0123456789abcdefghijklmnopqrstuvwxyz";
  std::string name = work.name + "-" + std::to_string(scene) + "-";
  for (const std::size_t word : setting) name += kDigits.at(word);
  return name;
}

std::vector<std::string> sweep_job_names(const MeasuredWork& work, const std::vector<Setting>& settings) {
  std::vector<std::string> names;
  visit_jobs(work, settings, [&](std::size_t scene, std::size_t setting) {
    names.push_back(sweep_job_name(work, scene, settings[setting]));
  });
  return names;
}

std::string sweep_manifest(const MeasuredWork& work, const std::vector<Setting>& settings,
                           const std::function<std::string(std::size_t scene)>& words_of) {
  std::string manifest;
  visit_jobs(work, settings, [&](std::size_t scene, std::size_t setting) {
    manifest += sweep_job_name(work, scene, settings[setting]) + ": trade --only " + work.name +
                " --setting " + setting_words(work.parameters, settings[setting]) + words_of(scene) +
                " --rows {}/rows.json\n";
  });
  return manifest;
}

void write_sweep_rows(const MeasuredWork& work, const std::vector<SweepRow>& rows,
                      const std::filesystem::path& path) {
  Json array = Json::array();
  for (const SweepRow& row : rows)
    array.push_back({{"repeat", row.repeat},
                     {"figures", to_json(work, row.figures)},
                     {"default_before", to_json(work, row.default_before)},
                     {"default_after", to_json(work, row.default_after)},
                     {"ratios", to_json(work, row.ratios)},
                     {"fault", row.fault}});
  write_result_rows(kKind, array, path);
}

std::vector<SweepRow> joined_sweep_rows(const MeasuredWork& work, const std::vector<Setting>& settings,
                                        int repeats, const std::filesystem::path& folder,
                                        const std::map<std::string, std::string>& faults) {
  std::vector<SweepRow> joined;
  visit_jobs(work, settings, [&](std::size_t scene, std::size_t setting) {
    const std::string name = sweep_job_name(work, scene, settings[setting]);
    std::vector<SweepRow> rows;
    if (const auto fault = faults.find(name); fault == faults.end())
      rows = rows_of_job(work, repeats, folder / name / "rows.json");
    else
      for (int repeat = 0; repeat < repeats; ++repeat)
        rows.push_back(missing_row(work, repeat, "job " + name + ": " + fault->second));
    for (SweepRow& row : rows) {
      row.setting = setting;
      row.scene = scene;
      joined.push_back(std::move(row));
    }
  });
  return joined;
}

}  // namespace roomradar
