// trade_command.cpp: roomradar trade: measures time against accuracy.
#include "app/commands/commands.hpp"

#include <sys/utsname.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <thread>

#include "app/cli/deferred_errors.hpp"
#include "app/cli/interrupt.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/report.hpp"
#include "app/commands/farm_command.hpp"
#include "app/evaluation/pareto/setting_choice.hpp"
#include "app/evaluation/pareto/sweep_jobs.hpp"
#include "app/evaluation/trade/prescan_work.hpp"
#include "app/evaluation/trade/run_work.hpp"
#include "app/evaluation/trade/table1.hpp"
#include "app/evaluation/trade/trade_csv.hpp"
#include "app/evaluation/trade/trade_frames.hpp"
#include "app/evaluation/trade/trade_page.hpp"
#include "app/evaluation/trade/trade_presets.hpp"
#include "app/farm/manifest.hpp"
#include "app/sim/scenarios/scenarios.hpp"
#include "app/sim/sensor/sim_options.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/run_sandboxed.hpp"
#include "radar/gl/gl_context.hpp"

namespace roomradar {
namespace {

/// The machine on which a measurement is made.
struct Machine {
  std::string processor;  ///< model name; "unknown processor" if not available
  unsigned threads = 0;
  std::string system;    ///< such as "Linux 6.1"
  std::string renderer;  ///< name of the OpenGL renderer
};

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.find(':') + 2, line.size()));
  return "unknown processor";
}

/// Returns the description of this machine. A child process queries the renderer, so this process creates no
/// GL context. Throws Error if there is no renderer.
Machine this_machine() {
  constexpr unsigned kMost_s = 60;
  constexpr std::size_t kMost_bytes = std::size_t{1} << 38U;
  Machine machine{
      .processor = processor(), .threads = std::thread::hardware_concurrency(), .system = {}, .renderer = {}};
  utsname system{};
  if (uname(&system) == 0) machine.system = std::string(system.sysname) + " " + system.release;
  machine.renderer = run_sandboxed([] { return GlContext().renderer(); }, "OpenGL does not say its renderer",
                                   kMost_s, kMost_bytes);
  return machine;
}

TradeScale scale_of(const TradeOptions& options) { return options.quick ? kQuickScale : TradeScale{}; }

/// Throws Error if the room's spec has keys that a scan in it would ignore.
void require_scan_room(const std::string& room, SimOptions options) {
  const SimOptions defaults;
  const std::string said = sim_spec(options);
  options.frames = defaults.frames;
  options.rate_hz = defaults.rate_hz;
  options.depth_camera = defaults.depth_camera;
  if (sim_spec(options) != said)
    throw Error("trade: " + room +
                ": the sweep itself sets the number, rate and width of the frames; leave out frames=, rate= "
                "and width=");
}

/// Throws Error if the room's spec has keys that a run in it would ignore, or if it has no hidden surface.
void require_run_room(const std::string& room, const SimOptions& options) {
  SimOptions heeded;
  heeded.room = options.room;
  heeded.seed = options.seed;
  if (sim_spec(heeded) != sim_spec(options))
    throw Error(
        "trade: " + room +
        ": for a run's room only its name and seed can be chosen; leave out the rest, or use --only prescan");
  (void)make_scenario(make_scenario_room(options.room, options.seed), options.seed, 0);
}

/// Rejects unsuitable scenes before the sweep begins.
void require_scenes(const TradeOptions& options) {
  const bool scans = options.only != "run" && !options.compare_published,
             runs = options.only != "prescan" || options.compare_published;
  for (const std::string& room : options.rooms) {
    const SimOptions of_room = parse_sim_spec("sim:" + room);
    if (scans) require_scan_room(room, of_room);
    if (runs) require_run_room(room, of_room);
  }
  const TradeScale scale = scale_of(options);
  const int read = std::max(scans ? scale.scan_frames : 0, runs ? scale.map_frames + scale.run_frames : 0);
  for (const std::string& recording : options.recordings) (void)frames_of_recording(recording, read);
}

std::vector<MeasuredWork> works_of(const TradeOptions& options) {
  const TradeScale scale = scale_of(options);
  std::vector<MeasuredWork> works;
  if (options.only != "run") works.push_back(prescan_work(options.rooms, options.recordings, scale));
  if (options.only != "prescan")
    works.push_back(run_work(options.rooms, options.recordings, scale, options.objects));
  for (MeasuredWork& work : works)
    if (options.time == "cpu") work.time = place_of(work, "cpu_ms");
  return works;
}

