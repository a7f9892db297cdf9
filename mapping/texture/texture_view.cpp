// texture_view.cpp: compares the frame's depth with the mesh's, and scores points.
#include "mapping/texture/texture_view.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/texture/mesh_raster.hpp"

namespace roomradar {
namespace {

constexpr double kExposure_s = 0.01;     // indoors; only the ratio of fast to slow frames matters
constexpr float kMinFrontality = 0.17F;  // 80 degrees from the normal
constexpr float kBorder_px = 3.0F;       // not used: the picture's border is darker and badly interpolated
constexpr float kFade_px = 40.0F;        // the score falls linearly towards the border
constexpr float kMin_m = 0.2F;
constexpr int kLowFactor = 8;

/// Difference of depth that is no contradiction: noise of sensor, pose and mesh.
float tolerance_m(float depth_m) { return 0.02F + 0.015F * depth_m; }

/// Returns the mean of blocks of `factor` x `factor` pixels, smoothed over 3 x 3 blocks.
ColourImage without_detail(const ColourImage& picture, int factor) {
  const int width = std::max(1, picture.width / factor), height = std::max(1, picture.height / factor);
  Image<Eigen::Array3f> blocks(width, height, Eigen::Array3f::Zero());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      Eigen::Array3f sum = Eigen::Array3f::Zero();
      float count = 0.0F;
      for (int v = y * factor; v < std::min(picture.height, (y + 1) * factor); ++v)
        for (int u = x * factor; u < std::min(picture.width, (x + 1) * factor); ++u, count += 1.0F) {
          const Rgb& pixel = picture.at(u, v);
          sum += Eigen::Array3f(pixel.r, pixel.g, pixel.b);
        }
      blocks.at(x, y) = sum / std::max(count, 1.0F);
    }
  ColourImage low(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      Eigen::Array3f sum = Eigen::Array3f::Zero();
      float count = 0.0F;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u, count += 1.0F)
          sum += blocks.at(u, v);
      const Eigen::Array3f mean = sum / count + 0.5F;
      low.at(x, y) = {static_cast<std::uint8_t>(mean.x()), static_cast<std::uint8_t>(mean.y()),
                      static_cast<std::uint8_t>(mean.z())};
    }
  return low;
}

/// Returns the depth that the frame measured at a point of the colour camera; 0: none.
/// @param depth_m  out: the point's own depth in the depth camera
float measured_at(const Frame& frame, const Eigen::Isometry3f& T_depth_colour,
                  const Eigen::Vector3f& p_colour, float& depth_m) {
  const Eigen::Vector3f p = T_depth_colour * p_colour;
  depth_m = p.z();
  if (!(p.z() > kMin_m)) return 0.0F;
  const Eigen::Vector2d pixel = project(frame.depth_camera, p.cast<double>());
  const double x = std::round(pixel.x()), y = std::round(pixel.y());
  if (!(x >= 0.0 && y >= 0.0 && x < frame.depth_m.width && y < frame.depth_m.height)) return 0.0F;
  return frame.depth_m.at(static_cast<int>(x), static_cast<int>(y));
}

std::uint16_t in_mm(float depth_m) {
  return static_cast<std::uint16_t>(std::min(1000.0F * depth_m + 0.5F, 65535.0F));
}

/// Returns the smallest depth among each pixel and its eight neighbours, mm.
Image<std::uint16_t> nearest_of_neighbours(const DepthImage& depth_m) {
  Image<std::uint16_t> nearest_mm(depth_m.width, depth_m.height);
  for (int y = 0; y < depth_m.height; ++y)
    for (int x = 0; x < depth_m.width; ++x) {
      float least = depth_m.at(x, y);
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, depth_m.height - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, depth_m.width - 1); ++u)
          least = std::min(least, depth_m.at(u, v));
      nearest_mm.at(x, y) = in_mm(least);
    }
  return nearest_mm;
}

/// Returns the depth, mm, up to which each pixel of `camera` (a smaller colour camera) shows the mesh.
Image<std::uint16_t> shown_depth(const Frame& frame, const Eigen::Isometry3d& T_colour_world,
                                 const Mesh& mesh, const Intrinsics& camera) {
  DepthImage shown_m = rasterise(mesh, camera, T_colour_world).depth_m;
  const Eigen::Isometry3f T_depth_colour = frame.T_colour_depth.inverse().cast<float>();
  for (int y = 0; y < shown_m.height; ++y)
    for (int x = 0; x < shown_m.width; ++x) {
      float& mesh_m = shown_m.at(x, y);
      if (mesh_m == 0.0F) continue;
      const Eigen::Vector3f p_colour = back_project(camera, x, y, double{mesh_m}).cast<float>();
      float expected_m = 0.0F;
      const float measured_m = measured_at(frame, T_depth_colour, p_colour, expected_m);
      if (measured_m > 0.0F && std::abs(measured_m - expected_m) > 2.0F * tolerance_m(expected_m))
        mesh_m = 0.0F;
    }
  return nearest_of_neighbours(shown_m);
}

