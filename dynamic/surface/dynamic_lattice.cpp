// dynamic_lattice.cpp: fits planes to windows of 5 x 5 pixels, and averages opposite pixels.
#include "dynamic/surface/dynamic_lattice.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "mapping/types/depth_noise.hpp"

namespace roomradar {
namespace {

/// View ray of a lattice point, with the focal lengths.
struct Ray {
  float u, v;  // x / z, y / z
  float fx, fy;
  /// Returns the squared tangent of the angle between this ray and a plane's normal. The plane is given by
  /// its inverse depth here and the slopes of that (1/m per pixel).
  [[nodiscard]] float tangent2(float inverse_depth, float slope_x, float slope_y) const {
    const float a = slope_x * fx, b = slope_y * fy;
    const float c = inverse_depth - a * u - b * v;  // inverse depth = a u + b v + c, so the normal is (a, b,
                                                    // c)
    const float cosine2 = inverse_depth * inverse_depth / ((1.0F + u * u + v * v) * (a * a + b * b + c * c));
    return 1.0F / std::max(cosine2, 1e-6F) - 1.0F;
  }
};

struct Plane {
  float mean, slope_x, slope_y;
  float rms2;  // mean square of the residuals
};

/// Fits the least-squares plane through 5 x 5 values; reads 8 values of each row.
Plane fit(const float* top_left, std::size_t width) {
  const float middle = top_left[2 * width + 2];
  std::array<float, 8> sum{}, by_row{}, squares{};
  for (std::size_t row = 0; row < 5; ++row) {
    const float* value = top_left + row * width;
    const float weight = static_cast<float>(row) - 2.0F;
    for (std::size_t k = 0; k < 8; ++k) {
      const float d = value[k] - middle;
      sum[k] += d;
      by_row[k] += weight * d;
      squares[k] += d * d;
    }
  }
  const float all = sum[0] + sum[1] + sum[2] + sum[3] + sum[4];
  const float slope_x = (2.0F * (sum[4] - sum[0]) + sum[3] - sum[1]) / 50.0F;  // 50: sum of x^2
  const float slope_y = (by_row[0] + by_row[1] + by_row[2] + by_row[3] + by_row[4]) / 50.0F;
  const float all_squares = squares[0] + squares[1] + squares[2] + squares[3] + squares[4];
  const float rest = all_squares - all * all / 25.0F - 50.0F * (slope_x * slope_x + slope_y * slope_y);
  return {middle + all / 25.0F, slope_x, slope_y, std::max(rest, 0.0F) / 25.0F};
}

/// Returns the mean over pairs of opposite dynamic pixels that deviate from a line by noise only.
Plane mean_of_pairs(const float* middle, std::ptrdiff_t width, CellBits window, float sigma) {
  float bend = 0.0F, by_x = 0.0F, by_y = 0.0F;
  int pairs = 0, x2 = 0, y2 = 0;
  for (int k = 0; k < 12; ++k) {
    if ((window >> k & window >> (24 - k) & 1U) == 0) continue;
    const int dx = 2 - k % 5, dy = 2 - k / 5;
    const std::ptrdiff_t to = dy * width + dx;
    const float second = middle[to] + middle[-to] - 2.0F * middle[0];
    if (std::abs(second) > 6.0F * sigma) continue;  // one sigma of such a difference is sqrt(6) sigmas
    bend += second;
    const float difference = middle[to] - middle[-to];
    by_x += static_cast<float>(dx) * difference;
    by_y += static_cast<float>(dy) * difference;
    ++pairs, x2 += 2 * dx * dx, y2 += 2 * dy * dy;
  }
  return {middle[0] + bend / static_cast<float>(1 + 2 * pairs), by_x / static_cast<float>(std::max(x2, 1)),
          by_y / static_cast<float>(std::max(y2, 1)), 0.0F};
}

/// Averages each flat point with pairs of opposite flat neighbours, unless that would round off a bend.
void average_neighbours(DynamicLattice& lattice) {
  constexpr float kMostBend_sigmas = 1.5F;
  lattice.raw = lattice.inverse_depth;
  const auto columns = static_cast<std::ptrdiff_t>(lattice.columns);
  const std::array<std::ptrdiff_t, 4> opposite{1, columns, columns + 1, columns - 1};
  for (int row = 1; row + 1 < lattice.rows; ++row) {
    for (int column = 1; column + 1 < lattice.columns; ++column) {
      const std::size_t i = lattice.index(column, row);
      if (lattice.is_flat[i] == 0) continue;
      const float* raw = lattice.raw.data() + i;
      const std::uint8_t* is_flat = lattice.is_flat.data() + i;
      float bend = 0.0F;
      int count = 1;
      for (const std::ptrdiff_t to : opposite) {
        if ((is_flat[to] & is_flat[-to]) == 0) continue;
        const float second = raw[to] + raw[-to] - 2.0F * raw[0];
        if (std::abs(second) > kMostBend_sigmas * lattice.sigma[i]) continue;
        bend += second;
        count += 2;
      }
      lattice.inverse_depth[i] += bend / static_cast<float>(count);
    }
  }
}

}  // namespace

float smoothed_inverse_depth(const DynamicPixels& pixels, const InverseDepthNoise& noise, int x, int y) {
  const auto width = static_cast<std::ptrdiff_t>(pixels.smooth.width);
  const float* middle = pixels.inverse_depth.data() + y * width + x;
  return mean_of_pairs(middle, width, pixels.smooth.square(x - 2, y - 2), noise.sigma_per_m(*middle, 0.0F))
      .mean;
}

InverseDepthNoise::InverseDepthNoise(const DepthNoise& noise) : noise_(noise) {
  for (int i = 0; i < kSteps + 2; ++i) {
    const float angle = std::acos(std::min(static_cast<float>(i) / kSteps, 1.0F));
    grazing_by_cosine_[static_cast<std::size_t>(i)] =
        depth_sigma_m(noise, 1.0F, angle) - depth_sigma_m(noise, 1.0F);
  }
}

float InverseDepthNoise::sigma_per_m(float inverse_depth, float tangent2) const {
  const float z = 1.0F / inverse_depth;
  const float at = std::clamp(1.0F / std::sqrt(1.0F + tangent2), 0.0F, 1.0F) * kSteps;
  const int i = static_cast<int>(at);
  const auto k = static_cast<std::size_t>(i);
  const float grazing = grazing_by_cosine_[k] +
                        (at - static_cast<float>(i)) * (grazing_by_cosine_[k + 1] - grazing_by_cosine_[k]);
  return (depth_sigma_m(noise_, z) + grazing / std::sqrt(std::max(z, 0.1F))) * inverse_depth * inverse_depth;
}

void make_lattice(const DynamicPixels& pixels, const Intrinsics& camera, const DepthNoise& noise,
                  float flat_sigmas, DynamicLattice& lattice) {
  if (lattice.noise.model() != noise) lattice.noise = InverseDepthNoise(noise);
  const PixelBits& bits = pixels.smooth;
  constexpr int kSquare_px = kSquareCells * kCell_px;
  lattice.columns = (bits.width + kSquare_px - 1) / kSquare_px * kSquareCells + 1;
  lattice.rows = (bits.height + kSquare_px - 1) / kSquare_px * kSquareCells + 1;
  const auto size = static_cast<std::size_t>(lattice.columns) * static_cast<std::size_t>(lattice.rows);
  lattice.inverse_depth.assign(size, 0.0F);
  lattice.sigma.assign(size, 0.0F);
  lattice.is_flat.assign(size, 0);
  const auto width = static_cast<std::size_t>(bits.width);
  const auto fx = static_cast<float>(camera.fx_px), fy = static_cast<float>(camera.fy_px);
  for (int y = 0; y < bits.height; y += kCell_px) {
    const float v = (static_cast<float>(y) - static_cast<float>(camera.cy_px)) / fy;
    for (int x0 = 0; x0 < bits.width; x0 += 64) {
      constexpr std::uint64_t kEveryFourth = 0x1111111111111111U;
      for (std::uint64_t in = bits.row(y)[x0 >> 6] & kEveryFourth; in != 0; in &= in - 1) {
        const int x = x0 + std::countr_zero(in);
        const float* middle = pixels.inverse_depth.data() + static_cast<std::size_t>(y) * width + x;
        const Ray ray{(static_cast<float>(x) - static_cast<float>(camera.cx_px)) / fx, v, fx, fy};
        const CellBits window = bits.square(x - 2, y - 2);
        const std::size_t i = lattice.index(x / kCell_px, y / kCell_px);
        Plane plane{middle[0], 0.0F, 0.0F, 0.0F};
        if (window == kWholeCell) plane = fit(middle - 2 * width - 2, width);
        lattice.sigma[i] =
            lattice.noise.sigma_per_m(plane.mean, ray.tangent2(plane.mean, plane.slope_x, plane.slope_y));
        const float most = flat_sigmas * lattice.sigma[i];
        lattice.is_flat[i] = window == kWholeCell && plane.rms2 <= most * most;
        if (lattice.is_flat[i] == 0) {
          plane = mean_of_pairs(middle, static_cast<std::ptrdiff_t>(width), window,
                                lattice.noise.sigma_per_m(middle[0], 0.0F));
          lattice.sigma[i] =
              lattice.noise.sigma_per_m(plane.mean, ray.tangent2(plane.mean, plane.slope_x, plane.slope_y));
        }
        lattice.inverse_depth[i] = plane.mean;
      }
    }
  }
  average_neighbours(lattice);
}

}  // namespace roomradar
