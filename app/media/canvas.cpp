// canvas.cpp: draws with OpenCV where it suffices, otherwise by hand.
#include "app/media/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace roomradar {
namespace {

/// Wraps the picture's pixels as RGB, without copying.
cv::Mat view_of(ColourImage& picture) {
  return {picture.height, picture.width, CV_8UC3, picture.pixels.data()};
}

cv::Scalar scalar(Rgb colour) {
  return {static_cast<double>(colour.r), static_cast<double>(colour.g), static_cast<double>(colour.b)};
}

constexpr double kFarAway_px = 1e4;  // coordinates are clamped to this, to fit OpenCV's integers

cv::Point fixed_point(const Eigen::Vector2d& p) {
  constexpr double kSixteenths = 16.0;
  const auto clamped = [](double of) { return std::clamp(of, -kFarAway_px, kFarAway_px); };
  return {static_cast<int>(std::lround(kSixteenths * clamped(p.x()))),
          static_cast<int>(std::lround(kSixteenths * clamped(p.y())))};
}

}  // namespace

void blend(ColourImage& picture, int x, int y, Rgb colour, double part) {
  if (!picture.contains(x, y)) return;
  Rgb& pixel = picture.at(x, y);
  const auto mixed = [part](std::uint8_t from, std::uint8_t to) {
    return static_cast<std::uint8_t>(std::lround((1.0 - part) * from + part * to));
  };
  pixel = {mixed(pixel.r, colour.r), mixed(pixel.g, colour.g), mixed(pixel.b, colour.b)};
}

void draw_line(ColourImage& picture, const Eigen::Vector2d& a, const Eigen::Vector2d& b, Rgb colour,
               int width_px) {
  if (picture.empty() || !a.allFinite() || !b.allFinite()) return;
  cv::Mat view = view_of(picture);
  cv::line(view, fixed_point(a), fixed_point(b), scalar(colour), width_px, cv::LINE_AA, 4);
}

void draw_text(ColourImage& picture, const std::string& text, int x, int y, double size, Rgb colour) {
  if (picture.empty()) return;
  cv::Mat view = view_of(picture);
  cv::putText(view, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, size, scalar(colour), 1, cv::LINE_AA);
}

void fill_triangle(MaskImage& mask, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                   const Eigen::Vector2d& c) {
  const auto cross = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
    return p.x() * q.y() - p.y() * q.x();
  };
  const double area = cross(b - a, c - a);
  if (!(std::abs(area) > 0.0)) return;  // also rejects corners that are not finite
  const Eigen::Vector2d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
  const auto within = [](double of, int most) {
    return static_cast<int>(std::clamp(of, 0.0, static_cast<double>(most)));
  };
  for (int y = within(std::ceil(low.y()), mask.height); y < mask.height && y <= high.y(); ++y)
    for (int x = within(std::ceil(low.x()), mask.width); x < mask.width && x <= high.x(); ++x) {
      const Eigen::Vector2d p(x, y);
      const double u = cross(p - a, c - a) / area, v = cross(b - a, p - a) / area;
      if (u >= 0.0 && v >= 0.0 && u + v <= 1.0) mask.at(x, y) = 255;
    }
}

void tint(ColourImage& picture, const MaskImage& mask, Rgb colour, double part) {
  const auto covered = [&](int x, int y) { return mask.contains(x, y) && mask.at(x, y) != 0; };
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      if (!covered(x, y)) continue;
      const bool inner = covered(x - 1, y) && covered(x + 1, y) && covered(x, y - 1) && covered(x, y + 1);
      blend(picture, x, y, colour, inner ? part : 1.0);
    }
}

void paste(const ColourImage& part, int x, int y, ColourImage& picture) {
  for (int row = 0; row < part.height; ++row)
    for (int column = 0; column < part.width; ++column)
      if (picture.contains(x + column, y + row)) picture.at(x + column, y + row) = part.at(column, row);
}

}  // namespace roomradar
