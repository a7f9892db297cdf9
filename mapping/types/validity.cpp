// validity.cpp: rules for cameras and frames from outside.
#include "mapping/types/validity.hpp"

#include <cmath>
#include <optional>
#include <string>

#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

struct Fault {
  const char* field;
  double value;
  const char* rule;
};

std::optional<Fault> projection_fault(const Intrinsics& c) {
  if (!(std::isfinite(c.fx_px) && c.fx_px > 0.0)) return Fault{"fx_px", c.fx_px, "finite and > 0"};
  if (!(std::isfinite(c.fy_px) && c.fy_px > 0.0)) return Fault{"fy_px", c.fy_px, "finite and > 0"};
  if (!std::isfinite(c.cx_px)) return Fault{"cx_px", c.cx_px, "finite"};
  if (!std::isfinite(c.cy_px)) return Fault{"cy_px", c.cy_px, "finite"};
  return std::nullopt;
}

std::optional<Fault> fault_of(const Intrinsics& c) {
  constexpr int kMaxSize_px = 16384;  // all GL renderers known to us can draw this in one pass
  const auto is_size = [](int size_px) { return size_px >= 1 && size_px <= kMaxSize_px; };
  const auto is_near = [](double centre_px, int size_px) {
    return centre_px >= -size_px && centre_px <= 2.0 * size_px;
  };
  if (!is_size(c.width_px)) return Fault{"width_px", static_cast<double>(c.width_px), "in 1..16384"};
  if (!is_size(c.height_px)) return Fault{"height_px", static_cast<double>(c.height_px), "in 1..16384"};
  if (const auto fault = projection_fault(c)) return fault;
  if (!is_near(c.cx_px, c.width_px)) return Fault{"cx_px", c.cx_px, "within one image width of the image"};
  if (!is_near(c.cy_px, c.height_px)) return Fault{"cy_px", c.cy_px, "within one image height of the image"};
  return std::nullopt;
}

template <typename Pixel>
bool fits(const Image<Pixel>& image, const Intrinsics& camera) {
  return image.width == camera.width_px && image.height == camera.height_px &&
         image.pixels.size() ==
             static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

}  // namespace

bool can_project(const Intrinsics& camera) { return !projection_fault(camera); }

bool is_valid(const Intrinsics& camera) { return !fault_of(camera); }

void require_valid(const Intrinsics& camera, const char* where) {
  if (const auto fault = fault_of(camera))
    throw Error(std::string(where) + ": " + fault->field + " = " + format_number(fault->value) +
                ": must be " + fault->rule);
}

bool is_rigid(const Eigen::Isometry3d& T, double tolerance) {
  const Eigen::Matrix3d R = T.linear();
  return T.matrix().allFinite() && T.matrix().row(3) == Eigen::RowVector4d(0, 0, 0, 1) &&
         (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < tolerance &&
         R.determinant() > 0.0;
}

std::string_view depth_fault_of(const Frame& frame) {
  if (!is_valid(frame.depth_camera)) return "its depth camera is invalid";
  if (!fits(frame.depth_m, frame.depth_camera)) return "its depth image and its depth camera differ in size";
  return {};
}

std::string_view fault_of(const Frame& frame) {
  const std::string_view of_depth = depth_fault_of(frame);
  if (!of_depth.empty() || frame.colour.empty()) return of_depth;
  if (!is_valid(frame.colour_camera)) return "its colour camera is invalid";
  if (!fits(frame.colour, frame.colour_camera))
    return "its colour image and its colour camera differ in size";
  return {};
}

}  // namespace roomradar
