// depth_canvas.hpp: CPU rasteriser of triangles into an inverse-depth image.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace roomradar {

/// Image of the inverse depth (1/m) of the nearest surface per pixel; 0 if there is no surface. The image
/// does not depend on the order in which triangles are drawn.
struct DepthCanvas {
  /// Number of pixels that draw_triangles() writes at once (SIMD). Each row is padded by at least this many
  /// pixels.
  static constexpr int kLanes = 8;

  int width_px = 0, height_px = 0, stride_px = 0;
  /// Rows of stride_px values.
  std::vector<float> inverse_depth_per_m;

  /// Sets the size and clears all pixels to 0. Keeps the allocation if it is large enough.
  void clear(int wanted_width_px, int wanted_height_px);
  [[nodiscard]] const float* row(int y) const {
    return inverse_depth_per_m.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(stride_px);
  }
};

/// Projected vertices. Pixel (0, 0) of the canvas is centred at coordinates (0, 0).
struct ProjectedVertices {
  std::vector<float> u_px, v_px, inverse_depth_per_m;

  void resize(std::size_t count);
};

/// Indices of a triangle's projected vertices.
using PieceTriangle = std::array<std::uint16_t, 3>;

/// Scratch buffers of draw_triangles(), a structure of arrays. Each array has one value per triangle.
struct TriangleSetup {
  /// Number of triangles processed together.
  static constexpr std::size_t kMost = 256;
  template <typename Value>
  using Lane = std::array<Value, kMost>;

  // Vertices of the triangles: u and v in pixels relative to pixel (first_x, first_y), q the inverse depth in
  // 1/m.
  alignas(32) std::array<Lane<float>, 3> u, v, q;
  /// Twice the signed area, px^2.
  alignas(32) Lane<float> area;
  // Rectangle of pixels that a triangle may cover.
  alignas(32) Lane<int> first_x, first_y, columns, rows;
  /// Inverse depth, 1/m: value at pixel (first_x, first_y), slopes per pixel in x and y, and range over the
  /// three vertices.
  alignas(32) Lane<float> q_first, q_per_x, q_per_y, least_q, most_q;
  // Edges of the span of pixels that a triangle covers in row y. The span begins at the maximum of left_slope
  // * (y - v) + left over the three edges, and ends at the minimum of right_slope * (y - v) + right. v is the
  // row coordinate of one of the edge's vertices. `left` and `right` are the edge's x at row v, not at row 0,
  // since a nearly horizontal edge has a huge slope.
  alignas(32) std::array<Lane<float>, 3> left, left_slope, right, right_slope;
};

/// Draws triangles. If cull_back_faces is true, draws only triangles that are counter-clockwise as seen by
/// the camera.
///
/// Inverse depth is linear over a triangle, sampled at pixel centres and clamped to the range of the
/// triangle's vertices. Triangles are enlarged by 1/1024 pixel, so neighbours leave no gap. Coordinates must
/// be finite, and vertices in front of the camera. The enlargement works only for coordinates within 16,000
/// pixels.
void draw_triangles(const ProjectedVertices& vertices, std::span<const PieceTriangle> triangles,
                    bool cull_back_faces, TriangleSetup& setup, DepthCanvas& canvas);

}  // namespace roomradar