/// Records a Ctrl-C, after which the measurements so far are the result.
class Stop {
 public:
  /// @param by_jobs  true: never asked; Ctrl-C then ends the jobs and the command
  explicit Stop(bool by_jobs) {
    if (by_jobs) return;
    interrupt_.emplace();
    Interrupt::say(
        "\nroomradar: stops here; the completed scenes are the result. Press Ctrl-C again to end at once\n");
  }
  bool asked() { return was_asked_ = was_asked_ || (interrupt_ && Interrupt::take()); }

 private:
  std::optional<Interrupt> interrupt_;
  bool was_asked_ = false;
};

/// The words of a job that say where and how it measures, beside its setting.
std::string job_words(const TradeOptions& options, std::size_t scene) {
  std::string words;
  if (scene < options.rooms.size()) {
    words += " --rooms " + quoted_literal(options.rooms[scene]);
  } else {
    const std::string& source = options.recordings[scene - options.rooms.size()];
    std::error_code ignored;
    const bool is_path = std::filesystem::exists(source, ignored);
    words +=
        " " +
        quoted_literal(is_path ? std::filesystem::absolute(source).lexically_normal().string() : source) +
        " --rooms none";
  }
  words += " --repeats " + std::to_string(options.repeats);
  if (options.objects != TradeOptions().objects) words += " --objects " + std::to_string(options.objects);
  return words + (options.quick ? " --quick" : "");
}

/// Measures by jobs. A sweep calls it several times, as later settings depend on earlier results.
class SweepByJobs {
 public:
  explicit SweepByJobs(const TradeOptions& options) : options_(options) {}

  SweptRows operator()(const MeasuredWork& work, const std::vector<Setting>& settings,
                       const SweepWatch& watch) {
    manifest_ +=
        sweep_manifest(work, settings, [&](std::size_t scene) { return job_words(options_, scene); });
    JobFaults failed = run_split(options_.jobs, manifest_, "roomradar-trade", sweep_job_names(work, settings),
                                 options_.processes);
    SweptRows swept{joined_sweep_rows(work, settings, options_.repeats, options_.jobs, failed), {}};
    for (const SweepRow& row : swept.rows) watch.on_row(row);
    failed_.merge(std::move(failed));
    return swept;
  }
  [[nodiscard]] const JobFaults& failed() const { return failed_; }

 private:
  const TradeOptions& options_;
  std::string manifest_ = "# Measurements of roomradar trade, as jobs of roomradar farm.\n";
  JobFaults failed_;
};

/// How works are swept: until when, by which jobs, and to which file. Refers to all three.
struct SweepMeans {
  Stop& stop;
  SweepByJobs& by_jobs;
  TradeCsv& csv;
};

TradeResult traded(const MeasuredWork& work, const TradeOptions& options, const SweepMeans& means) {
  TradeResult result{.work = work};
  result.defaults = 0;
  result.is_by_jobs = !options.jobs.empty();
  const std::size_t in_greedy_search = options.settings / 3;
  const auto rows = (1 + options.settings) * work.scenes.size() * static_cast<std::size_t>(options.repeats);
  std::optional<Progress> progress;
  if (!result.is_by_jobs) progress.emplace(work.name, static_cast<std::int64_t>(rows));
  const auto measure = [&](const std::vector<Setting>& settings) {
    const std::size_t before = result.settings.size();
    result.settings.insert(result.settings.end(), settings.begin(), settings.end());
    SweepWatch watch;
    watch.is_stopped = [&] { return means.stop.asked(); };
    const auto of_all = [before](SweepRow row) {  // index among all settings
      row.setting += before;
      return row;
    };
    watch.on_row = [&](const SweepRow& made) {
      const SweepRow row = of_all(made);
      means.csv.write(work, result.settings, row);
      if (!progress) return;
      char note[64];
      format_classic(note, sizeof note, "%s: x %.2f", work.scenes[row.scene].c_str(), row.ratios[work.time]);
      progress->step(row.fault.empty() ? note : row.fault);
    };
    SweptRows made = result.is_by_jobs ? means.by_jobs(work, settings, watch)
                                       : sweep(work, {settings, options.repeats, options.seed}, watch);
    for (SweepRow& row : made.rows) result.rows.push_back(of_all(std::move(row)));
    result.fault = std::move(made.fault);
    result.summaries = summarise(work, result.settings, result.rows);
  };
  std::vector<Setting> drawn =
      draw_settings(work.parameters, options.settings - in_greedy_search, options.seed);
  drawn.insert(drawn.begin(), default_setting(work.parameters));
  measure(drawn);
  if (result.rows.empty()) return result;
  if (result.fault.empty() && !means.stop.asked()) {
    const std::vector<Setting> greedy_search =
        greedy_settings(work, result.summaries, result.defaults, in_greedy_search);
    if (!greedy_search.empty()) measure(greedy_search);
  }
  result.choice = choose_presets(work, result.summaries, result.defaults);
  result.was_cut_short = means.stop.asked() || !result.fault.empty();
  return result;
}

