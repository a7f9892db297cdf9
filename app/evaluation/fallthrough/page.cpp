// page.cpp: the page's text, plots, and pictures as base64.
#include "app/evaluation/fallthrough/page.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "app/evaluation/fallthrough/totals.hpp"
#include "app/media/svg_plot.hpp"
#include "mapping/types/codecs/png.hpp"
#include "mapping/types/system/atomic_file.hpp"
#include "mapping/types/system/classic_locale.hpp"

namespace roomradar {
namespace {

constexpr char kStyle[] =
    "body{font:15px/1.45 system-ui,sans-serif;max-width:1200px;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;margin:1em 0}td,th{padding:.25em .7em;text-align:right}"
    "th{font-weight:600}tr>*:first-child{text-align:left}table.totals tr+tr{border-top:1px solid #ddd}"
    "caption{text-align:left;font-weight:600;padding:.3em 0}.t{font:600 14px sans-serif}"
    ".n{font:12px sans-serif;fill:#444}.e{text-anchor:end}.m{text-anchor:middle}.g{stroke:#ddd}"
    ".wide{overflow-x:auto}svg{max-width:100%;height:auto}"
    "figure{display:inline-block;margin:.5em "
    "0;width:560px;max-width:100%;vertical-align:top}figcaption{font-size:13px}"
    "img{max-width:100%}.part{display:inline-block;max-width:100%;margin-right:2em;vertical-align:top}"
    ".cells th,.cells td{min-width:3.3em;text-align:center;font-variant-numeric:tabular-nums}"
    ".cells tr>th:first-child{text-align:left;font-weight:400}td{white-space:nowrap}"
    "@media(max-width:500px){body{padding:0 .6em}.part{margin-right:0}.cells{font-size:12px;width:100%}"
    ".cells th,.cells td{min-width:0;padding:.25em .15em}td,.cells tr>th:first-child{white-space:normal}"
    ".totals tr:first-child{display:none}.totals,.totals tbody{display:block}"
    ".totals tr{display:block;padding:.4em 0}"
    ".totals td{display:flex;justify-content:space-between;gap:1em;padding:.1em 0;text-align:right}"
    ".totals td:first-child{font-weight:600}.totals td::before{content:attr(data-name);font-weight:400}}";

constexpr const char* kColours[] = {"#8a8a8a", "#c98a1b", "#b04ab0", "#2367c9", "#1a9850"};
static_assert(std::size(kColours) == kPolicyCount);

std::string base64(const std::vector<unsigned char>& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t j) { return j < bytes.size() ? static_cast<unsigned>(bytes[j]) : 0U; };
    const unsigned three = byte(i) << 16U | byte(i + 1) << 8U | byte(i + 2);
    for (unsigned digit = 0; digit < 4; ++digit)
      text += i + digit <= bytes.size() ? kDigits[three >> (18U - 6U * digit) & 63U] : '=';
  }
  return text;
}

std::string totals_table(const std::vector<ScenarioRow>& rows) {
  const auto totals = totals_of(rows);
  const double count = std::max<double>(1.0, static_cast<double>(rows.size()));
  std::string html =
      "<div class=\"wide\"><table class=\"totals\"><tr><th>surfaces</th><th>passed through</th><th>stopped "
      "in empty space</th><th>contact error, median</th><th>p95</th><th>frame, median</th><th>relative "
      "to the first</th></tr>\n";
  char line[400];
  for (std::size_t i = 0; i < kPolicyCount; ++i) {
    const PolicyTotals& t = totals[i];
    format_classic(line, sizeof line,
                   "<tr><td>%s</td><td>%d (%.1f %%)</td><td>%d (%.1f %%)</td><td>%s</td><td>%s</td><td>%.1f "
                   "ms</td><td>× %.2f</td></tr>\n",
                   std::string(kFallthroughPolicies[i].name).c_str(), t.passed, 100.0 * t.passed / count,
                   t.false_stops, 100.0 * t.false_stops / count,
                   millimetres(t.contact_error_median_m).c_str(), millimetres(t.contact_error_p95_m).c_str(),
                   t.frame_median_ms, t.cost_ratio);
    html += line;
  }
  return named_cells(html) + "</table></div>\n";
}

