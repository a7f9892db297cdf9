// foreground_views.hpp: synthetic depth images, and the foreground marked in them.
#pragma once
#include <cmath>
#include <functional>
#include <random>
#include <utility>

#include "dynamic/foreground/foreground.hpp"
#include "mapping/types/depth_noise.hpp"

namespace roomradar::test {

inline constexpr Intrinsics kKinect{640, 480, 585.0, 585.0, 320.0, 240.0};

inline DepthImage flat(float depth_m, const Intrinsics& camera = kKinect) {
  return {camera.width_px, camera.height_px, depth_m};
}

inline void fill_rectangle(DepthImage& image, int x0, int y0, int x1, int y1, float depth_m) {
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) image.at(x, y) = depth_m;
  }
}

// Adds the Kinect's axial noise to the valid pixels.
inline void add_noise(DepthImage& depth_m, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  for (float& z : depth_m.pixels) {
    if (z > 0.0F) z += depth_sigma_m(DepthNoise{}, z) * normal(random);
  }
}

// A table seen from 1.2 m above it, 35 degrees below the horizon, with a box on it and a wall 3.5 m away.
inline DepthImage table_view(double shift_m, double turn_deg) {
  DepthImage depth_m = flat(0.0F);
  const double turn = turn_deg * M_PI / 180.0;
  for (int y = 0; y < kKinect.height_px; ++y) {
    for (int x = 0; x < kKinect.width_px; ++x) {
      const Eigen::Vector3d straight = back_project(kKinect, x, y, 1.0);
      const Eigen::Vector3d ray(straight.x() * std::cos(turn) + std::sin(turn), straight.y(),
                                -straight.x() * std::sin(turn) + std::cos(turn));
      // Rotates the axes to level: forward and down.
      const double down = ray.y() * std::cos(0.61) + ray.z() * std::sin(0.61);
      const double forward = ray.z() * std::cos(0.61) - ray.y() * std::sin(0.61);
      double t = (3.5 - shift_m) / std::max(forward, 1e-6);            // wall
      if (down > 1e-6) t = std::min(t, (1.2 - shift_m) / down);        // table
      const double t_box = (1.0 - shift_m) / std::max(forward, 1e-6);  // front of the box
      if (std::abs(ray.x() * t_box) < 0.2 && down * t_box < 1.2 - shift_m && down * t_box > 0.7)
        t = std::min(t, t_box);
      depth_m.at(x, y) = static_cast<float>(t);
    }
  }
  return depth_m;
}

// A table 0.9 m below a camera that looks `below_deg` below the horizon, and a rectangle the size of a hand,
// `above_m` above the table; 0: no hand. `truth` receives the hand's mask.
inline DepthImage hand_over_table(double below_deg, double above_m, MaskImage& truth) {
  const double down = below_deg * M_PI / 180.0;
  DepthImage depth_m = flat(0.0F);
  truth.resize(kKinect.width_px, kKinect.height_px, 0);
  for (int y = 0; y < kKinect.height_px; ++y) {
    for (int x = 0; x < kKinect.width_px; ++x) {
      const Eigen::Vector3d ray = back_project(kKinect, x, y, 1.0);
      const double falls = ray.y() * std::cos(down) + ray.z() * std::sin(down);
      const double forward = ray.z() * std::cos(down) - ray.y() * std::sin(down);
      if (falls < 1e-3 || 0.9 / falls > 5.0) continue;
      const double t = (0.9 - above_m) / falls;
      const bool hand = above_m > 0.0 && std::abs(ray.x() * t) < 0.05 &&
                        std::abs(forward * t - 0.9 / std::tan(down)) < 0.09;
      truth.at(x, y) = hand ? 255 : 0;
      depth_m.at(x, y) = static_cast<float>(hand ? t : 0.9 / falls);
    }
  }
  return depth_m;
}

// Result after `frames` identical frames.
struct Marked {
  LabelImage labels;
  MaskImage dynamic_mask;
  ForegroundCounts counts;
};

inline Marked mark(const DepthImage& depth_m, const DepthImage& expected_m,
                   const ForegroundConfig& config = {}, const Intrinsics& camera = kKinect, int frames = 1) {
  Marked marked;
  ForegroundState state;
  for (int i = 0; i < frames; ++i) {
    marked.counts = mark_foreground({depth_m, camera, Eigen::Isometry3d::Identity()}, expected_m, config,
                                    state, marked.labels, marked.dynamic_mask);
  }
  return marked;
}

inline double intersection_over_union(const MaskImage& mask, const std::function<bool(int, int)>& truth) {
  std::size_t both = 0, either = 0;
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      const bool marked = mask.at(x, y) != 0;
      both += marked && truth(x, y);
      either += marked || truth(x, y);
    }
  }
  return either == 0 ? 1.0 : static_cast<double>(both) / static_cast<double>(either);
}

}  // namespace roomradar::test
