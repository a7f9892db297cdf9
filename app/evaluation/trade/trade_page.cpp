// trade_page.cpp: the page's text, tables and plots.
#include "app/evaluation/trade/trade_page.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <set>

#include "app/evaluation/pareto/pareto_front.hpp"
#include "app/evaluation/pareto/pareto_plot.hpp"
#include "app/evaluation/trade/trade_csv.hpp"
#include "app/media/svg_plot.hpp"
#include "mapping/types/system/atomic_file.hpp"
#include "mapping/types/system/classic_locale.hpp"

namespace roomradar {
namespace {

constexpr char kStyle[] =
    ":root{color-scheme:light dark;--ink:#1d2430;--soft:#5b6575;--grid:#dfe3ea;--paper:#fff;--dot:#9aa5b5;"
    "--front:#1f66d1;--mark:#d0471b;--band:#f4f6f9}"
    "@media(prefers-color-scheme:dark){:root{--ink:#e6e9ef;--soft:#a3adbc;--grid:#333b48;--paper:#14181f;"
    "--dot:#6d7889;--front:#6ea8ff;--mark:#ff9466;--band:#1c222c}}"
    "body{font:15px/1.5 system-ui,sans-serif;background:var(--paper);color:var(--ink);max-width:1340px;"
    "margin:2em auto;padding:0 1em}h1{font-size:1.6em}h2{margin-top:2em}p{max-width:75ch}"
    ".about{color:var(--soft);font-size:13px}.plots{display:grid;gap:1.2em;"
    "grid-template-columns:repeat(auto-fit,minmax(min(480px,100%),1fr))}svg{width:100%;max-width:640px;"
    "height:auto}"
    ".wide{overflow-x:auto}table{border-collapse:collapse;margin:1em 0;font-size:13.5px}"
    "td,th{padding:.3em .7em;text-align:right;border-bottom:1px solid var(--grid);white-space:nowrap}"
    "th{font-weight:600;text-align:right}tr>*:first-child{text-align:left}thead th{white-space:normal;"
    "vertical-align:bottom}td.words{text-align:left;white-space:normal;min-width:18em}"
    "tr.chosen{background:var(--band)}text{fill:var(--ink);font:12px system-ui,sans-serif}"
    ".title{font-size:14px;font-weight:600}.tick{fill:var(--soft)}.end{text-anchor:end}"
    ".middle{text-anchor:middle}.grid{stroke:var(--grid)}.one{stroke:var(--dot);stroke-dasharray:4 3}"
    ".spread{stroke:var(--dot);stroke-opacity:.5}.dot{fill:var(--dot)}.best{fill:var(--front)}"
    ".front{fill:none;stroke:var(--front);stroke-width:1.6}.ring{fill:none;stroke:var(--mark);stroke-width:2}"
    ".preset{fill:var(--mark)}.label{font-weight:600;paint-order:stroke;stroke:var(--paper);stroke-width:"
    "4px}"
    "@media(max-width:600px){body{padding:0 .6em}thead{display:none}table,tbody,tr{display:block}"
    "tr{padding:.5em .3em;border-bottom:1px solid var(--grid)}"
    "td,td.words{display:flex;justify-content:space-between;gap:1em;padding:.1em 0;border:0;min-width:0;"
    "white-space:normal;text-align:right}td:first-child{font-weight:600}"
    "td::before{content:attr(data-name);color:var(--soft);font-weight:400;text-align:left}}";

std::string page_number(double value) { return std::isfinite(value) ? readable_number(value) : "–"; }
std::string page_number(double value, const char* form) {
  if (!std::isfinite(value)) return "–";
  char text[40];
  format_classic(text, sizeof text, form, value);
  return text;
}

std::string ratio(const SettingSummary& summary) {
  return page_number(summary.time_ratio, "%.2f") + " (" + page_number(summary.least_ratio, "%.2f") + "–" +
         page_number(summary.most_ratio, "%.2f") + ")";
}

/// Returns the label of a dot or a table's row; empty unless default or preset.
std::string name_of(const TradeResult& result, std::size_t setting) {
  return names_of(setting, result.defaults, result.choice, " = ");
}

/// Returns all figures of one setting, for the tooltip.
std::string details(const TradeResult& result, std::size_t setting) {
  const SettingSummary& summary = result.summaries[setting];
  std::string text = "setting " + std::to_string(setting) + ": " +
                     describe(result.work.parameters, summary.setting) + "\ntime × " + ratio(summary) + ", " +
                     std::to_string(summary.rows) + " measurements";
  for (std::size_t i = 0; i < result.work.figures.size(); ++i) {
    const FigureName& figure = result.work.figures[i];
    if (std::isfinite(summary.figures[i]))
      text += "\n" + figure.title + ": " + page_number(figure.shown * summary.figures[i]);
  }
  return text;
}

/// Returns true for settings with the default load that were measured in all scenes.
bool is_shown(const TradeResult& result, std::size_t setting) {
  const SettingSummary& summary = result.summaries[setting];
  return summary.is_complete && has_default_load(result.work.parameters, summary.setting);
}

/// @param negligible  largest difference of the error that does not count
/// @param error_of    returns a setting's error; both in the plot's unit
/// @param given_front settings on the front, if it is not this plot's own
template <typename ErrorOf>
std::string plot_of(const TradeResult& result, const std::string& title, const std::string& y_name,
                    double negligible, const ErrorOf& error_of,
                    const std::optional<std::vector<std::size_t>>& given_front = {}) {
  // Relative to the default's error; larger errors are failures and would compress the plot.
  constexpr double kOffThePlot = 10.0;
  std::vector<std::size_t> shown;
  std::vector<CostAndError> points;
  int beyond = 0;
  for (std::size_t i = 0; i < result.summaries.size(); ++i) {
    if (!is_shown(result, i)) continue;
    const CostAndError point{result.summaries[i].time_ratio, error_of(i)};
    if (point.error > kOffThePlot * (error_of(result.defaults) + negligible)) {
      ++beyond;
      continue;
    }
    shown.push_back(i);
    points.push_back(point);
  }
  std::vector<std::size_t> front;
  if (!given_front)
    for (const std::size_t k : pareto_front_of(points)) front.push_back(shown[k]);
  const std::vector<std::size_t>& settings_on_front = given_front ? *given_front : front;
  ParetoPlot plot{.title = title, .x_name = "time relative to the default's", .y_name = y_name};
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const std::size_t i = shown[k];
    const SettingSummary& summary = result.summaries[i];
    const bool is_default = i == result.defaults;
    const std::string name = name_of(result, i);
    const bool is_on_front =
        std::find(settings_on_front.begin(), settings_on_front.end(), i) != settings_on_front.end();
    plot.dots.push_back({.x = points[k].cost,
                         .y = points[k].error,
                         .x_least = summary.least_ratio,
                         .x_most = summary.most_ratio,
                         .title = details(result, i),
                         .label = !name.empty() ? name
                                  : is_on_front ? std::to_string(i)
                                                : "",
                         .is_default = is_default,
                         .is_preset = !name.empty() && name != "default",
                         .is_on_front = is_on_front});
  }
  if (beyond > 0) plot.title += " (" + std::to_string(beyond) + " beyond 10 times the default's left out)";
  return pareto_plot(plot);
}

std::string plots_of(const TradeResult& result) {
  std::string html = "<div class=\"plots\">\n";
  html += plot_of(
      result, result.work.name + ": all errors together", "loss: mean of errors relative to the default's",
      0.0,
      [&](std::size_t i) {
        return loss_of(result.work, result.summaries[i], result.summaries[result.defaults]);
      },
      result.choice.front);
  for (std::size_t f = 0; f < result.work.figures.size(); ++f) {
    const FigureName& figure = result.work.figures[f];
    if (figure.kind != FigureKind::kError && figure.kind != FigureKind::kMemory) continue;
    html += plot_of(result, result.work.name + ": " + figure.title, figure.title,
                    figure.shown * figure.negligible,
                    [&](std::size_t i) { return figure.shown * result.summaries[i].figures[f]; });
  }
  return html + "</div>\n";
}

std::string table_of(const TradeResult& result, const std::vector<std::size_t>& settings) {
  std::string html =
      "<div class=\"wide\"><table><thead><tr><th>setting</th><th>what differs from the default</th>"
      "<th>time relative to the default's (spread)" +
      std::string(result.is_by_jobs ? ", not comparable" : "") + "</th><th>loss</th>";
  for (const FigureName& figure : result.work.figures) html += "<th>" + escaped(figure.title) + "</th>";
  html += "</tr></thead>\n";
  for (const std::size_t i : settings) {
    const SettingSummary& summary = result.summaries[i];
    const std::string name = name_of(result, i);
    html += std::string(name.empty() ? "<tr>" : "<tr class=\"chosen\">") + "<td>" + std::to_string(i) + " " +
            escaped(name) + "</td><td class=\"words\">" +
            escaped(describe(result.work.parameters, summary.setting)) + "</td><td>" + ratio(summary) +
            "</td><td>" +
            page_number(loss_of(result.work, summary, result.summaries[result.defaults]), "%.2f") + "</td>";
    for (std::size_t f = 0; f < result.work.figures.size(); ++f)
      html += "<td>" + page_number(result.work.figures[f].shown * summary.figures[f]) + "</td>";
    html += "</tr>\n";
  }
  return named_cells(html) + "</table></div>\n";
}

/// Returns the settings that change a single parameter, sorted by parameter, after the default.
std::vector<std::size_t> single_turns_of(const TradeResult& result) {
  std::vector<std::pair<std::pair<std::size_t, std::size_t>, std::size_t>> turns;
  const Setting defaults = default_setting(result.work.parameters);
  for (std::size_t i = 0; i < result.summaries.size(); ++i) {
    std::size_t turned = 0, parameter = 0;
    for (std::size_t k = 0; k < defaults.size(); ++k) {
      if (result.summaries[i].setting[k] == defaults[k]) continue;
      ++turned;
      parameter = k;
    }
    if (turned == 1 && result.summaries[i].rows > 0)
      turns.push_back({{parameter, result.summaries[i].setting[parameter]}, i});
  }
  std::sort(turns.begin(), turns.end());
  std::vector<std::size_t> settings{result.defaults};
  for (const auto& [place, setting] : turns) settings.push_back(setting);
  return settings;
}

/// Returns the scenes, the number of measurements, and the failures.
std::string about(const TradeResult& result) {
  int shown = 0;
  for (std::size_t i = 0; i < result.summaries.size(); ++i) shown += is_shown(result, i) ? 1 : 0;
  std::set<std::size_t> measured;
  for (const SweepRow& row : result.rows) measured.insert(row.scene);
  std::string scenes;
  for (const std::size_t scene : measured) scenes += (scenes.empty() ? "" : ", ") + result.work.scenes[scene];
  std::string text = std::to_string(shown) + " settings on the plots, " + std::to_string(result.rows.size()) +
                     " measurements in: " + escaped(scenes) +
                     "<br>Time compared: " + escaped(result.work.figures[result.work.time].title);
  if (result.is_by_jobs)
    text +=
        "<br><b>Times are not comparable:</b> measured by jobs that ran beside others; compare the errors";
  if (result.was_cut_short) text += "<br><b>Stopped early:</b> not all settings were measured";
  for (const std::string& fault : faults_of(result)) text += "<br><b>Not measured:</b> " + escaped(fault);
  return text;
}

std::string section_of(const TradeResult& result) {
  const PresetChoice& choice = result.choice;
  std::vector<std::size_t> presets{result.defaults};
  for (const auto& preset : {choice.fast, choice.balanced, choice.accurate})
    if (preset && std::find(presets.begin(), presets.end(), *preset) == presets.end())
      presets.push_back(*preset);
  return "<h2>" + escaped(result.work.name) + "</h2><p class=\"about\">" + about(result) +
         "</p>\n<h3>Presets</h3>" + table_of(result, presets) + "<h3>Fronts</h3>" + plots_of(result) +
         "<h3>The front of all errors together</h3>" + table_of(result, choice.front) +
         "<h3>Single parameters</h3>" + table_of(result, single_turns_of(result));
}

}  // namespace

