// shadow_edges.cpp: assigns pixels along the edges of shadows to the surfaces around them.
#include "app/render/shadow_edges.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <tuple>
#include <vector>

#include "app/render/edge_rules.hpp"
#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

constexpr std::uint8_t kNearEdge = 128, kNearShadowEdge = 255;

/// Marks the pixels within reach_px of a depth edge: with kNearShadowEdge if pixels on its two
/// sides differ in light, else with kNearEdge.
MaskImage band_along_edges(const DepthImage& depth_m, int reach_px, const Image<float>& light_left) {
  constexpr float kLightJump = 0.04F;  // smaller differences of light are hardly visible
  MaskImage band(depth_m.width, depth_m.height);
  const auto edge_between = [&](int x, int y, int xx, int yy) -> std::uint8_t {
    if (!band.contains(xx, yy)) return 0;
    if (!is_depth_jump(depth_m.at(x, y), depth_m.at(xx, yy))) return 0;
    return std::abs(light_left.at(x, y) - light_left.at(xx, yy)) < kLightJump ? kNearEdge : kNearShadowEdge;
  };
  for (int y = 0; y < band.height; ++y) {
    for (int x = 0; x < band.width; ++x) {
      const std::uint8_t edge = std::max(edge_between(x, y, x + 1, y), edge_between(x, y, x, y + 1));
      if (edge == 0) continue;
      const int first = std::max(x - reach_px + 1, 0), end = std::min(x + reach_px + 1, band.width);
      for (int v = std::max(y - reach_px + 1, 0); v < std::min(y + reach_px + 1, band.height); ++v)
        for (int u = first; u < end; ++u) band.at(u, v) = std::max(band.at(u, v), edge);
    }
  }
  return band;
}

/// A pixel away from depth edges.
struct Sample {
  int x, y;  ///< in the rectangle
  float z_m;
  Rgb colour;
};

/// Weighted least squares of a plane through samples, whose inverse depth is linear in the image.
struct Plane {
  Eigen::Matrix3f A = Eigen::Matrix3f::Zero();
  Eigen::Vector3f b = Eigen::Vector3f::Zero();
  float nearest_m = 0.0F, farthest_m = 0.0F;

  [[nodiscard]] float weight() const { return A(0, 0); }

  /// Adds a sample at an offset in units of the window. Samples come in ascending order of depth.
  void add(float dx, float dy, float z_m, float sample_weight) {
    const Eigen::Vector3f row(1.0F, dx, dy);
    A += sample_weight * row * row.transpose();
    b += sample_weight / z_m * row;
    if (nearest_m == 0.0F) nearest_m = z_m;
    farthest_m = z_m;
  }

  /// Returns the depth at offset 0, within the range of the samples' depths.
  [[nodiscard]] float depth_m() const {
    constexpr double kLevel = 1e-3;  // without evidence, a surface faces the camera
    Eigen::Matrix3d regular = A.cast<double>();
    regular.diagonal().tail<2>().array() += kLevel;
    const auto z_m = static_cast<float>(1.0 / solve_symmetric(regular, b.cast<double>())(0));
    return std::clamp(z_m, nearest_m, farthest_m);
  }
};

/// Returns the depth of the surface that a pixel belongs to, by its colour; 0 if no sample is similar.
/// Surfaces are samples between which there is no jump of depth.
/// @param samples  in ascending order of depth
float depth_of_pixel(std::span<const Sample> samples, int x, int y, const Rgb& colour, int window_px) {
  constexpr float kUnlike = 5.0F;  // -log weight beyond which samples are ignored
  const float unit = 1.0F / static_cast<float>(window_px);
  Plane heaviest, plane;
  for (const Sample& sample : samples) {
    const float dx = static_cast<float>(sample.x - x) * unit, dy = static_cast<float>(sample.y - y) * unit;
    const float unlike = squared_distance(sample.colour, colour) / kAlike2 + 0.5F * (dx * dx + dy * dy);
    if (unlike > kUnlike) continue;
    if (is_depth_jump(plane.farthest_m, sample.z_m)) {
      if (plane.weight() > heaviest.weight()) heaviest = plane;
      plane = {};
    }
    plane.add(dx, dy, sample.z_m, std::exp(-unlike));
  }
  if (plane.weight() > heaviest.weight()) heaviest = plane;
  return heaviest.weight() > 0.0F ? heaviest.depth_m() : 0.0F;
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

bool align_shadow_edges(const ColourImage& camera_image, const PixelRect& rect, const DepthImage& depth_m,
                        int reach_px, const Image<float>& light_left, DepthImage& aligned_m) {
  constexpr int kStep_px = 3;  // spacing of samples
  constexpr int kCell_px = 4;  // pixels of a cell share the samples
  aligned_m.resize(rect.width, rect.height);
  if (reach_px <= 0) return false;
  const MaskImage band = band_along_edges(depth_m, reach_px, light_left);
  bool has_edges = false;
  const int window_px = 3 * reach_px;  // from one side of the band well beyond the other
  std::vector<Sample> samples;
  const auto find_samples = [&](int x, int y) {
    samples.clear();
    for (int v = std::max(y - window_px, 0); v <= std::min(y + window_px, rect.height - 1); v += kStep_px) {
      for (int u = std::max(x - window_px, 0); u <= std::min(x + window_px, rect.width - 1); u += kStep_px) {
        const float z_m = depth_m.at(u, v);
        if (band.at(u, v) == 0 && z_m > 0.0F)
          samples.push_back({u, v, z_m, camera_image.at(rect.x + u, rect.y + v)});
      }
    }
    std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) {
      return std::tie(a.z_m, a.y, a.x) < std::tie(b.z_m, b.y, b.x);
    });
  };
  for (int cell_y = 0; cell_y < rect.height; cell_y += kCell_px) {
    for (int cell_x = 0; cell_x < rect.width; cell_x += kCell_px) {
      bool has_samples = false;
      for (int y = cell_y; y < std::min(cell_y + kCell_px, rect.height); ++y) {
        for (int x = cell_x; x < std::min(cell_x + kCell_px, rect.width); ++x) {
          if (band.at(x, y) != kNearShadowEdge) continue;
          if (!has_samples) find_samples(cell_x + kCell_px / 2, cell_y + kCell_px / 2);
          has_samples = has_edges = true;
          aligned_m.at(x, y) =
              depth_of_pixel(samples, x, y, camera_image.at(rect.x + x, rect.y + y), window_px);
        }
      }
    }
  }
  if (has_edges) remove_specks(aligned_m);
  return has_edges;
}

}  // namespace roomradar
