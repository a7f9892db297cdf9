// svg_plot.hpp: small charts as SVG text for HTML pages, and text formatting for them.
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

/// Returns a plot of lines, with the title above it as HTML text and a legend below it. The x axis is
/// logarithmic. y is in percent, from 0 to 100. Points with x below x_least are drawn at x_least.
std::string percent_plot(const std::string& title, const std::string& x_name, double x_least, double x_most,
                         const std::vector<PlotLine>& lines);

/// A table of fractions with row and column names. NaN: empty cell.
struct ShareTable {
  std::string title;
  std::vector<std::string> rows, columns;
  std::vector<std::vector<double>> share;  ///< 0 to 1, [row][column]
};
/// Returns the table as an HTML table whose cells are coloured by value.
std::string share_cells(const ShareTable& table);

/// Returns an HTML table with each cell's column heading as the attribute data-name, so that a style can show
/// the rows one below the other on a narrow screen. The first row of `table` must contain the headings.
std::string named_cells(const std::string& table);

/// Formats a number with `digits` (1..15) significant digits, commas between thousands and no exponent, such
/// as "2,250", "0.00123" or "-12". NaN and infinity become "nan" and "inf".
std::string readable_number(double value, int digits = 3);

/// Escapes `<`, `>`, `&` and double quotes for HTML.
std::string escaped(const std::string& text);

}  // namespace roomradar
