// depth_canvas.hpp: triangles drawn into an image of inverse depth, by the processor.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace roomradar {

/// Inverse depth (1/m) of the nearest surface at each pixel, 0 where nothing is. What is drawn first does not
/// matter: the nearest wins.
struct DepthCanvas {
  static constexpr int kLanes = 8;  ///< pixels that are written at once; rows have as many to spare

  int width_px = 0, height_px = 0, stride_px = 0;
  std::vector<float> inverse_depth_per_m;

  /// Gives it a size and empties it; keeps the allocation when it is large enough.
  void clear(int wanted_width_px, int wanted_height_px);
  [[nodiscard]] const float* row(int y) const {
    return inverse_depth_per_m.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(stride_px);
  }
};

/// Where vertices are seen: pixel (0, 0) of the canvas is centred at (0, 0).
struct ProjectedVertices {
  std::vector<float> u_px, v_px, inverse_depth_per_m;

  void resize(std::size_t count);
};

using PieceTriangle = std::array<std::uint16_t, 3>;  ///< indices of projected vertices

/// Buffers of draw_triangles.
struct TriangleSetup {
  static constexpr std::size_t kMost = 256;  ///< triangles that are set up side by side
  template <typename Value>
  using Lane = std::array<Value, kMost>;

  alignas(32) std::array<Lane<float>, 3> u, v, q;  // of the corners, from the pixel (first_x, first_y)
  alignas(32) Lane<float> area;
  alignas(32) Lane<int> first_x, first_y, columns, rows;  // of pixels that may be covered
  alignas(32) Lane<float> q_first, q_per_x, q_per_y, least_q, most_q;
  // In row y the pixels from the greatest left_slope * (y - v) + left to the least right_slope * (y - v) +
  // right are covered: from a corner of the edge, since the slope of one that is almost level is huge.
  alignas(32) std::array<Lane<float>, 3> left, left_slope, right, right_slope;
};

/// Draws triangles, both sides of them or only those that are counter-clockwise as seen.
///
/// Inverse depth is linear over a triangle's pixels; it is sampled at pixel centres and never leaves the
/// range of the triangle's corners. A triangle is 1/1024 pixel larger than it is, so that neighbours leave no
/// gap. Coordinates must be finite, and within 16,000 pixels for that to hold; corners lie before the camera.
void draw_triangles(const ProjectedVertices& vertices, std::span<const PieceTriangle> triangles,
                    bool cull_back_faces, TriangleSetup& setup, DepthCanvas& canvas);

}  // namespace roomradar
