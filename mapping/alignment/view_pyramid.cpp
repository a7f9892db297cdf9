// view_pyramid.cpp: downsamples depth without averaging across discontinuities, and registers intensity to
// depth.
#include "mapping/alignment/view_pyramid.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roomradar {
namespace {

float inverse_depth(float depth_m, const ViewConfig& config) {
  return depth_m >= config.min_depth_m && depth_m <= config.max_depth_m ? 1.0F / depth_m : 0.0F;
}

/// Returns the mean of those of four inverse depths that lie on the nearest surface; 0 if fewer than two do.
float nearest_surface(float a, float b, float c, float d) {
  const float least = std::max({a, b, c, d}) * (1.0F - kSameSurface);
  float sum = 0.0F;
  int count = 0;
  for (const float q : {a, b, c, d}) {
    if (q > least) {
      sum += q;
      ++count;
    }
  }
  return count >= 2 ? sum / static_cast<float>(count) : 0.0F;
}

/// Halves the size of an inverse depth image. `value` converts an input pixel to inverse depth.
template <typename Value>
void halve(const Image<float>& fine, const Value& value, Image<float>& coarse) {
  coarse.resize(fine.width / 2, fine.height / 2);
  for (int y = 0; y < coarse.height; ++y) {
    const float* upper = fine.row(2 * y);
    const float* lower = fine.row(2 * y + 1);
    float* out = coarse.row(y);
    for (int x = 0; x < coarse.width; ++x) {
      out[x] = nearest_surface(value(upper[2 * x]), value(upper[2 * x + 1]), value(lower[2 * x]),
                               value(lower[2 * x + 1]));
    }
  }
}

/// Halves the size of an intensity image; averages only pixels on the surface of the coarse depth.
void halve_intensity_of(const ViewPyramid::Level& fine, ViewPyramid::Level& coarse) {
  coarse.intensity.resize(coarse.camera.width_px, coarse.camera.height_px, -1.0F);
  for (int y = 0; y < coarse.camera.height_px; ++y) {
    for (int x = 0; x < coarse.camera.width_px; ++x) {
      const float q = coarse.inverse_depth_per_m.at(x, y);
      if (q <= 0.0F) continue;
      float sum = 0.0F;
      int count = 0;
      for (int dy = 0; dy < 2; ++dy) {
        for (int dx = 0; dx < 2; ++dx) {
          const std::size_t i = fine.intensity.index(2 * x + dx, 2 * y + dy);
          const bool same = std::abs(fine.inverse_depth_per_m.pixels[i] - q) < kSameSurface * q;
          if (!same || fine.intensity.pixels[i] < 0.0F) continue;
          sum += fine.intensity.pixels[i];
          ++count;
        }
      }
      if (count > 0) coarse.intensity.at(x, y) = sum / static_cast<float>(count);
    }
  }
}

/// Averages the intensity over blocks of `block` x `block` colour pixels.
void block_grey(const ColourImage& colour, int block, Image<float>& grey) {
  grey.resize(colour.width / block, colour.height / block);
  const float scale = 1.0F / static_cast<float>(256 * block * block);
  for (int y = 0; y < grey.height; ++y) {
    float* out = grey.row(y);
    for (int x = 0; x < grey.width; ++x) {
      int sum = 0;
      for (int dy = 0; dy < block; ++dy) {
        const Rgb* in = colour.row(y * block + dy) + x * block;
        for (int dx = 0; dx < block; ++dx) sum += 77 * in[dx].r + 150 * in[dx].g + 29 * in[dx].b;
      }
      out[x] = static_cast<float>(sum) * scale;
    }
  }
}

/// Registers the colour image's intensity to the depth pixels; -1 outside the colour camera's view.
void register_intensity(const Frame& frame, int block, const FrameMotion& motion, Image<float>& grey,
                        ViewPyramid::Level& level) {
  block_grey(frame.colour, block, grey);
  const auto& [velocity, timing] = motion;
  const auto delay_s = static_cast<float>(frame.colour_after_depth_s + timing.colour_delay_s);
  const auto depth_row_s = static_cast<float>(timing.depth_readout_s / level.camera.height_px);
  const float colour_row_s = static_cast<float>(timing.colour_readout_s) / static_cast<float>(grey.height);
  const float depth_middle = 0.5F * static_cast<float>(level.camera.height_px - 1);
  const float colour_middle = 0.5F * static_cast<float>(grey.height - 1);
  const Intrinsics colour = scaled(frame.colour_camera, 1.0 / block);
  const Eigen::Matrix3f R = frame.T_colour_depth.linear().cast<float>();
  const Eigen::Vector3f t = frame.T_colour_depth.translation().cast<float>();
  const Eigen::Vector3f v = R * velocity.linear_mps.cast<float>();
  const Eigen::Vector3f w = R * velocity.angular_radps.cast<float>();
  const bool moves = !v.isZero(0.0F) || !w.isZero(0.0F);
  const auto fx = static_cast<float>(colour.fx_px), fy = static_cast<float>(colour.fy_px);
  const auto cx = static_cast<float>(colour.cx_px), cy = static_cast<float>(colour.cy_px);
  const auto last_u = static_cast<float>(grey.width - 1), last_v = static_cast<float>(grey.height - 1);
  level.intensity.resize(level.camera.width_px, level.camera.height_px, -1.0F);
  for (int y = 0; y < level.camera.height_px; ++y) {
    const Eigen::Vector3f row_ray =
        R * back_project(level.camera, 0.0, static_cast<double>(y), 1.0).cast<float>();
    const Eigen::Vector3f ray_step = R.col(0) / static_cast<float>(level.camera.fx_px);
    for (int x = 0; x < level.camera.width_px; ++x) {
      const float q = level.inverse_depth_per_m.at(x, y);
      if (q <= 0.0F) continue;
      const Eigen::Vector3f ray = row_ray + static_cast<float>(x) * ray_step;
      Eigen::Vector3f p = ray + q * t;  // divided by the depth
      if (moves) {
        const Eigen::Vector3f per_s = q * v + w.cross(ray);
        p += (depth_row_s * (static_cast<float>(y) - depth_middle) - delay_s) * per_s;
        const float row_rough = p.z() < 0.1F ? colour_middle : fy * p.y() / p.z() + cy;
        p -= colour_row_s * (row_rough - colour_middle) * per_s;
      }
      if (p.z() < 0.1F) continue;
      const float u = fx * p.x() / p.z() + cx, row = fy * p.y() / p.z() + cy;
      if (!(u >= 0.0F && row >= 0.0F && u < last_u && row < last_v)) continue;
      const int u0 = static_cast<int>(u), v0 = static_cast<int>(row);
      const float du = u - static_cast<float>(u0), dv = row - static_cast<float>(v0);
      const float* upper = grey.row(v0) + u0;
      const float* lower = upper + grey.width;
      level.intensity.at(x, y) = (1.0F - dv) * ((1.0F - du) * upper[0] + du * upper[1]) +
                                 dv * ((1.0F - du) * lower[0] + du * lower[1]);
    }
  }
}

/// Fills in the depth of all levels; returns the ratio of the input's size to the finest level's.
int make_depth_levels(const DepthImage& depth_m, const Intrinsics& camera, const ViewConfig& config,
                      ViewPyramid& pyramid) {
  pyramid.levels.resize(static_cast<std::size_t>(std::max(config.levels, 1)));
  ViewPyramid::Level& finest = pyramid.levels.front();
  finest.camera = camera;
  int block = 1;
  const auto invert = [&](float depth) { return inverse_depth(depth, config); };
  const auto keep = [](float q) { return q; };
  // An image of one row is not halved: no row would remain.
  const auto is_too_wide = [&](const Intrinsics& c) {
    return c.width_px > config.finest_width_px && c.height_px > 1;
  };
  if (!is_too_wide(camera)) {
    finest.inverse_depth_per_m.resize(depth_m.width, depth_m.height);
    std::transform(depth_m.pixels.begin(), depth_m.pixels.end(), finest.inverse_depth_per_m.pixels.begin(),
                   invert);
  } else {
    halve(depth_m, invert, finest.inverse_depth_per_m);
    finest.camera = scaled(camera, 0.5);
    block = 2;
    Image<float> half;
    while (is_too_wide(finest.camera)) {
      halve(finest.inverse_depth_per_m, keep, half);
      std::swap(half, finest.inverse_depth_per_m);
      finest.camera = scaled(finest.camera, 0.5);
      block *= 2;
    }
  }
  halve_depth(pyramid);
  return block;
}

}  // namespace