/// Returns "sim:table; sim:random?seed=2; kitchen" and the like.
std::string scenes_of(const TradeOptions& options) {
  std::string scenes;
  for (const std::string& room : options.rooms) scenes += (scenes.empty() ? "sim:" : "; sim:") + room;
  for (const std::string& recording : options.recordings) scenes += (scenes.empty() ? "" : "; ") + recording;
  return scenes;
}

/// Prints one line on a preset.
void print_preset(const TradeResult& result, std::size_t setting) {
  const SettingSummary& summary = result.summaries[setting];
  std::printf("%-8s %-22s time x %5.2f (%.2f to %.2f), loss %5.2f: %s\n", result.work.name.c_str(),
              names_of(setting, result.defaults, result.choice, "=").c_str(), summary.time_ratio,
              summary.least_ratio, summary.most_ratio,
              loss_of(result.work, summary, result.summaries[result.defaults]),
              describe(result.work.parameters, summary.setting).c_str());
}

void print_presets(const TradeResult& result) {
  for (std::size_t i = 0; i < result.summaries.size(); ++i)
    if (!names_of(i, result.defaults, result.choice, "").empty()) print_preset(result, i);
  if (result.is_by_jobs)
    std::printf("%-8s times of jobs that ran beside others: not to be compared\n", result.work.name.c_str());
}

nlohmann::json result_json(const TradeResult& result) {
  nlohmann::json settings = nlohmann::json::array();
  for (std::size_t i = 0; i < result.summaries.size(); ++i) {
    const SettingSummary& summary = result.summaries[i];
    nlohmann::json row = {{"setting", describe(result.work.parameters, summary.setting)},
                          {"names", names_of(i, result.defaults, result.choice, " ")},
                          {"measurements", summary.rows},
                          {"time_ratio", summary.time_ratio},
                          {"loss", loss_of(result.work, summary, result.summaries[result.defaults])}};
    for (std::size_t f = 0; f < result.work.figures.size(); ++f)
      row[result.work.figures[f].name] = summary.figures[f];
    settings.push_back(std::move(row));
  }
  return {{"measurements", result.rows.size()},     {"settings", settings},
          {"front", result.choice.front},           {"cut_short", result.was_cut_short},
          {"times_comparable", !result.is_by_jobs}, {"not_measured", faults_of(result)}};
}

int print_table1(const TradeOptions& options, Report report) {
  const Table1 table = measure_table1(options.rooms.front(), scale_of(options));
  report.renderer = table.renderer;
  report.source = table.scene;
  report.settings = {{"room", options.rooms.front()}, {"quick", options.quick}};
  report.results["table1"] = to_json(table);
  std::fputs(text_of(table).c_str(), stdout);
  write_report(report, options.report);
  return 0;
}

/// Measures the works one after another. Throws Error if nothing was measured; faults after the first
/// measurement are added to `faults`.
std::vector<TradeResult> measure_all(const std::vector<MeasuredWork>& works, const TradeOptions& options,
                                     const SweepMeans& means, StageTimes& times, DeferredErrors& faults) {
  std::vector<TradeResult> results;
  for (const MeasuredWork& work : works) {
    TradeResult result;
    if (!means.stop.asked()) result = times.timed(work.name, [&] { return traded(work, options, means); });
    if (!result.fault.empty()) faults.add("trade: " + work.name + ": " + result.fault);
    if (!result.rows.empty())
      results.push_back(std::move(result));
    else if (result.fault.empty())
      std::fprintf(stderr, "roomradar: %s: stopped before any of it was measured\n", work.name.c_str());
  }
  if (!results.empty()) return results;
  faults.throw_first();
  throw Error("trade: stopped by Ctrl-C before anything was measured");
}

