// lens_correction.cpp: one table per camera, from ideal to real pixels.
#include "app/sources/formats/lens_correction.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr double kRadiusStep = 0.005;
constexpr double kMaxRadius = 5.0;  // 79 degrees from the axis

/// Returns the radius up to which the lens is monotonic. Beyond it, polynomials fold the image back.
double monotonic_radius(const RationalLens& lens) {
  double last = 0.0;
  for (double radius = kRadiusStep; radius < kMaxRadius; radius += kRadiusStep) {
    const double there =
        distorted({radius, 0.0}, {lens.k1, lens.k2, 0, 0, lens.k3, lens.k4, lens.k5, lens.k6}).x;
    if (!(there > last)) return radius - kRadiusStep;
    last = there;
  }
  return kMaxRadius;
}

/// Returns the factor of the focal length that keeps the point at the normalised distorted coordinate `edge`
/// of one axis inside the image.
template <typename PointOnAxis>
double keeping_factor(double edge, double max_radius, const RationalLens& lens, const PointOnAxis& on_axis) {
  if (edge == 0.0) return 1.0;
  double low = 0.0, high = max_radius;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (std::abs(on_axis(std::copysign(middle, edge), lens)) < std::abs(edge) ? low : high) = middle;
  }
  return low > 0.0 ? std::abs(edge) / low : 1.0;
}

template <typename Pixel>
void remap(Image<Pixel>& image, Image<Pixel>& scratch, int type, const Image<float>& x, const Image<float>& y,
           int interpolation) {
  const auto table = [](const Image<float>& positions) {
    return cv::Mat(positions.height, positions.width, CV_32FC1, const_cast<float*>(positions.pixels.data()));
  };
  scratch.pixels.swap(image.pixels);
  image.resize(image.width, image.height);
  const cv::Mat real(image.height, image.width, type, scratch.pixels.data());
  cv::Mat ideal(image.height, image.width, type, image.pixels.data());
  cv::remap(real, ideal, table(x), table(y), interpolation, cv::BORDER_CONSTANT);
}

}  // namespace

PlanePoint<double> distorted(const PlanePoint<double>& p, const RationalLens& lens) {
  const double r2 = p.x * p.x + p.y * p.y;
  const double radial = (1.0 + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3))) /
                        (1.0 + r2 * (lens.k4 + r2 * (lens.k5 + r2 * lens.k6)));
  return {p.x * radial + 2.0 * lens.p1 * p.x * p.y + lens.p2 * (r2 + 2.0 * p.x * p.x),
          p.y * radial + lens.p1 * (r2 + 2.0 * p.y * p.y) + 2.0 * lens.p2 * p.x * p.y};
}

LensCorrection::LensCorrection(const Intrinsics& real, const RationalLens& lens, const char* where)
    : ideal_(real) {
  for (const double k : {lens.k1, lens.k2, lens.p1, lens.p2, lens.k3, lens.k4, lens.k5, lens.k6})
    if (!std::isfinite(k)) throw Error(std::string(where) + ": a coefficient of the lens is not finite");
  const double max_radius = monotonic_radius(lens);
  if (max_radius < 0.1)
    throw Error(std::string(where) + ": the coefficients of the lens fold the image at its centre");

  const auto along_x = [](double x, const RationalLens& l) { return distorted({x, 0.0}, l).x; };
  const auto along_y = [](double y, const RationalLens& l) { return distorted({0.0, y}, l).y; };
  const double left = -real.cx_px / real.fx_px, right = (real.width_px - 1 - real.cx_px) / real.fx_px;
  const double top = -real.cy_px / real.fy_px, bottom = (real.height_px - 1 - real.cy_px) / real.fy_px;
  const double factor = std::min(
      {1.0, keeping_factor(left, max_radius, lens, along_x), keeping_factor(right, max_radius, lens, along_x),
       keeping_factor(top, max_radius, lens, along_y), keeping_factor(bottom, max_radius, lens, along_y)});
  ideal_.fx_px *= std::max(factor, 0.5);
  ideal_.fy_px *= std::max(factor, 0.5);

  real_x_.resize(real.width_px, real.height_px);
  real_y_.resize(real.width_px, real.height_px);
  for (int y = 0; y < real.height_px; ++y)
    for (int x = 0; x < real.width_px; ++x) {
      const PlanePoint<double> p = {(x - ideal_.cx_px) / ideal_.fx_px, (y - ideal_.cy_px) / ideal_.fy_px};
      const PlanePoint<double> q = distorted(p, lens);
      const double u = real.fx_px * q.x + real.cx_px, v = real.fy_px * q.y + real.cy_px;
      const bool is_inside = p.x * p.x + p.y * p.y < max_radius * max_radius && u > -1.0 && v > -1.0 &&
                             u < real.width_px && v < real.height_px;
      real_x_.at(x, y) = is_inside ? static_cast<float>(u) : -10.0F;
      real_y_.at(x, y) = is_inside ? static_cast<float>(v) : -10.0F;
    }
}

void LensCorrection::correct(DepthImage& depth_m) {
  remap(depth_m, real_depth_m_, CV_32FC1, real_x_, real_y_, cv::INTER_NEAREST);
}

void LensCorrection::correct(ColourImage& colour) {
  remap(colour, real_colour_, CV_8UC3, real_x_, real_y_, cv::INTER_LINEAR);
}

}  // namespace roomradar
