// painted_frame.hpp: colour and sensor noise for exact frames, as tracking needs them.
#pragma once
#include <cmath>
#include <cstdint>
#include <random>

#include "mapping/types/depth_noise.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar::test {

/// Returns the grey level of a world point: the world consists of cubes of 6 cm, each with its own grey. The
/// cubes' faces are offset from the round coordinates at which test scenes have their planes.
inline std::uint8_t cube_grey(const Eigen::Vector3d& p_world) {
  constexpr double kCube_m = 0.06;
  const Eigen::Array3d cube = ((p_world.array() + 0.0217) / kCube_m).floor();
  auto hash = static_cast<std::uint64_t>(static_cast<std::int64_t>(cube.x()) * 73856093 ^
                                         static_cast<std::int64_t>(cube.y()) * 19349663 ^
                                         static_cast<std::int64_t>(cube.z()) * 83492791);
  hash = (hash ^ (hash >> 31)) * 0x9E3779B97F4A7C15ULL;
  return static_cast<std::uint8_t>(40 + (hash >> 40) % 170);
}

/// Paints the surfaces in the frame's depth image as seen from T_world_camera; colour is aligned with depth.
/// Four samples per pixel soften the cubes' edges. `grey_of` returns a world point's grey level.
template <typename Grey>
void paint_with(const Grey& grey_of, Frame& frame, const Eigen::Isometry3d& T_world_camera, double gain = 1.0,
                double offset = 0.0) {
  frame.colour.resize(frame.depth_camera.width_px, frame.depth_camera.height_px);
  frame.colour_camera = frame.depth_camera;
  for (int y = 0; y < frame.depth_m.height; ++y) {
    for (int x = 0; x < frame.depth_m.width; ++x) {
      const auto depth_m = static_cast<double>(frame.depth_m.at(x, y));
      if (depth_m <= 0.0) continue;
      double sum = 0.0;
      for (const double dv : {-0.25, 0.25}) {
        for (const double du : {-0.25, 0.25}) {
          sum += grey_of(T_world_camera * back_project(frame.depth_camera, x + du, y + dv, depth_m));
        }
      }
      const auto grey = static_cast<std::uint8_t>(std::clamp(gain * sum / 4.0 + offset, 0.0, 255.0));
      frame.colour.at(x, y) = {grey, grey, grey};
    }
  }
}

inline void paint(Frame& frame, const Eigen::Isometry3d& T_world_camera, double gain = 1.0,
                  double offset = 0.0) {
  paint_with(cube_grey, frame, T_world_camera, gain, offset);
}

/// Adds a Kinect's axial noise, independent from pixel to pixel.
inline void add_depth_noise(Frame& frame, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  for (float& depth_m : frame.depth_m.pixels) {
    if (depth_m > 0.0F) depth_m += depth_sigma_m(DepthNoise{}, depth_m) * normal(random);
  }
}

}  // namespace roomradar::test