/// Prints the presets to stdout, and settings that were not measured to stderr.
void print_result(const TradeResult& result) {
  print_presets(result);
  if (result.was_cut_short)
    std::fprintf(stderr, "roomradar: %s: stopped early: not all settings were measured\n",
                 result.work.name.c_str());
  for (const std::string& setting : faults_of(result))
    std::fprintf(stderr, "roomradar: %s: not measured: %s\n", result.work.name.c_str(), setting.c_str());
}

void write_page_of(const std::vector<TradeResult>& results, const TradeOptions& options,
                   const Machine& machine) {
  write_trade_page(results,
                   {machine.processor + ", " + std::to_string(machine.threads) + " threads, " +
                        machine.renderer + ", " + machine.system,
                    "seed " + std::to_string(options.seed) + ", " + std::to_string(options.repeats) +
                        (options.repeats == 1 ? " repeat" : " repeats") + " in each scene" +
                        (options.quick ? ", quick: few frames of small images" : "")},
                   options.html);
}

/// Writes the presets file, if requested. Throws Error unless all settings of both works were measured.
void write_presets_of(const std::vector<TradeResult>& results, const TradeOptions& options,
                      const Machine& machine) {
  if (options.presets.empty()) return;
  if (results.size() < 2)
    throw Error(options.presets + ": not written: only " + results.front().work.name +
                " was measured, and presets need both");
  for (const TradeResult& result : results)
    if (result.was_cut_short)
      throw Error(options.presets + ": not written: " + result.work.name +
                  " was stopped early, and presets need all settings");
  write_presets(chosen_presets(results, {{"processor", machine.processor},
                                         {"renderer", machine.renderer},
                                         {"system", machine.system},
                                         {"scenes", scenes_of(options)},
                                         {"settings", std::to_string(options.settings)},
                                         {"repeats", std::to_string(options.repeats)},
                                         {"seed", std::to_string(options.seed)},
                                         {"compared_by", options.time},
                                         {"objects", std::to_string(options.objects)},
                                         {"scale", options.quick ? "quick" : "full"}}),
                options.presets);
}

/// Measures a single setting and writes its rows, as a job.
int measure_setting(const TradeOptions& options) {
  const MeasuredWork work = works_of(options).front();
  const Setting setting = setting_from(work.parameters, options.setting);
  if (work.scenes.size() != 1)
    throw Error("trade: --setting: measures in one room or recording, but " +
                std::to_string(work.scenes.size()) + " are given; choose one with --rooms and SOURCE");
  const SweptRows swept = sweep(work, {{setting}, options.repeats, options.seed});
  if (!swept.fault.empty()) throw Error("trade: " + work.name + ": " + swept.fault);
  write_sweep_rows(work, swept.rows, options.rows);
  return 0;
}

}  // namespace

int run(const TradeOptions& options) {
  for (const std::string& path : {options.csv, options.html, options.presets, options.report, options.rows})
    require_writable(path);
  Report report;
  report.command = "trade";
  report.source = scenes_of(options);
  report.settings = {{"rooms", options.rooms}, {"settings", options.settings}, {"repeats", options.repeats},
                     {"seed", options.seed},   {"time", options.time},         {"quick", options.quick},
                     {"only", options.only},   {"objects", options.objects}};
  require_scenes(options);
  if (options.compare_published) return print_table1(options, std::move(report));
  if (!options.setting.empty()) return measure_setting(options);
  const Machine machine = this_machine();
  report.renderer = machine.renderer;
  const std::vector<MeasuredWork> works = works_of(options);
  TradeCsv csv(options.csv, works);
  Stop stop(!options.jobs.empty());  // until the results are written
  SweepByJobs by_jobs(options);
  DeferredErrors faults;  // errors do not keep earlier measurements from being written
  const std::vector<TradeResult> results =
      measure_all(works, options, {stop, by_jobs, csv}, report.times, faults);
  for (const TradeResult& result : results) {
    print_result(result);
    report.results[result.work.name] = result_json(result);
  }
  faults.attempt([&] {
    for (const TradeResult& result : results)
      csv.write(result.work, result.summaries, result.defaults, result.choice);
  });
  faults.attempt([&] { write_page_of(results, options, machine); });
  faults.attempt([&] { write_presets_of(results, options, machine); });
  faults.attempt([&] { write_report(report, options.report); });
  faults.throw_first();
  return by_jobs.failed().empty() ? 0 : 1;
}

}  // namespace roomradar
