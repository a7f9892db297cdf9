// depth_blocks.cpp: the volume's outline in the image, boxes of blocks row by row, triangles of a block.
#include "radar/exact/depth_blocks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "radar/geometry/infinity.hpp"

namespace roomradar {
namespace {

constexpr int kCells = 8;  // side of a block

/// Returns depths of vertices first..first + count - 1 of grid row j; with a mask, 0 where the mask is 0.
const float* depth_row(const DepthView& view, int j, int first, int count, float* scratch) {
  const SceneDepth& s = *view.scene;
  const float* row = s.depth_m->row(j * s.stride_px);
  if (s.stride_px == 1 && s.mask == nullptr) return row + first;
  if (s.mask == nullptr) {
    for (int i = 0; i < count; ++i) scratch[i] = row[(first + i) * s.stride_px];
  } else {
    const std::uint8_t* mask = s.mask->row(j * s.stride_px);
    for (int i = 0; i < count; ++i) {
      const int u = (first + i) * s.stride_px;
      const float depth = row[u];
      scratch[i] = mask[u] != 0 ? depth : 0.0F;
    }
  }
  return scratch;
}

/// Bounds, in the frame, of the points in each column of a few rows.
struct ColumnBounds {
  float *low_x, *low_y, *low_z, *high_x, *high_y, *high_z, *farthest;