std::vector<std::string> faults_of(const TradeResult& result) {
  std::set<std::size_t> told;
  std::vector<std::string> faults;
  for (const SweepRow& row : result.rows)
    if (!row.fault.empty() && told.insert(row.setting).second)
      faults.push_back(describe(result.work.parameters, result.settings[row.setting]) + ", in " +
                       result.work.scenes[row.scene] + ": " + row.fault);
  return faults;
}

void write_trade_page(const std::vector<TradeResult>& results, const std::vector<std::string>& about,
                      const std::filesystem::path& path) {
  if (path.empty()) return;
  AtomicFile whole(path);
  std::ostream& file = whole.stream();
  file << "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" "
          "content=\"width=device-width,initial-scale=1\"><title>roomradar: time against "
          "accuracy</title><style>"
       << kStyle << "</style>\n<h1>Time against accuracy</h1>\n<p class=\"about\">";
  for (const std::string& line : about) file << escaped(line) << "<br>";
  file
      << "</p>\n<h2>How to read this</h2>\n"
         "<p><b>A dot</b> is a setting: the further left the faster, the lower the better; rest the mouse on "
         "it "
         "for all that was measured. Its horizontal line is the spread of the measurements.</p>\n"
         "<p><b>Time</b> is given as a ratio: each measurement of a setting is divided by the mean of the "
         "default's just before and just after it, so that a machine that is busy for a while does not draw "
         "the "
         "curve. The default is also measured as if it were a setting; how far its own spread is from 1 "
         "is what the machine's noise makes of all ratios.</p>\n"
         "<p><b>The blue line</b> is the front: no setting is both faster and better than one on it; what is "
         "above and to the right of it is not worth choosing for this error.</p>\n"
         "<p><b>Loss</b> is all errors in one number: the geometric mean of each error over the default's "
         "(both "
         "with what is negligible added), so 1 is the default and 1.5 is half as much error again.</p>\n"
         "<p><b>Orange</b>: the ring is the default; diamonds are the presets. <i>fast</i> is the fastest "
         "with a loss of at most 1.5, <i>balanced</i> the fastest with one of at most 1.1, "
         "<i>accurate</i> has the least loss within 3 times the default's time, or is the default where that "
         "is less than 1 % better; no preset has any error more than 3 times the default's, and nothing on "
         "the front of all errors one more than 10 times.</p>\n";
  for (const TradeResult& result : results) file << section_of(result);
  file << "</html>\n";
  whole.commit();
}

}  // namespace roomradar