/// Plots the share of scenarios that ended within x of the true contact. Objects that were not stopped count
/// with the distance at which they were given up.
std::string error_plot(const std::vector<ScenarioRow>& rows) {
  std::vector<PlotLine> lines;
  for (std::size_t i = 0; i < kPolicyCount; ++i) {
    std::vector<double> errors_mm;
    for (const ScenarioRow& row : rows) errors_mm.push_back(1e3 * std::abs(row.trials[i].verdict.error_m));
    std::sort(errors_mm.begin(), errors_mm.end());
    PlotLine line{std::string(kFallthroughPolicies[i].name), kColours[i], {}};
    const double count = static_cast<double>(errors_mm.size());
    const std::size_t every = std::max<std::size_t>(1, errors_mm.size() / 200);
    for (std::size_t rank = 0; rank < errors_mm.size(); rank += every)
      line.points.emplace_back(errors_mm[rank], 100.0 * static_cast<double>(rank + 1) / count);
    if (!errors_mm.empty()) line.points.emplace_back(errors_mm.back(), 100.0);
    lines.push_back(std::move(line));
  }
  return percent_plot(
      "Share of scenarios in which the object stopped within this distance of the true contact",
      "distance from the true contact, mm", 0.1, 1000.0, lines);
}

/// Returns a table of an outcome's share per policy, grouped by `key`.
std::string outcome_cells(const std::vector<ScenarioRow>& rows, const std::string& title, Outcome outcome,
                          const std::function<std::string(const ScenarioRow&)>& key) {
  std::map<std::string, std::array<int, kPolicyCount + 1>> counts;
  for (const ScenarioRow& row : rows) {
    auto& count = counts[key(row)];
    ++count[kPolicyCount];
    for (std::size_t i = 0; i < kPolicyCount; ++i) count[i] += row.trials[i].verdict.outcome == outcome;
  }
  ShareTable table{title, {}, {}, {}};
  for (const FallthroughPolicy& policy : kFallthroughPolicies) table.columns.emplace_back(policy.name);
  for (const auto& [name, count] : counts) {
    table.rows.push_back(name + " (" + std::to_string(count[kPolicyCount]) + ")");
    table.share.emplace_back();
    for (std::size_t i = 0; i < kPolicyCount; ++i)
      table.share.back().push_back(static_cast<double>(count[i]) / count[kPolicyCount]);
  }
  return "<div class=\"wide part\">" + share_cells(table) + "</div>\n";
}

std::string speed_of(const ScenarioRow& row) {
  if (row.speed_m_s < 1.0) return "0 to 1 m/s";
  return row.speed_m_s < 3.0 ? "1 to 3 m/s" : "3 to 10 m/s";
}

std::size_t failure_count(const std::vector<ScenarioRow>& rows) {
  std::size_t failures = 0;
  for (const ScenarioRow& row : rows)
    for (const Trial& trial : row.trials) failures += trial.verdict.outcome != Outcome::kStoppedRight ? 1 : 0;
  return failures;
}

}  // namespace

void write_page(const std::vector<ScenarioRow>& rows, const std::string& about,
                const std::vector<FailurePicture>& pictures, const std::filesystem::path& path) {
  if (path.empty()) return;
  AtomicFile whole(path);
  std::ostream& file = whole.stream();
  file << "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" "
          "content=\"width=device-width,initial-scale=1\"><title>Fall-through</title><style>"
       << kStyle << "</style><h1>Do virtual objects fall through hidden surfaces?</h1><p>" << escaped(about)
       << "</p><p>An object moves straight onto a surface that the camera cannot see now, but saw in the "
          "prescan. Passed through: more than 2 cm beyond the exact contact. Stopped in empty space: more "
          "than 3 cm before it.</p>"
       << totals_table(rows) << error_plot(rows);
  const auto shape = [](const ScenarioRow& row) { return std::string(to_string(row.shape)); };
  const auto hider = [](const ScenarioRow& row) {
    return std::string(to_string(row.occluder)) + (row.occluder_moves ? ", moving" : "");
  };
  for (const auto& [title, outcome] :
       {std::pair{std::string("Passed through, by "), Outcome::kPassedThrough},
        {std::string("Stopped in empty space, by "), Outcome::kStoppedFalse}}) {
    file << "<div>" << outcome_cells(rows, title + "shape", outcome, shape)
         << outcome_cells(rows, title + "occluder", outcome, hider)
         << outcome_cells(rows, title + "speed", outcome, speed_of) << "</div>\n";
  }
  file << "<h2>Failures</h2><p>Left: the camera's depth. Right: a section along the object's path; grey the "
          "true room, orange the occluder, lines the surfaces that the object could touch: black the map, "
          "blue this frame's, violet inferred, red the frontier of unknown space. Object: blue at its start, "
          "green at the true contact, red at its end.</p>\n";
  const std::size_t failures = failure_count(rows);
  if (failures == 0) file << "<p>None.</p>";
  if (failures > pictures.size())
    file << "<p>" << pictures.size() << " of " << failures << " are shown, the last policies' first.</p>\n";
  for (const FailurePicture& picture : pictures)
    file << "<figure><img alt=\"\" src=\"data:image/png;base64," << base64(encode_png(picture.picture))
         << "\"><figcaption>" << escaped(picture.caption) << "</figcaption></figure>\n";
  file << "</html>\n";
  whole.commit();
}

}  // namespace roomradar
