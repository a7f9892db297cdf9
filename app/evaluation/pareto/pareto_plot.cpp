// pareto_plot.cpp: draws axes with round numbers, dots and the front's steps.
#include "app/evaluation/pareto/pareto_plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/media/svg_plot.hpp"
#include "mapping/types/system/classic_locale.hpp"

namespace roomradar {
namespace {

// On a screen of 400 px a letter is 10 px high.
constexpr double kWidth = 440.0, kHeight = 320.0, kLeft = 62.0, kTop = 14.0, kRight = 16.0, kBottom = 48.0;

template <typename... Numbers>
std::string format(const char* text, Numbers... numbers) {
  char line[320];
  format_classic(line, sizeof line, text, numbers...);
  return line;
}

/// Maps values to pixels.
struct Axis {
  double least = 1.0, most = 10.0;
  bool is_logarithmic = true;
  double from_px = 0.0, to_px = 1.0;

  [[nodiscard]] double at(double value) const {
    const auto scaled = [&](double v) { return is_logarithmic ? std::log(v) : v; };
    return from_px + (to_px - from_px) * (scaled(value) - scaled(least)) / (scaled(most) - scaled(least));
  }
  /// Returns 1, 2, 5 times powers of ten, with finer steps on a short logarithmic axis; about five on a
  /// linear axis.
  [[nodiscard]] std::vector<double> ticks() const {
    std::vector<double> ticks;
    if (!is_logarithmic) {
      const double rough = (most - least) / 5.0;
      const double power = std::pow(10.0, std::floor(std::log10(rough)));
      double step = 10.0 * power;
      for (const double times : {5.0, 2.0, 1.0})
        if (times * power >= rough) step = times * power;
      for (double tick = std::ceil(least / step) * step; tick <= most * 1.0001; tick += step)
        ticks.push_back(tick);
      return ticks;
    }
    const std::vector<double> coarse{1.0, 2.0, 5.0}, fine{1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0};
    for (double decade = std::pow(10.0, std::floor(std::log10(least))); decade <= most; decade *= 10.0)
      for (const double times : most / least < 12.0 ? fine : coarse)
        if (times * decade >= least && times * decade <= most) ticks.push_back(times * decade);
    return ticks;
  }
};

/// Returns an axis over all values, with a margin.
Axis axis_over(std::vector<double> values, double from_px, double to_px) {
  Axis axis{.from_px = from_px, .to_px = to_px};
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  axis.is_logarithmic = *least > 0.0;
  if (axis.is_logarithmic) {
    const double margin = std::max(1.06, std::pow(*most / *least, 0.06));
    axis.least = *least / margin;
    axis.most = *most * margin;
  } else {
    axis.most = *most > 0.0 ? 1.08 * *most : 1.0;
    axis.least = -0.04 * axis.most;
  }
  return axis;
}

std::string grid(const ParetoPlot& plot, const Axis& x, const Axis& y) {
  std::string svg;
  for (const double tick : y.ticks())
    svg += format("<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%.1f\" y2=\"%.1f\" class=\"grid\"/>", x.from_px,
                  x.to_px, y.at(tick), y.at(tick)) +
           format("<text x=\"%.1f\" y=\"%.1f\" class=\"tick end\">%s</text>", x.from_px - 6.0,
                  y.at(tick) + 4.0, readable_number(tick).c_str());
  for (const double tick : x.ticks())
    svg += format("<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%.1f\" y2=\"%.1f\" class=\"%s\"/>", x.at(tick),
                  x.at(tick), y.from_px, y.to_px, tick == 1.0 ? "grid one" : "grid") +
           format("<text x=\"%.1f\" y=\"%.1f\" class=\"tick middle\">%s</text>", x.at(tick), y.from_px + 16.0,
                  readable_number(tick).c_str());
  return svg +
         format("<text x=\"%.1f\" y=\"%.1f\" class=\"tick middle\">", 0.5 * (x.from_px + x.to_px),
                kHeight - 10.0) +
         escaped(plot.x_name) + "</text>" +
         format("<text transform=\"translate(14 %.1f) rotate(-90)\" class=\"tick middle\">",
                0.5 * (y.from_px + y.to_px)) +
         escaped(plot.y_name) + "</text>";
}

std::string steps(const std::vector<PlotDot>& dots, const Axis& x, const Axis& y) {
  std::vector<const PlotDot*> front;
  for (const PlotDot& dot : dots)
    if (dot.is_on_front) front.push_back(&dot);
  if (front.empty()) return {};
  std::sort(front.begin(), front.end(), [](const PlotDot* a, const PlotDot* b) { return a->x < b->x; });
  std::string points = format("%.1f,%.1f ", x.at(front.front()->x), y.to_px);
  for (std::size_t i = 0; i < front.size(); ++i) {
    if (i > 0) points += format("%.1f,%.1f ", x.at(front[i]->x), y.at(front[i - 1]->y));
    points += format("%.1f,%.1f ", x.at(front[i]->x), y.at(front[i]->y));
  }
  points += format("%.1f,%.1f", x.to_px, y.at(front.back()->y));
  return "<polyline class=\"front\" points=\"" + points + "\"/>";
}

std::string drawn(const PlotDot& dot, const Axis& x, const Axis& y) {
  const double at_x = x.at(dot.x), at_y = y.at(dot.y);
  std::string svg = "<g><title>" + escaped(dot.title) + "</title>";
  svg += format("<line class=\"spread\" x1=\"%.1f\" x2=\"%.1f\" y1=\"%.1f\" y2=\"%.1f\"/>",
                x.at(std::max(dot.x_least, x.least)), x.at(std::min(dot.x_most, x.most)), at_y, at_y);
  if (dot.is_default) svg += format("<circle class=\"ring\" cx=\"%.1f\" cy=\"%.1f\" r=\"9\"/>", at_x, at_y);
  if (dot.is_preset)
    svg += format(
        "<rect class=\"preset\" x=\"-6\" y=\"-6\" width=\"12\" height=\"12\" "
        "transform=\"translate(%.1f %.1f) rotate(45)\"/>",
        at_x, at_y);
  else
    svg += format("<circle class=\"%s\" cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\"/>",
                  dot.is_on_front ? "dot best" : "dot", at_x, at_y, dot.is_on_front ? 5.0 : 3.5);
  if (!dot.label.empty()) {
    constexpr double kLetter = 7.5;
    const bool is_far_right = at_x + 11.0 + kLetter * static_cast<double>(dot.label.size()) > x.to_px;
    svg += format("<text x=\"%.1f\" y=\"%.1f\" class=\"%s\">", at_x + (is_far_right ? -11.0 : 11.0),
                  at_y - 8.0, is_far_right ? "label end" : "label") +
           escaped(dot.label) + "</text>";
  }
  return svg + "</g>\n";
}

}  // namespace

std::string pareto_plot(const ParetoPlot& plot) {
  std::vector<PlotDot> dots;
  std::vector<double> xs{1.0}, ys;
  for (const PlotDot& dot : plot.dots) {
    if (!(std::isfinite(dot.x) && std::isfinite(dot.y) && dot.x > 0.0 && dot.y >= 0.0)) continue;
    dots.push_back(dot);
    xs.push_back(dot.x);
    ys.push_back(dot.y);
  }
  if (dots.empty()) return "<p>" + escaped(plot.title) + ": nothing was measured.</p>\n";
  const Axis x = axis_over(std::move(xs), kLeft, kWidth - kRight);
  const Axis y = axis_over(std::move(ys), kHeight - kBottom, kTop);
  // As text of the page, which a narrow screen wraps.
  std::string svg = "<p class=\"title\">" + escaped(plot.title) + "</p>\n" +
                    format("<svg viewBox=\"0 0 %.0f %.0f\" role=\"img\" aria-label=\"", kWidth, kHeight) +
                    escaped(plot.title) + "\">";
  svg += grid(plot, x, y) + steps(dots, x, y);
  // Important dots last, so they are drawn on top.
  std::stable_sort(dots.begin(), dots.end(), [](const PlotDot& a, const PlotDot& b) {
    const auto rank = [](const PlotDot& d) {
      return d.is_preset || d.is_default ? 2 : d.is_on_front ? 1 : 0;
    };
    return rank(a) < rank(b);
  });
  for (const PlotDot& dot : dots) svg += drawn(dot, x, y);
  return svg + "</svg>\n";
}

}  // namespace roomradar
