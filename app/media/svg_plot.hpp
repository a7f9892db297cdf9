// svg_plot.hpp: small charts as SVG text, to be embedded in a web page.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace roomradar {

struct PlotLine {
  std::string name;
  std::string colour;                             ///< in CSS syntax
  std::vector<std::pair<double, double>> points;  ///< x ascending
};

/// Plots lines over a logarithmic x axis, y in percent from 0 to 100, with a legend. Points with x below
/// x_least are drawn at x_least.
std::string percent_plot(const std::string& title, const std::string& x_name, double x_least, double x_most,
                         const std::vector<PlotLine>& lines);

/// A table of fractions as coloured cells with row and column names; NaN: empty cell.
struct ShareTable {
  std::string title;
  std::vector<std::string> rows, columns;
  std::vector<std::vector<double>> share;  ///< 0 to 1, [row][column]
};
std::string share_cells(const ShareTable& table);

/// Formats a number for people: `digits` (1..15) significant digits, commas between thousands, no exponent:
/// "2,250", "0.00123", "-12". "nan" and "inf" for these.
std::string readable_number(double value, int digits = 3);

/// Escapes `<`, `>`, `&` and double quotes for HTML.
std::string escaped(const std::string& text);

}  // namespace roomradar