/// Returns the image coordinates of a smaller picture of the same camera.
Eigen::Vector2f in_smaller(const Eigen::Vector2f& pixel, float factor) {
  return (pixel.array() + 0.5F) * factor - 0.5F;
}

Eigen::Array3f interpolated(const ColourImage& picture, const Eigen::Vector2f& pixel) {
  const float x = std::clamp(pixel.x(), 0.0F, static_cast<float>(picture.width - 1));
  const float y = std::clamp(pixel.y(), 0.0F, static_cast<float>(picture.height - 1));
  const int left = std::min(static_cast<int>(x), std::max(picture.width - 2, 0));
  const int top = std::min(static_cast<int>(y), std::max(picture.height - 2, 0));
  const int right = std::min(left + 1, picture.width - 1), bottom = std::min(top + 1, picture.height - 1);
  const float u = x - static_cast<float>(left), v = y - static_cast<float>(top);
  const auto at = [&](int i, int j) {
    const Rgb& colour = picture.at(i, j);
    return Eigen::Array3f(colour.r, colour.g, colour.b);
  };
  return (1.0F - v) * ((1.0F - u) * at(left, top) + u * at(right, top)) +
         v * ((1.0F - u) * at(left, bottom) + u * at(right, bottom));
}

Eigen::Array3f evened(const TextureView& view, const Eigen::Array3f& colour) {
  return (colour * Eigen::Array3f(view.gain[0], view.gain[1], view.gain[2])).min(255.0F);
}

}  // namespace

TextureView make_texture_view(const Frame& frame, const Eigen::Isometry3d& T_world_camera, const Mesh& mesh,
                              double image_speed_pxps) {
  TextureView view;
  view.camera = frame.colour_camera;
  view.colour = subsampled(frame.colour);
  view.low = without_detail(frame.colour, kLowFactor);
  const Eigen::Isometry3d T_colour_world = frame.T_colour_depth * T_world_camera.inverse();
  view.T_camera_local = (T_colour_world * Eigen::Translation3d(mesh.origin)).cast<float>();
  view.shown_mm = shown_depth(frame, T_colour_world, mesh, scaled(frame.colour_camera, 0.5));
  const double blur_px = kExposure_s * image_speed_pxps;
  view.sharpness = static_cast<float>(1.0 / std::sqrt(1.0 + blur_px * blur_px));
  return view;
}

ShownPoint shown(const TextureView& view, const Eigen::Vector3f& p_local, const Eigen::Vector3f& normal) {
  const Eigen::Vector3f p = view.T_camera_local * p_local;
  if (!(p.z() > kMin_m)) return {};
  const float cosine = -(view.T_camera_local.linear() * normal).dot(p) / p.norm();
  if (!(cosine > kMinFrontality)) return {};
  const Intrinsics& camera = view.camera;
  const Eigen::Vector2f pixel = pixel_of(camera, p);
  const float to_border_px =
      std::min({pixel.x(), pixel.y(), static_cast<float>(camera.width_px - 1) - pixel.x(),
                static_cast<float>(camera.height_px - 1) - pixel.y()}) -
      kBorder_px;
  if (!(to_border_px > 0.0F)) return {};
  const Eigen::Vector2f half = in_smaller(pixel, 0.5F);
  const int x = std::min(static_cast<int>(half.x() + 0.5F), view.shown_mm.width - 1);
  const int y = std::min(static_cast<int>(half.y() + 0.5F), view.shown_mm.height - 1);
  if (p.z() > 0.001F * static_cast<float>(view.shown_mm.at(x, y)) + tolerance_m(p.z())) return {};
  const float px_per_m = static_cast<float>(std::min(camera.fx_px, camera.fy_px)) / p.z() * cosine;
  return {pixel, px_per_m, px_per_m * view.sharpness * std::min(1.0F, 0.1F + to_border_px / kFade_px)};
}

Eigen::Array3f colour_at(const TextureView& view, const Eigen::Vector2f& pixel) {
  return evened(view, colour_at(view.colour, pixel));
}

bool is_overexposed(const TextureView& view, const Eigen::Vector2f& pixel) {
  return colour_at(view.colour, (pixel.array() + 0.5F).floor()).maxCoeff() >= 250.0F;
}

Eigen::Array3f low_colour_at(const TextureView& view, const Eigen::Vector2f& pixel) {
  return evened(view, interpolated(view.low, in_smaller(pixel, 1.0F / kLowFactor)));
}

}  // namespace roomradar
