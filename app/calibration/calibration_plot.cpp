// calibration_plot.cpp: draws four panels with OpenCV.
#include "app/calibration/calibration_plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>
#include <string>

#include "mapping/types/system/classic_locale.hpp"

namespace roomradar {
namespace {

constexpr int kPanelWidth_px = 600, kPanelHeight_px = 450, kMargin_px = 50;
constexpr double kShownAt_m = 2.0;  // depth at which the correction is plotted
const cv::Scalar kInk(40, 40, 40), kFaint(215, 215, 215), kBefore(200, 70, 50), kAfter(40, 90, 180);

/// A panel's frame and title, and the mapping from its values to pixels.
/// Values at the edges of a plot.
struct PlotRange {
  double left, right, bottom, top;
};

struct Panel {
  cv::Rect inside;
  PlotRange range;

  [[nodiscard]] cv::Point at(double x, double y) const {
    return {inside.x +
                static_cast<int>(std::lround((x - range.left) / (range.right - range.left) * inside.width)),
            inside.y +
                static_cast<int>(std::lround((range.top - y) / (range.top - range.bottom) * inside.height))};
  }
};

void write(cv::Mat& picture, const std::string& text, cv::Point at, const cv::Scalar& colour = kInk) {
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.45, colour, 1, cv::LINE_AA);
}

Panel make_panel(cv::Mat& picture, int column, int row, const std::string& title, const PlotRange& range) {
  const cv::Rect inside(column * kPanelWidth_px + kMargin_px, row * kPanelHeight_px + kMargin_px,
                        kPanelWidth_px - kMargin_px - 20, kPanelHeight_px - 2 * kMargin_px);
  cv::rectangle(picture, inside, kFaint);
  write(picture, title, {inside.x, inside.y - 12});
  return {inside, range};
}

/// Range of a panel that shows the pixels of an image.
PlotRange image_range(const Intrinsics& camera) {
  return {.left = 0.0,
          .right = static_cast<double>(camera.width_px),
          .bottom = static_cast<double>(camera.height_px),
          .top = 0.0};
}

void number(cv::Mat& picture, const char* format, double value, cv::Point at) {
  char text[32];
  format_classic(text, sizeof text, format, value);
  write(picture, text, at);
}

void draw_errors(cv::Mat& picture, const CalibrationFit& fit) {
  double far_m = 1.0, most_mm = 5.0;
  for (std::size_t i = 0; i < fit.after.size(); ++i) {
    far_m = std::max(far_m, 1.1 * fit.after[i].distance_m);
    most_mm = std::max(
        {most_mm, 1.1e3 * std::abs(fit.before[i].depth_bias_m), 1.1e3 * std::abs(fit.after[i].depth_bias_m)});
  }
  const Panel panel = make_panel(picture, 0, 1, "depth error of a view (mm, median) over distance (m)",
                                 {.left = 0.0, .right = far_m, .bottom = -most_mm, .top = most_mm});
  cv::line(picture, panel.at(0.0, 0.0), panel.at(far_m, 0.0), kFaint);
  number(picture, "%.0f", most_mm, {panel.inside.x - 36, panel.inside.y + 10});
  number(picture, "%.0f", -most_mm, {panel.inside.x - 36, panel.inside.y + panel.inside.height});
  number(picture, "%.1f m", far_m,
         {panel.inside.x + panel.inside.width - 40, panel.inside.y + panel.inside.height + 18});
  for (std::size_t i = 0; i < fit.after.size(); ++i) {
    const bool held_out = std::find(fit.held_out.begin(), fit.held_out.end(), i) != fit.held_out.end();
    cv::circle(picture, panel.at(fit.before[i].distance_m, 1e3 * fit.before[i].depth_bias_m), 3, kBefore,
               cv::FILLED, cv::LINE_AA);
    cv::circle(picture, panel.at(fit.after[i].distance_m, 1e3 * fit.after[i].depth_bias_m), held_out ? 5 : 3,
               kAfter, held_out ? 2 : cv::FILLED, cv::LINE_AA);
  }
  const int below = panel.inside.y + panel.inside.height + 18;
  write(picture, "before", {panel.inside.x, below}, kBefore);
  write(picture, "after", {panel.inside.x + 60, below}, kAfter);
  write(picture, "rings: held out of the fit", {panel.inside.x + 110, below}, kAfter);
}

void draw_correction(cv::Mat& picture, const Calibration& calibration) {
  const Intrinsics& camera = calibration.rig.depth_camera;
  const auto correction_mm = [&](double x_px, double y_px) {
    const double inverse =
        calibration.depth_correction.inverse_scale / kShownAt_m +
        offset_per_m(calibration.depth_correction, camera.width_px, camera.height_px, x_px, y_px);
    return 1e3 * (1.0 / inverse - kShownAt_m);
  };
  double most_mm = 1.0;
  for (int y = 0; y < camera.height_px; y += 8)
    for (int x = 0; x < camera.width_px; x += 8) most_mm = std::max(most_mm, std::abs(correction_mm(x, y)));
  char title[96];
  format_classic(title, sizeof title, "depth correction at 2 m: red farther, blue nearer, by up to %.0f mm",
                 most_mm);
  const Panel panel = make_panel(picture, 1, 1, title, image_range(camera));
  for (int row = 0; row < panel.inside.height; ++row)
    for (int column = 0; column < panel.inside.width; ++column) {
      const double part = correction_mm(static_cast<double>(column) / panel.inside.width * camera.width_px,
                                        static_cast<double>(row) / panel.inside.height * camera.height_px) /
                          most_mm;
      const auto fade = static_cast<std::uint8_t>(255.0 * (1.0 - std::min(std::abs(part), 1.0)));
      picture.at<cv::Vec3b>(panel.inside.y + row, panel.inside.x + column) =
          part > 0.0 ? cv::Vec3b(fade, fade, 255) : cv::Vec3b(255, fade, fade);
    }
}

}  // namespace

ColourImage calibration_plot(const BoardViews& views, const CalibrationFit& fit) {
  ColourImage plot(2 * kPanelWidth_px, 2 * kPanelHeight_px);
  cv::Mat picture(plot.height, plot.width, CV_8UC3, plot.pixels.data());  // RGB
  picture.setTo(cv::Scalar(255, 255, 255));
  const Intrinsics& colour = *fit.calibration.rig.colour_camera;
  const Intrinsics& depth = fit.calibration.rig.depth_camera;
  const Panel corners = make_panel(picture, 0, 0, "corners in the colour image", image_range(colour));
  const Panel samples = make_panel(picture, 1, 0, "the board in the depth image", image_range(depth));
  for (const BoardView& view : views.views) {
    for (const Eigen::Vector2d& corner : view.corners_px)
      cv::circle(picture, corners.at(corner.x(), corner.y()), 1, kAfter, cv::FILLED);
    for (const DepthSample& sample : view.depth)
      cv::circle(picture, samples.at(sample.x_px, sample.y_px), 1, kAfter, cv::FILLED);
  }
  draw_errors(picture, fit);
  draw_correction(picture, fit.calibration);
  return plot;
}

}  // namespace roomradar
