// pareto_plot.hpp: settings as dots over time and error, with the front drawn, as SVG text.
#pragma once
#include <string>
#include <vector>

namespace roomradar {

struct PlotDot {
  double x = 1.0, y = 0.0;
  double x_least = 1.0, x_most = 1.0;  ///< spread; drawn as a line
  std::string title;                   ///< shown where the mouse rests on it
  std::string label;                   ///< beside it; may be empty
  bool is_default = false;
  bool is_preset = false;
  bool is_on_front = false;  ///< of this plot
};

struct ParetoPlot {
  std::string title = {}, x_name = {}, y_name = {};
  std::vector<PlotDot> dots = {};
};

/// Both axes are logarithmic; y is linear where a dot's is 0. Dots that are not finite are left out. The
/// front goes from dot to dot by steps: what lies above and to the right of it is beaten by something on it.
/// Colours are the page's: CSS variables --ink --grid --dot --front --mark --paper.
std::string pareto_plot(const ParetoPlot& plot);

}  // namespace roomradar