  ColumnBounds(float* data, std::size_t n)
      : low_x(data),
        low_y(data + n),
        low_z(data + 2 * n),
        high_x(data + 3 * n),
        high_y(data + 4 * n),
        high_z(data + 5 * n),
        farthest(data + 6 * n) {}
  void clear(std::size_t n) const {
    std::fill(low_x, low_x + 3 * n, kInfinity<float>);
    std::fill(high_x, high_x + 3 * n, -kInfinity<float>);
    std::fill(farthest, farthest + n, 0.0F);
  }
};

/// Extends one axis of a row's bounds by depth * (slope * i + offset) + shift. `beyond` is 0 for a measured
/// depth, else infinite. Branch-free, so compilers vectorise it.
void widen_axis(const float* __restrict known, const float* __restrict beyond, int count, float slope,
                float offset, float shift, float* __restrict low, float* __restrict high) {
  for (int i = 0; i < count; ++i) {
    const float at = known[i] * (slope * static_cast<float>(i) + offset) + shift;
    const float at_low = at + beyond[i], at_high = at - beyond[i];
    low[i] = at_low < low[i] ? at_low : low[i];
    high[i] = at_high > high[i] ? at_high : high[i];
  }
}

void sort_out(const float* __restrict depths, int count, float* __restrict known, float* __restrict beyond,
              float* __restrict farthest) {
  for (int i = 0; i < count; ++i) {
    const float some = depths[i] > 0.0F ? depths[i] : 0.0F;
    const float depth = some < kInfinity<float> ? some : 0.0F;
    known[i] = depth;
    beyond[i] = depth > 0.0F ? 0.0F : kInfinity<float>;
    farthest[i] = depth > farthest[i] ? depth : farthest[i];
  }
}

void widen_by_row(const DepthView& view, int j, const float* depths, int count, const ColumnBounds& bounds,
                  float* known, float* beyond) {
  const auto stride = static_cast<float>(view.scene->stride_px);
  const Eigen::Vector3f slope = view.rays.col(0) * stride;
  const Eigen::Vector3f offset = view.rays.col(0) * (static_cast<float>(view.i0) * stride) +
                                 view.rays.col(1) * (static_cast<float>(j) * stride) + view.rays.col(2);
  const Eigen::Vector3f& t = view.shift;
  sort_out(depths, count, known, beyond, bounds.farthest);
  widen_axis(known, beyond, count, slope.x(), offset.x(), t.x(), bounds.low_x, bounds.high_x);
  widen_axis(known, beyond, count, slope.y(), offset.y(), t.y(), bounds.low_y, bounds.high_y);
  widen_axis(known, beyond, count, slope.z(), offset.z(), t.z(), bounds.low_z, bounds.high_z);
}

/// Computes the rectangle around a box's projection. Returns false if all of the box is behind the camera.
bool outline_in_image(const Intrinsics& camera, const std::array<Eigen::Vector3d, 8>& corners,
                      Eigen::AlignedBox2d& outline) {
  constexpr double kNear_m = 1e-9;
  const auto put = [&](const Eigen::Vector3d& p) { outline.extend(project(camera, p)); };
  for (unsigned a = 0; a < 8; ++a) {
    if (corners[a].z() >= kNear_m) put(corners[a]);
    for (const unsigned bit : {1U, 2U, 4U}) {
      const unsigned b = a | bit;
      if (b == a || (corners[a].z() < kNear_m) == (corners[b].z() < kNear_m)) continue;
      const double t = (kNear_m - corners[a].z()) / (corners[b].z() - corners[a].z());
      Eigen::Vector3d p = corners[a] + t * (corners[b] - corners[a]);
      p.z() = kNear_m;
      put(p);
    }
  }
  return !outline.isEmpty();
}

}  // namespace

bool place_depth(const SceneDepth& scene, const Eigen::Matrix3d& R_frame_world,
                 const Eigen::Vector3d& origin_world, const Eigen::AlignedBox3d& volume, DepthView& view) {
  const int stride = scene.stride_px;
  view.scene = &scene;
  view.R_frame_camera = R_frame_world * scene.T_world_camera.linear();
  view.t_frame_camera = R_frame_world * (scene.T_world_camera.translation() - origin_world);
  view.columns = (scene.depth_m->width - 1) / stride + 1;
  const int rows = (scene.depth_m->height - 1) / stride + 1;

  std::array<Eigen::Vector3d, 8> corners;
  for (unsigned i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner((i & 1U) != 0 ? volume.max().x() : volume.min().x(),
                                 (i & 2U) != 0 ? volume.max().y() : volume.min().y(),
                                 (i & 4U) != 0 ? volume.max().z() : volume.min().z());
    corners[i] = view.R_frame_camera.transpose() * (corner - view.t_frame_camera);
  }
  Eigen::AlignedBox2d outline;
  if (!outline_in_image(scene.camera, corners, outline)) return false;
  // Rounding of the float vertices moves a cell by much less than a hundredth of a pixel.
  const auto to_grid = [&](double pixel, double offset, int last) {
    return std::clamp((pixel + offset) / stride, -2.0, last + 2.0);
  };
  view.i0 = std::max(0, static_cast<int>(std::floor(to_grid(outline.min().x(), -0.01, view.columns))));
  view.i1 =
      std::min(view.columns - 1, static_cast<int>(std::ceil(to_grid(outline.max().x(), 0.01, view.columns))));
  view.j0 = std::max(0, static_cast<int>(std::floor(to_grid(outline.min().y(), -0.01, rows))));
  view.j1 = std::min(rows - 1, static_cast<int>(std::ceil(to_grid(outline.max().y(), 0.01, rows))));
  if (view.i1 <= view.i0 || view.j1 <= view.j0) return false;

  const Intrinsics& c = scene.camera;
  Eigen::Matrix3d rays_camera;
  rays_camera << 1.0 / c.fx_px, 0.0, -c.cx_px / c.fx_px,  //
      0.0, 1.0 / c.fy_px, -c.cy_px / c.fy_px,             //
      0.0, 0.0, 1.0;
  view.rays = (view.R_frame_camera * rays_camera).cast<float>();
  view.shift = view.t_frame_camera.cast<float>();
  // Rounding of a product and a sum of three terms of at most these sizes, each rounded a few times.
  constexpr double kRounding = 8.0 * std::numeric_limits<float>::epsilon();
  const double widest = std::max(std::abs(c.cx_px), std::abs(c.cx_px - scene.depth_m->width)) / c.fx_px +
                        std::max(std::abs(c.cy_px), std::abs(c.cy_px - scene.depth_m->height)) / c.fy_px +
                        1.0;
  view.slack_m = static_cast<float>(kRounding * view.t_frame_camera.norm());
  view.slack_per_m = static_cast<float>(kRounding * widest);
  return true;
}

void append_blocks(const DepthView& view, std::vector<float>& scratch, std::vector<DepthBlock>& blocks) {
  const int count = view.i1 - view.i0 + 1;
  const auto padded = static_cast<std::size_t>((count + 7) / 8 * 8);
  scratch.resize(10 * padded);
  ColumnBounds bounds(scratch.data(), padded);
  float* const row_scratch = scratch.data() + 7 * padded;
  for (int j = view.j0; j < view.j1; j += kCells) {
    bounds.clear(padded);
    for (int jj = j; jj <= std::min(j + kCells, view.j1); ++jj) {
      const float* depths = depth_row(view, jj, view.i0, count, row_scratch);
      widen_by_row(view, jj, depths, count, bounds, row_scratch + padded, row_scratch + 2 * padded);
    }
    for (int i = 0; i + 1 < count; i += kCells) {
      FrameBox box{kInfinity<float>,  -kInfinity<float>, kInfinity<float>,
                   -kInfinity<float>, kInfinity<float>,  -kInfinity<float>};
      float depth_m = 0.0F;
      for (int k = i; k <= std::min(i + kCells, count - 1); ++k) {
        box.x0 = std::min(box.x0, bounds.low_x[k]);
        box.x1 = std::max(box.x1, bounds.high_x[k]);
        box.y0 = std::min(box.y0, bounds.low_y[k]);
        box.y1 = std::max(box.y1, bounds.high_y[k]);
        box.z0 = std::min(box.z0, bounds.low_z[k]);
        box.z1 = std::max(box.z1, bounds.high_z[k]);
        depth_m = std::max(depth_m, bounds.farthest[k]);
      }
      if (!(box.z0 < kInfinity<float>)) continue;
      const float s = view.slack_m + view.slack_per_m * depth_m;
      blocks.push_back(
          {{box.x0 - s, box.x1 + s, box.y0 - s, box.y1 + s, box.z0 - s, box.z1 + s}, view.i0 + i, j});
    }
  }
}

void append_triangles(const DepthView& view, const DepthBlock& block, std::vector<DepthTriangle>& triangles) {
  constexpr std::size_t kRow = kCells + 1;
  std::array<std::array<float, kRow>, kRow> x, y, z, depth;
  const int columns = std::min(kCells, view.i1 - block.i), rows = std::min(kCells, view.j1 - block.j);
  const auto stride = static_cast<float>(view.scene->stride_px);
  for (int b = 0; b <= rows; ++b) {
    std::array<float, kRow> scratch;
    const float* d = depth_row(view, block.j + b, block.i, columns + 1, scratch.data());
    const Eigen::Vector3f r0 =
        view.rays.col(1) * (static_cast<float>(block.j + b) * stride) + view.rays.col(2);
    const auto row = static_cast<std::size_t>(b);
    for (int a = 0; a <= columns; ++a) {
      const float u = static_cast<float>(block.i + a) * stride;
      const auto at = static_cast<std::size_t>(a);
      const float known = d[a] > 0.0F && d[a] < kInfinity<float> ? d[a] : 0.0F;
      depth[row][at] = known;
      x[row][at] = known * (view.rays(0, 0) * u + r0.x()) + view.shift.x();
      y[row][at] = known * (view.rays(1, 0) * u + r0.y()) + view.shift.y();
      z[row][at] = known * (view.rays(2, 0) * u + r0.z()) + view.shift.z();
    }
  }
  const float max_jump_m = view.scene->max_jump_m, max_jump_slope = view.scene->max_jump_slope;
  const auto min3 = [](float a, float b, float c) { return std::min(std::min(a, b), c); };
  const auto max3 = [](float a, float b, float c) { return std::max(std::max(a, b), c); };
  for (std::size_t b = 0; b < static_cast<std::size_t>(rows); ++b) {
    for (std::size_t a = 0; a < static_cast<std::size_t>(columns); ++a) {
      const std::uint32_t cell = static_cast<std::uint32_t>(block.j + static_cast<int>(b)) *
                                     static_cast<std::uint32_t>(view.columns) +
                                 static_cast<std::uint32_t>(block.i + static_cast<int>(a));
      // Triangles a, c, d and a, d, b differ in the (row, column) of their middle corner.
      for (std::uint32_t which = 0; which < 2; ++which) {
        const std::size_t mb = b + (which == 0 ? 1 : 0), ma = a + (which == 0 ? 0 : 1);
        const auto three = [&](const auto& v, const auto& pick) {
          return pick(v[b][a], v[mb][ma], v[b + 1][a + 1]);
        };
        const float nearest = three(depth, min3), farthest = three(depth, max3);
        if (!(nearest > 0.0F)) continue;
        if (!(farthest - nearest <= max_jump_m + max_jump_slope * nearest)) continue;
        const float s = view.slack_m + view.slack_per_m * farthest;
        triangles.push_back({{three(x, min3) - s, three(x, max3) + s, three(y, min3) - s, three(y, max3) + s,
                              three(z, min3) - s, three(z, max3) + s},
                             2 * cell + which});
      }
    }
  }
}

FrameTriangle depth_triangle(const DepthView& view, std::uint32_t id) {
  const SceneDepth& s = *view.scene;
  const int cell = static_cast<int>(id / 2);
  const int i = cell % view.columns, j = cell / view.columns;
  const auto vertex = [&](int a, int b) {
    const int u = a * s.stride_px, v = b * s.stride_px;
    const Eigen::Vector3f p = back_project(s.camera, u, v, s.depth_m->at(u, v)).cast<float>();
    return Eigen::Vector3d(view.R_frame_camera * p.cast<double>() + view.t_frame_camera);
  };
  FrameTriangle t;
  t.corners[0] = vertex(i, j);
  if (id % 2 == 0) {
    t.corners[1] = vertex(i, j + 1);
    t.corners[2] = vertex(i + 1, j + 1);
  } else {
    t.corners[1] = vertex(i + 1, j + 1);
    t.corners[2] = vertex(i + 1, j);
  }
  set_normal(t);
  return t;
}

}  // namespace roomradar
