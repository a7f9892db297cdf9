// intrinsics.cpp: the check that intrinsics read from outside must pass.
#include "mapping/types/intrinsics.hpp"

#include <string>

#include "mapping/types/error.hpp"

namespace roomradar {

void require_valid(const Intrinsics& camera, const char* where) {
  const auto fail = [&](const std::string& field, double value, const std::string& rule) {
    throw Error(std::string(where) + ": " + field + " = " + std::to_string(value) + ": must be " + rule);
  };
  constexpr int kMaxSize_px = 16384;  // what every GL renderer we know can draw in one pass
  if (camera.width_px < 1 || camera.width_px > kMaxSize_px) fail("width_px", camera.width_px, "in 1..16384");
  if (camera.height_px < 1 || camera.height_px > kMaxSize_px)
    fail("height_px", camera.height_px, "in 1..16384");
  if (!std::isfinite(camera.fx_px) || camera.fx_px <= 0) fail("fx_px", camera.fx_px, "finite and > 0");
  if (!std::isfinite(camera.fy_px) || camera.fy_px <= 0) fail("fy_px", camera.fy_px, "finite and > 0");
  if (!(camera.cx_px >= -camera.width_px && camera.cx_px <= 2 * camera.width_px))
    fail("cx_px", camera.cx_px, "within one image width of the image");
  if (!(camera.cy_px >= -camera.height_px && camera.cy_px <= 2 * camera.height_px))
    fail("cy_px", camera.cy_px, "within one image height of the image");
}

}  // namespace roomradar
