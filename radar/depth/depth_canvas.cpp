// depth_canvas.cpp: triangles that cover pixels, then edges and planes with SIMD, then pixels row by row.
#include "radar/depth/depth_canvas.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace roomradar {
namespace {

constexpr float kWider_px = 1.0F / 1024.0F;
constexpr float kLeastArea_px2 = 1e-7F;  // twice the area; smaller triangles cover no pixel centre
constexpr float kLevel_px = 1e-4F;       // an edge that rises by less bounds rows only

/// For x >= 0, return the first integer >= x, and one past the last integer <= x.
int first_from(float x) {
  const int whole = static_cast<int>(x);
  return whole + (static_cast<float>(whole) < x ? 1 : 0);
}
int end_after(float x) { return static_cast<int>(x) + 1; }

/// Keeps the triangles that may cover pixels; returns their number.
std::size_t take_visible(const ProjectedVertices& vertices, std::span<const PieceTriangle> triangles,
                         bool cull_back_faces, int width_px, int height_px, TriangleSetup& setup) {
  const float* u_px = vertices.u_px.data();
  const float* v_px = vertices.v_px.data();
  const float* inverse_depth = vertices.inverse_depth_per_m.data();
  const auto last_x = static_cast<float>(width_px - 1), last_y = static_cast<float>(height_px - 1);
  const float back_sign = cull_back_faces ? 1.0F : 0.0F;
  std::size_t count = 0;
  for (const PieceTriangle& triangle : triangles) {
    const float u0 = u_px[triangle[0]], u1 = u_px[triangle[1]], u2 = u_px[triangle[2]];
    const float v0 = v_px[triangle[0]], v1 = v_px[triangle[1]], v2 = v_px[triangle[2]];
    const float low_u = std::min(std::min(u0, u1), u2) - kWider_px;
    const float low_v = std::min(std::min(v0, v1), v2) - kWider_px;
    const float high_u = std::max(std::max(u0, u1), u2) + kWider_px;
    const float high_v = std::max(std::max(v0, v1), v2) + kWider_px;
    const int x0 = first_from(std::min(std::max(low_u, 0.0F), last_x));
    const int y0 = first_from(std::min(std::max(low_v, 0.0F), last_y));
    const int x1 = end_after(std::max(std::min(high_u, last_x), 0.0F));
    const int y1 = end_after(std::max(std::min(high_v, last_y), 0.0F));
    const float area = (u1 - u0) * (v2 - v0) - (u2 - u0) * (v1 - v0);
    // Image rows run down, so counter-clockwise as seen is clockwise in pixels.
    const bool visible = (x0 < x1) & (y0 < y1) & (high_u >= 0.0F) & (high_v >= 0.0F) & (low_u <= last_x) &
                         (low_v <= last_y) & (std::abs(area) > kLeastArea_px2) & (back_sign * area <= 0.0F);
    const auto fx = static_cast<float>(x0), fy = static_cast<float>(y0);
    setup.u[0][count] = u0 - fx, setup.u[1][count] = u1 - fx, setup.u[2][count] = u2 - fx;
    setup.v[0][count] = v0 - fy, setup.v[1][count] = v1 - fy, setup.v[2][count] = v2 - fy;
    setup.q[0][count] = inverse_depth[triangle[0]];
    setup.q[1][count] = inverse_depth[triangle[1]];
    setup.q[2][count] = inverse_depth[triangle[2]];
    setup.area[count] = area;
    setup.first_x[count] = x0, setup.first_y[count] = y0;
    setup.columns[count] = x1 - x0, setup.rows[count] = y1 - y0;
    count += visible ? 1 : 0;
  }
  return count;
}

/// Computes the plane of inverse depth of each triangle.
void find_planes(std::size_t count, TriangleSetup& setup) {
  for (std::size_t i = 0; i < count; ++i) {
    const float u0 = setup.u[0][i], v0 = setup.v[0][i], q0 = setup.q[0][i];
    const float q1 = setup.q[1][i], q2 = setup.q[2][i];
    const float u10 = setup.u[1][i] - u0, u20 = setup.u[2][i] - u0;
    const float v10 = setup.v[1][i] - v0, v20 = setup.v[2][i] - v0;
    const float q10 = q1 - q0, q20 = q2 - q0;
    const float inverse_area = 1.0F / setup.area[i];
    const float per_x = (q10 * v20 - q20 * v10) * inverse_area;
    const float per_y = (q20 * u10 - q10 * u20) * inverse_area;
    setup.q_per_x[i] = per_x;
    setup.q_per_y[i] = per_y;
    setup.q_first[i] = q0 - per_x * u0 - per_y * v0;
    setup.least_q[i] = std::min(std::min(q0, q1), q2);
    setup.most_q[i] = std::max(std::max(q0, q1), q2);
  }
}

/// Computes where each triangle's edges cross the rows. An edge bounds from the left or the right, depending
/// on the side of the third corner.
void find_edges(std::size_t count, TriangleSetup& setup) {
  constexpr float kNoBound_px = 1e9F;
  for (std::size_t edge = 0; edge < 3; ++edge) {
    const std::size_t next = edge == 2 ? 0 : edge + 1;
    for (std::size_t i = 0; i < count; ++i) {
      const float u = setup.u[edge][i], v = setup.v[edge][i];
      const float du = setup.u[next][i] - u, dv = setup.v[next][i] - v;
      const float side = setup.area[i] > 0.0F ? dv : -dv;
      const bool is_left = side<-kLevel_px, is_right = side> kLevel_px;
      const bool is_level = !(is_left | is_right);
      const float slope = du / (is_level ? 1.0F : dv);
      const float from = u - kWider_px, to = u + kWider_px;
      setup.left[edge][i] = is_left ? from : -kNoBound_px;
      setup.left_slope[edge][i] = is_left ? slope : 0.0F;
      setup.right[edge][i] = is_right ? to : kNoBound_px;
      setup.right_slope[edge][i] = is_right ? slope : 0.0F;
    }
  }
}

using Lanes = Eigen::Array<float, DepthCanvas::kLanes, 1>;

void fill(const TriangleSetup& setup, std::size_t i, DepthCanvas& canvas) {
  constexpr int kLanes = DepthCanvas::kLanes;
  const Lanes kLane = Lanes::LinSpaced(0.0F, static_cast<float>(kLanes - 1));
  const float left0 = setup.left[0][i], left1 = setup.left[1][i], left2 = setup.left[2][i];
  const float right0 = setup.right[0][i], right1 = setup.right[1][i], right2 = setup.right[2][i];
  const float left_slope0 = setup.left_slope[0][i], left_slope1 = setup.left_slope[1][i],
              left_slope2 = setup.left_slope[2][i];
  const float right_slope0 = setup.right_slope[0][i], right_slope1 = setup.right_slope[1][i],
              right_slope2 = setup.right_slope[2][i];
  const float v0 = setup.v[0][i], v1 = setup.v[1][i], v2 = setup.v[2][i];
  const float q_first = setup.q_first[i], q_per_x = setup.q_per_x[i], q_per_y = setup.q_per_y[i];
  const float least_q = setup.least_q[i], most_q = setup.most_q[i];
  const auto columns = static_cast<float>(setup.columns[i]);
  const int rows = setup.rows[i];
  float* corner = canvas.inverse_depth_per_m.data() +
                  static_cast<std::size_t>(setup.first_y[i]) * static_cast<std::size_t>(canvas.stride_px) +
                  static_cast<std::size_t>(setup.first_x[i]);
  for (int y = 0; y < rows; y += kLanes) {
    alignas(32) std::array<int, kLanes> begin, end;
    for (int lane = 0; lane < kLanes; ++lane) {
      const auto v = static_cast<float>(y + lane);
      const float from = std::max(std::max(left_slope0 * (v - v0) + left0, left_slope1 * (v - v1) + left1),
                                  left_slope2 * (v - v2) + left2);
      const float to = std::min(std::min(right_slope0 * (v - v0) + right0, right_slope1 * (v - v1) + right1),
                                right_slope2 * (v - v2) + right2);
      begin[lane] = first_from(std::min(std::max(from, 0.0F), columns));
      end[lane] = static_cast<int>(std::min(std::max(to + 1.0F, 0.0F), columns));
    }
    const int lanes = std::min(kLanes, rows - y);
    for (int lane = 0; lane < lanes; ++lane) {
      float* row = corner + static_cast<std::size_t>(y + lane) * static_cast<std::size_t>(canvas.stride_px);
      const float q_row = q_first + q_per_y * static_cast<float>(y + lane);
      // Whole lanes from a multiple of kLanes on, so a load matches the preceding store (store forwarding).
      const int misaligned = (setup.first_x[i] + begin[lane]) % kLanes;
      for (int x = begin[lane] - misaligned; x < end[lane]; x += kLanes) {
        Eigen::Map<Lanes> pixels(row + x);
        const Lanes before_end = (static_cast<float>(end[lane] - x) - kLane).max(0.0F).min(1.0F);
        const Lanes after_begin = (kLane + static_cast<float>(x + 1 - begin[lane])).max(0.0F).min(1.0F);
        const Lanes q = (q_row + q_per_x * static_cast<float>(x) + q_per_x * kLane).max(least_q).min(most_q);
        pixels = pixels.max(before_end * after_begin * q);
      }
    }
  }
}

}  // namespace

void DepthCanvas::clear(int wanted_width_px, int wanted_height_px) {
  width_px = wanted_width_px;
  height_px = wanted_height_px;
  stride_px = (width_px + 2 * kLanes - 1) / kLanes * kLanes;
  inverse_depth_per_m.assign(static_cast<std::size_t>(stride_px) * static_cast<std::size_t>(height_px), 0.0F);
}

void ProjectedVertices::resize(std::size_t count) {
  u_px.resize(count), v_px.resize(count), inverse_depth_per_m.resize(count);
}

void draw_triangles(const ProjectedVertices& vertices, std::span<const PieceTriangle> triangles,
                    bool cull_back_faces, TriangleSetup& setup, DepthCanvas& canvas) {
  constexpr std::size_t kAtOnce = TriangleSetup::kMost;
  for (std::size_t first = 0; first < triangles.size(); first += kAtOnce) {
    const std::size_t count =
        take_visible(vertices, triangles.subspan(first, std::min(kAtOnce, triangles.size() - first)),
                     cull_back_faces, canvas.width_px, canvas.height_px, setup);
    find_planes(count, setup);
    find_edges(count, setup);
    for (std::size_t i = 0; i < count; ++i) fill(setup, i, canvas);
  }
}

}  // namespace roomradar
