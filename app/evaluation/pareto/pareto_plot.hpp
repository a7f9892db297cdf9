// pareto_plot.hpp: plots time and error of settings with their Pareto front, as SVG text.
#pragma once
#include <string>
#include <vector>

namespace roomradar {

struct PlotDot {
  double x = 1.0, y = 0.0;
  double x_least = 1.0, x_most = 1.0;  ///< range of x, drawn as a line
  std::string title;                   ///< tooltip
  std::string label;                   ///< text beside the dot; may be empty
  bool is_default = false;
  bool is_preset = false;
  bool is_on_front = false;  ///< on this plot's Pareto front
};

struct ParetoPlot {
  std::string title = {}, x_name = {}, y_name = {};
  std::vector<PlotDot> dots = {};
};

/// Returns the plot. Both axes are logarithmic, but y is linear if any dot has y = 0. Dots that are not
/// finite are omitted. The front is drawn as a staircase. Dots above and to the right of it are dominated.
/// Colours are the page's CSS variables --ink --grid --dot --front --mark --paper.
std::string pareto_plot(const ParetoPlot& plot);

}  // namespace roomradar
