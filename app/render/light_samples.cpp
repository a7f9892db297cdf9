// light_samples.cpp: picks surface points evenly over the image, with normals from the map's depth.
#include "app/render/light_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace roomradar {
namespace {

constexpr int kReach_px = 2;  // distance of the neighbours that determine a normal

/// Returns the normal towards the camera at a pixel, in the camera's frame, if its neighbourhood is smooth.
std::optional<Eigen::Vector3d> normal_at(const DepthImage& depth_m, const Intrinsics& camera, int x, int y) {
  constexpr float kBend = 0.004F;  // fraction of depth by which a smooth surface deviates from its tangent
  constexpr double kGrazing = 0.15;
  const float z_m = depth_m.at(x, y);
  const float left_m = depth_m.at(x - kReach_px, y), right_m = depth_m.at(x + kReach_px, y);
  const float above_m = depth_m.at(x, y - kReach_px), below_m = depth_m.at(x, y + kReach_px);
  if (!(std::min({z_m, left_m, right_m, above_m, below_m}) > 0.0F)) return std::nullopt;
  // Inverse depth is linear in the image on a plane.
  const auto bend = [&](float a_m, float b_m) { return std::abs(z_m * (0.5F / a_m + 0.5F / b_m) - 1.0F); };
  if (!(bend(left_m, right_m) < kBend && bend(above_m, below_m) < kBend)) return std::nullopt;
  const auto point = [&](int u, int v, float at_m) { return back_project(camera, u, v, at_m); };
  const Eigen::Vector3d across = point(x + kReach_px, y, right_m) - point(x - kReach_px, y, left_m);
  const Eigen::Vector3d down = point(x, y + kReach_px, below_m) - point(x, y - kReach_px, above_m);
  const Eigen::Vector3d normal = down.cross(across).normalized();
  const double facing = -normal.dot(point(x, y, z_m).normalized());
  if (!(facing > kGrazing)) return std::nullopt;
  return normal;
}

/// Returns the logarithm of the mean linear colour of 3 x 3 pixels, unless one is saturated or it is almost
/// black.
std::optional<Eigen::Vector3f> log_colour_at(const ColourImage& colour, int x, int y) {
  constexpr int kSaturated = 251;
  constexpr float kBlack = 0.0015F;  // 10 of 255
  if (x < 1 || y < 1 || x + 1 >= colour.width || y + 1 >= colour.height) return std::nullopt;
  std::array<int, 3> sum{};
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u) {
      const Rgb& pixel = colour.at(u, v);
      if (std::max({pixel.r, pixel.g, pixel.b}) >= kSaturated) return std::nullopt;
      sum[0] += pixel.r * pixel.r;
      sum[1] += pixel.g * pixel.g;
      sum[2] += pixel.b * pixel.b;
    }
  Eigen::Vector3f linear(static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2]));
  linear /= 9.0F * 255.0F * 255.0F;
  if (linear.minCoeff() < kBlack) return std::nullopt;
  return linear.array().log().matrix();
}

bool agrees(const SurfaceView& surface, int x, int y) {
  if (!surface.dynamic_mask.empty() && surface.dynamic_mask.at(x, y) != 0) return false;
  const int factor = surface.measured_m.width / surface.expected_m.width;
  const float z_m = surface.expected_m.at(x, y);
  const float measured_m = surface.measured_m.at(x * factor, y * factor);
  return measured_m > 0.0F && std::abs(measured_m - z_m) < 0.02F + 0.01F * z_m * z_m;
}

bool sizes_match(const ColourView& colour, const SurfaceView& surface) {
  const DepthImage& expected_m = surface.expected_m;
  const DepthImage& measured_m = surface.measured_m;
  if (colour.colour.empty() || expected_m.empty() || measured_m.empty()) return false;
  if (colour.colour.width != colour.camera.width_px || colour.colour.height != colour.camera.height_px)
    return false;
  const int factor = measured_m.width / expected_m.width;
  return factor >= 1 && measured_m.height >= factor * expected_m.height &&
         (surface.dynamic_mask.empty() || (surface.dynamic_mask.width == expected_m.width &&
                                           surface.dynamic_mask.height == expected_m.height));
}

/// Returns the sample at a pixel of the depth image, without its reach.
std::optional<LightSample> sample_at(const ColourView& colour, const SurfaceView& surface,
                                     const Eigen::Isometry3d& T_colour_depth, int x, int y) {
  const float z_m = surface.expected_m.at(x, y);
  if (!(z_m > 0.0F) || !agrees(surface, x, y)) return std::nullopt;
  const std::optional<Eigen::Vector3d> normal = normal_at(surface.expected_m, surface.camera, x, y);
  if (!normal) return std::nullopt;
  const Eigen::Vector3d p_camera = back_project(surface.camera, x, y, z_m);
  const Eigen::Vector3d p_colour = T_colour_depth * p_camera;
  if (!(p_colour.z() > 0.0)) return std::nullopt;
  const Eigen::Vector2d pixel = project(colour.camera, p_colour);
  if (!(pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() < colour.camera.width_px &&
        pixel.y() < colour.camera.height_px))
    return std::nullopt;
  const auto log_colour =
      log_colour_at(colour.colour, static_cast<int>(pixel.x() + 0.5), static_cast<int>(pixel.y() + 0.5));
  if (!log_colour) return std::nullopt;
  return LightSample{(surface.T_world_camera * p_camera).cast<float>(),
                     (surface.T_world_camera.linear() * *normal).cast<float>(),
                     *log_colour,
                     {}};
}

}  // namespace

void take_light_samples(const ColourView& colour, const SurfaceView& surface, int wanted,
                        std::uint64_t& position, std::vector<LightSample>& samples) {
  constexpr int kLooks = 4;
  constexpr double kStepX = 0.7548776662466927, kStepY = 0.5698402909980532;
  samples.clear();
  if (wanted <= 0 || !sizes_match(colour, surface)) return;
  const int width = surface.expected_m.width - 2 * kReach_px;
  const int height = surface.expected_m.height - 2 * kReach_px;
  if (width <= 0 || height <= 0) return;
  const Eigen::Isometry3d T_colour_depth = colour.T_world_camera.inverse() * surface.T_world_camera;
  for (int look = 0; look < kLooks * wanted && samples.size() < static_cast<std::size_t>(wanted); ++look) {
    const auto at = static_cast<double>(++position);
    const auto pixel = [&](double step, int size) {
      return kReach_px + std::min(static_cast<int>(std::fmod(at * step, 1.0) * size), size - 1);
    };
    if (const auto sample =
            sample_at(colour, surface, T_colour_depth, pixel(kStepX, width), pixel(kStepY, height)))
      samples.push_back(*sample);
  }
}

}  // namespace roomradar
