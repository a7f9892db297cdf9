// svg_plot.cpp: writes axes, lines and table cells as text.
#include "app/media/svg_plot.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

template <typename... Numbers>
std::string format(const char* text, Numbers... numbers) {
  char line[256];
  format_classic(line, sizeof line, text, numbers...);
  return line;
}

}  // namespace

std::string readable_number(double value, int digits) {
  if (!std::isfinite(value)) return format_number(value);
  const std::string general = format_general(without_minus_zero(value), digits);  // may have an exponent
  double parsed = 0.0;
  std::from_chars(general.data(), general.data() + general.size(), parsed);
  std::array<char, 400> text{};
  std::string plain(
      text.data(),
      std::to_chars(text.data(), text.data() + text.size(), parsed, std::chars_format::fixed).ptr);
  const std::size_t first = plain.front() == '-' ? 1 : 0;
  for (std::size_t at = std::min(plain.find('.'), plain.size()); at > first + 3;) plain.insert(at -= 3, ",");
  return plain;
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char letter : text) {
    switch (letter) {
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '&':
        safe += "&amp;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += letter;
    }
  }
  return safe;
}

std::string named_cells(const std::string& table) {
  std::vector<std::string> names;
  std::string named;
  std::size_t at = 0, column = 0;
  const auto begins = [&](const char* tag) {
    return table.compare(at, std::string_view(tag).size(), tag) == 0;
  };
  while (at < table.size()) {
    if (begins("<tr")) column = 0;
    if (begins("<th>")) names.push_back(table.substr(at + 4, table.find("</th>", at) - at - 4));
    if (begins("<td") && column < names.size()) {
      named += "<td data-name=\"" + names[column++] + "\"";
      at += 3;
      continue;
    }
    named += table[at++];
  }
  return named;
}

std::string percent_plot(const std::string& title, const std::string& x_name, double x_least, double x_most,
                         const std::vector<PlotLine>& lines) {
  constexpr double kLeft = 44.0, kTop = 10.0, kWide = 340.0, kHigh = 220.0;
  constexpr std::size_t kNamesInRow = 3;
  const auto at_x = [&](double x) {
    const double part = std::log(std::max(x, x_least) / x_least) / std::log(x_most / x_least);
    return kLeft + kWide * std::min(part, 1.0);
  };
  const auto at_y = [&](double percent) { return kTop + kHigh * (1.0 - percent / 100.0); };
  const std::size_t legend_rows = (lines.size() + kNamesInRow - 1) / kNamesInRow;
  const double height = kTop + kHigh + 42.0 + 18.0 * static_cast<double>(legend_rows);
  std::string svg = "<p class=\"t\">" + escaped(title) + "</p>\n" +
                    format("<svg viewBox=\"0 0 400 %.0f\" width=\"520\" role=\"img\" aria-label=\"", height) +
                    escaped(title) + "\">";
  for (int percent = 0; percent <= 100; percent += 25)
    svg += format("<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%.1f\" y2=\"%.1f\" class=\"g\"/>", kLeft, kLeft + kWide,
                  at_y(percent), at_y(percent)) +
           format("<text x=\"%.1f\" y=\"%.1f\" class=\"n e\">%d %%</text>", kLeft - 4.0, at_y(percent) + 4.0,
                  percent);
  for (double decade = std::pow(10.0, std::ceil(std::log10(x_least) - 1e-9)); decade <= x_most * 1.0001;
       decade *= 10.0)
    svg += format("<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%.1f\" y2=\"%.1f\" class=\"g\"/>", at_x(decade),
                  at_x(decade), kTop, kTop + kHigh) +
           format("<text x=\"%.1f\" y=\"%.1f\" class=\"n m\">%s</text>", at_x(decade), kTop + kHigh + 15.0,
                  readable_number(decade).c_str());
  svg += format("<text x=\"%.1f\" y=\"%.1f\" class=\"n m\">", kLeft + 0.5 * kWide, kTop + kHigh + 32.0) +
         escaped(x_name) + "</text>";
  std::size_t named = 0;
  bool is_dashed = false;
  for (const PlotLine& line : lines) {
    is_dashed = !is_dashed;  // every second line, so that lines below remain visible
    svg += "<polyline fill=\"none\" stroke-width=\"2\"";
    if (is_dashed) svg += " stroke-dasharray=\"7 7\"";
    svg += " stroke=\"" + line.colour + "\" points=\"";
    for (const auto& [x, percent] : line.points) svg += format("%.1f,%.1f ", at_x(x), at_y(percent));
    const double legend_x = kLeft + kWide / kNamesInRow * static_cast<double>(named % kNamesInRow);
    const double legend_y = kTop + kHigh + 54.0 + 18.0 * static_cast<double>(named++ / kNamesInRow);
    svg += "\"/>" +
           format("<rect x=\"%.1f\" y=\"%.1f\" width=\"14\" height=\"4\" fill=\"", legend_x, legend_y - 6.0) +
           line.colour + "\"/>" +
           format("<text x=\"%.1f\" y=\"%.1f\" class=\"n\">", legend_x + 20.0, legend_y) +
           escaped(line.name) + "</text>";
  }
  return svg + "</svg>\n";
}

std::string share_cells(const ShareTable& table) {
  std::string html = "<table class=\"cells\"><caption>" + escaped(table.title) + "</caption><tr><th></th>";
  for (const std::string& column : table.columns) html += "<th>" + escaped(column) + "</th>";
  html += "</tr>\n";
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    html += "<tr><th>" + escaped(table.rows[row]) + "</th>";
    for (const double share : table.share[row]) {
      if (std::isnan(share)) {
        html += "<td>–</td>";
        continue;
      }
      html += format("<td style=\"background:rgba(214,40,40,%.2f)\">%.*f %%</td>", 0.75 * share,
                     share > 0.0 && share < 0.01 ? 1 : 0, 100.0 * share);
    }
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

}  // namespace roomradar