void halve_depth(ViewPyramid& pyramid) {
  for (std::size_t i = 1; i < pyramid.levels.size(); ++i) {
    pyramid.levels[i].camera = scaled(pyramid.levels[i - 1].camera, 0.5);
    halve(
        pyramid.levels[i - 1].inverse_depth_per_m, [](float q) { return q; },
        pyramid.levels[i].inverse_depth_per_m);
  }
}

void deskew(ViewPyramid& pyramid, const CameraVelocity& velocity, double readout_s) {
  constexpr double kLeast_px = 0.25;  // at the first and the last row
  ViewPyramid::Level& finest = pyramid.levels.front();
  if (!(0.5 * std::abs(readout_s) * image_speed_pxps(velocity, finest.camera) > kLeast_px)) return;
  deskew(finest.camera, velocity, readout_s, finest.inverse_depth_per_m, finest.intensity);
  halve_depth(pyramid);
  halve_intensity(pyramid);
}

void halve_intensity(ViewPyramid& pyramid) {
  for (std::size_t i = 1; i < pyramid.levels.size(); ++i) {
    if (pyramid.levels[i - 1].intensity.empty()) {
      pyramid.levels[i].intensity.resize(0, 0);
    } else {
      halve_intensity_of(pyramid.levels[i - 1], pyramid.levels[i]);
    }
  }
}

void make_grey(const ColourImage& colour, int max_width_px, Image<float>& grey) {
  int block = 1;
  while (colour.width / block > std::max(max_width_px, 1)) block *= 2;
  block_grey(colour, block, grey);
}

void make_pyramid(const DepthImage& depth_m, const Intrinsics& camera, const ViewConfig& config,
                  ViewPyramid& pyramid, const DepthNoise& noise) {
  pyramid.noise = noise;
  make_depth_levels(depth_m, camera, config, pyramid);
  pyramid.grey.resize(0, 0);
  for (ViewPyramid::Level& level : pyramid.levels) level.intensity.resize(0, 0);
}

void make_pyramid(const Frame& frame, const ViewConfig& config, ViewPyramid& pyramid,
                  const FrameMotion& motion) {
  pyramid.noise = frame.depth_noise;
  const int block = make_depth_levels(frame.depth_m, frame.depth_camera, config, pyramid);
  if (frame.colour.empty()) {
    pyramid.grey.resize(0, 0);
    for (ViewPyramid::Level& level : pyramid.levels) level.intensity.resize(0, 0);
    return;
  }
  register_intensity(frame, block, motion, pyramid.grey, pyramid.levels.front());
  halve_intensity(pyramid);
}

}  // namespace roomradar
