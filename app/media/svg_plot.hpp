// svg_plot.hpp: small charts as SVG text, to be put into a page.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace roomradar {

struct PlotLine {
  std::string name;
  std::string colour;                             ///< as CSS has it
  std::vector<std::pair<double, double>> points;  ///< x ascending
};

/// Lines over a logarithmic x axis, y in percent from 0 to 100, with a legend. Points with x below x_least
/// are drawn there.
std::string percent_plot(const std::string& title, const std::string& x_name, double x_least, double x_most,
                         const std::vector<PlotLine>& lines);

/// A table of shares as coloured cells: one row a name, one column a name, NaN for none.
struct ShareTable {
  std::string title;
  std::vector<std::string> rows, columns;
  std::vector<std::vector<double>> share;  ///< 0 to 1, [row][column]
};
std::string share_cells(const ShareTable& table);

/// `<`, `>`, `&` and quotes as HTML has them.
std::string escaped(const std::string& text);

}  // namespace roomradar
