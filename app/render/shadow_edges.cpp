// shadow_edges.cpp: assigns pixels along the edges of shadows to the nearer or farther surface.
#include "app/render/shadow_edges.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <tuple>
#include <vector>

#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

/// Returns true if the depths of two adjacent pixels belong to different surfaces.
bool is_jump(float a_m, float b_m) {
  constexpr float kJump = 0.02F;  // fraction of the depth; a table seen at 20 degrees: 0.005 per pixel
  return std::abs(a_m - b_m) > kJump * std::min(a_m, b_m);
}

constexpr std::uint8_t kNearEdge = 128, kNearShadowEdge = 255;

/// Marks the pixels of `rect` within reach_px of a depth edge: with kNearShadowEdge if pixels on its two
/// sides differ in light, else with kNearEdge.
MaskImage band_along_edges(const DepthImage& depth_m, const PixelRect& rect, int reach_px,
                           const Image<float>& light_left) {
  constexpr float kLightJump = 0.02F;  // smaller differences of light are not visible
  MaskImage band(rect.width, rect.height);
  const auto edge_between = [&](int x, int y, int xx, int yy) -> std::uint8_t {
    if (!band.contains(xx, yy)) return 0;
    if (!is_jump(depth_m.at(rect.x + x, rect.y + y), depth_m.at(rect.x + xx, rect.y + yy))) return 0;
    return std::abs(light_left.at(x, y) - light_left.at(xx, yy)) < kLightJump ? kNearEdge : kNearShadowEdge;
  };
  for (int y = 0; y < rect.height; ++y) {
    for (int x = 0; x < rect.width; ++x) {
      const std::uint8_t edge = std::max(edge_between(x, y, x + 1, y), edge_between(x, y, x, y + 1));
      if (edge == 0) continue;
      const int first = std::max(x - reach_px + 1, 0), end = std::min(x + reach_px + 1, rect.width);
      for (int v = std::max(y - reach_px + 1, 0); v < std::min(y + reach_px + 1, rect.height); ++v)
        for (int u = first; u < end; ++u) band.at(u, v) = std::max(band.at(u, v), edge);
    }
  }
  return band;
}

float squared_distance(const Rgb& a, const Rgb& b) {
  const int r = a.r - b.r, g = a.g - b.g, blue = a.b - b.b;
  return static_cast<float>(r * r + g * g + blue * blue);
}

/// A pixel near the one that is judged, at an offset in units of the window.
struct Neighbour {
  float z_m, dx, dy, weight;
};

/// Returns the depth at offset 0 of the plane through pixels of one surface, by weighted least squares:
/// inverse depth is linear in the image. The result is within the range of the pixels' depths.
/// @param surface  in ascending order of depth, not empty
float depth_of_plane(std::span<const Neighbour> surface) {
  constexpr double kLevel = 1e-3;  // without evidence, a surface faces the camera
  Eigen::Matrix3d A = Eigen::Vector3d(0.0, kLevel, kLevel).asDiagonal();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Neighbour& pixel : surface) {
    const Eigen::Vector3d row(1.0, static_cast<double>(pixel.dx), static_cast<double>(pixel.dy));
    A += static_cast<double>(pixel.weight) * row * row.transpose();
    b += static_cast<double>(pixel.weight / pixel.z_m) * row;
  }
  const auto z_m = static_cast<float>(1.0 / solve_symmetric(A, b)(0));
  return std::clamp(z_m, surface.front().z_m, surface.back().z_m);
}

/// Divides pixels into surfaces, between which there is a jump of depth, and returns the one of most weight.
std::span<const Neighbour> heaviest_surface(std::vector<Neighbour>& pixels) {
  std::sort(pixels.begin(), pixels.end(), [](const Neighbour& a, const Neighbour& b) {
    return std::tie(a.z_m, a.dy, a.dx) < std::tie(b.z_m, b.dy, b.dx);
  });
  std::span<const Neighbour> heaviest;
  float most = 0.0F;
  for (std::size_t first = 0, end = 0; first < pixels.size(); first = end) {
    float weight = pixels[first].weight;
    for (end = first + 1; end < pixels.size() && !is_jump(pixels[end - 1].z_m, pixels[end].z_m); ++end)
      weight += pixels[end].weight;
    if (weight <= most) continue;
    most = weight;
    heaviest = std::span(pixels).subspan(first, end - first);
  }
  return heaviest;
}

/// Sets each pixel with depth to the median of its neighbourhood of 3 x 3 pixels, of those with depth.
void remove_specks(DepthImage& depth_m) {
  const DepthImage before_m = depth_m;
  for (int y = 0; y < depth_m.height; ++y) {
    for (int x = 0; x < depth_m.width; ++x) {
      if (!(before_m.at(x, y) > 0.0F)) continue;
      std::array<float, 9> near_m;
      auto end = near_m.begin();
      for (int v = y - 1; v <= y + 1; ++v)
        for (int u = x - 1; u <= x + 1; ++u)
          if (before_m.contains(u, v) && before_m.at(u, v) > 0.0F) *end++ = before_m.at(u, v);
      const auto middle = near_m.begin() + (end - near_m.begin()) / 2;
      std::nth_element(near_m.begin(), middle, end);
      depth_m.at(x, y) = *middle;
    }
  }
}

}  // namespace

void align_shadow_edges(const ColourImage& camera_image, const DepthImage& depth_m, const PixelRect& rect,
                        int reach_px, const Image<float>& light_left, DepthImage& aligned_m) {
  constexpr int kStep_px = 3;                               // spacing of samples
  constexpr float kAlike2 = 2.0F * 144.0F, kUnlike = 5.0F;  // -log weight beyond which pixels are ignored
  aligned_m.resize(rect.width, rect.height);
  if (reach_px <= 0) return;
  const MaskImage band = band_along_edges(depth_m, rect, reach_px, light_left);
  const int window_px = 3 * reach_px;  // from one side of the band well beyond the other
  const auto unit_px = static_cast<float>(window_px);
  std::vector<Neighbour> pixels;
  for (int y = 0; y < rect.height; ++y) {
    for (int x = 0; x < rect.width; ++x) {
      if (band.at(x, y) != kNearShadowEdge) continue;
      const Rgb& colour = camera_image.at(rect.x + x, rect.y + y);
      pixels.clear();
      for (int v = y - window_px; v <= y + window_px; v += kStep_px) {
        for (int u = x - window_px; u <= x + window_px; u += kStep_px) {
          if (!band.contains(u, v) || band.at(u, v) != 0) continue;
          const float z_m = depth_m.at(rect.x + u, rect.y + v);
          if (!(z_m > 0.0F)) continue;
          const float dx = static_cast<float>(u - x) / unit_px, dy = static_cast<float>(v - y) / unit_px;
          const float unlike = squared_distance(camera_image.at(rect.x + u, rect.y + v), colour) / kAlike2 +
                               0.5F * (dx * dx + dy * dy);
          if (unlike < kUnlike) pixels.push_back({z_m, dx, dy, std::exp(-unlike)});
        }
      }
      if (!pixels.empty()) aligned_m.at(x, y) = depth_of_plane(heaviest_surface(pixels));
    }
  }
  remove_specks(aligned_m);
}

}  // namespace roomradar
