// node_visibility.hpp: visibility of eight sibling nodes in a depth image. Private to fusion.cpp. The
// template parameter Float8 selects a SIMD version from simd8f.hpp.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "mapping/octree/block_octree.hpp"
#include "mapping/octree/depth_pyramid.hpp"
#include "mapping/types/simd8f.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// Min measured depth, m. Smaller values count as not measured. No depth camera measures at such short range.
inline constexpr float kLeastDepth_m = 0.05F;

inline constexpr float kNearest_m = 0.01F;  // min depth, m, of points that are projected into the image

/// Pinhole camera in float.
struct Pinhole {
  explicit Pinhole(const Intrinsics& camera)
      : fx(static_cast<float>(camera.fx_px)),
        fy(static_cast<float>(camera.fy_px)),
        cx(static_cast<float>(camera.cx_px)),
        cy(static_cast<float>(camera.cy_px)),
        width(static_cast<float>(camera.width_px)),
        height(static_cast<float>(camera.height_px)) {}
  float fx, fy, cx, cy, width, height;
};

/// Eight points in the camera frame, m.
template <typename Float8>
struct EightPoints {
  Float8 x, y, z;
};

/// Table of the offsets from a node's centre to its children's centres, in the camera frame. The index is the
/// node's depth in the tree.
class ChildOffsets {
 public:
  ChildOffsets(const Eigen::Matrix3d& R_camera_world, double resolution_m) {
    for (unsigned depth = 0; depth < kLeafDepth; ++depth) {
      const double quarter_m = resolution_m * std::ldexp(1.0, static_cast<int>(kLeafDepth - depth)) / 4;
      half_extent_[depth] =
          (R_camera_world.cwiseAbs().rowwise().sum() * (quarter_m - resolution_m / 2)).cast<float>();
      for (unsigned i = 0; i < 8; ++i) {
        const Eigen::Vector3d towards(i & 1U ? 1.0 : -1.0, i & 2U ? 1.0 : -1.0, i & 4U ? 1.0 : -1.0);
        to_child_[depth][i] = R_camera_world * towards * quarter_m;
        for (unsigned axis = 0; axis < 3; ++axis)
          eight_[depth][axis][i] = static_cast<float>(to_child_[depth][i][axis]);
      }
    }
  }
  /// Returns the offset from the centre of a node at `depth` to the centre of its child i, m.
  [[nodiscard]] const Eigen::Vector3d& to_child(unsigned depth, unsigned i) const {
    return to_child_[depth][i];
  }
  /// Returns half the size of the box around all voxel centres in a child of a node at `depth`, along the
  /// camera's axes, m. The box contains only the centres, since voxels are classified by their centres.
  [[nodiscard]] const Eigen::Vector3f& half_extent(unsigned depth) const { return half_extent_[depth]; }
  /// Returns the centres of a node's children, in the camera frame. `depth` and `parent_camera` are the
  /// node's depth in the tree and centre.
  template <typename Float8>
  [[nodiscard]] EightPoints<Float8> centres(unsigned depth, const Eigen::Vector3d& parent_camera) const {
    const auto along = [&](unsigned axis) {
      return Float8(static_cast<float>(parent_camera[axis])) + Float8::load(eight_[depth][axis]);
    };
    return {along(0), along(1), along(2)};
  }

 private:
  std::array<std::array<Eigen::Vector3d, 8>, kLeafDepth> to_child_;
  std::array<Eigen::Vector3f, kLeafDepth> half_extent_;
  std::array<std::array<std::array<float, 8>, 3>, kLeafDepth> eight_;
};

/// Visibility of eight siblings that contain no ray endpoint, as bit masks (bit i: sibling i). A sibling that
/// is in none of the masks may contain a surface.
struct NodeVisibility {
  unsigned nothing = 0;  ///< occluded, out of view, or beyond 2 max_range_m
  unsigned free = 0;     ///< wholly in front of the measured depth
  /// In front of the measured depth in pixels with depth. The sibling's other parts are out of view or in
  /// pixels without depth.
  unsigned part_free = 0;
};

/// Classifies eight siblings by their boxes in the camera frame and by the image rectangles to which the
/// boxes project. One function, so that the eight-wide values stay in registers.
/// @param half  half the size of each box, m
template <typename Float8>
NodeVisibility judge(const EightPoints<Float8>& centres, const Eigen::Vector3f& half, const Pinhole& camera,
                     float max_range_m, const DepthPyramid& pyramid) {
  const Float8 near_z = centres.z - half.z(), far_z = centres.z + half.z();
  const Float8 low_x = centres.x - half.x(), high_x = centres.x + half.x();
  const Float8 low_y = centres.y - half.y(), high_y = centres.y + half.y();
  unsigned nothing = ((far_z <= kNearest_m) | (Float8(2.0F * max_range_m) < near_z)).bits();

  // A box that straddles the camera plane counts as out of view only if it is wholly outside one of the view
  // frustum's side planes.
  const unsigned straddles = (near_z <= kNearest_m).bits();
  if (straddles != 0) {
    const auto outside = (far_z * (camera.width - camera.cx) < low_x * camera.fx) |
                         (high_x * camera.fx < far_z * -(camera.cx + 1.0F)) |
                         (far_z * (camera.height - camera.cy) < low_y * camera.fy) |
                         (high_y * camera.fy < far_z * -(camera.cy + 1.0F));
    nothing |= straddles & outside.bits();
    if ((nothing | straddles) == 0xFFU) return {.nothing = nothing};
  }

  const Float8 far_inverse = Float8(1.0F) / max(far_z, kNearest_m);
  const Float8 near_inverse = Float8(1.0F) / max(near_z, kNearest_m);
  const Float8 zero(0.0F);
  const auto lower = [&](const Float8& low, float f, float c) {
    return low * f * select(zero < low, far_inverse, near_inverse) + (c + 0.5F);
  };
  const auto upper = [&](const Float8& high, float f, float c) {
    return high * f * select(zero < high, near_inverse, far_inverse) + (c + 0.5F);
  };
  const Float8 left = lower(low_x, camera.fx, camera.cx), right = upper(high_x, camera.fx, camera.cx);
  const Float8 top = lower(low_y, camera.fy, camera.cy), bottom = upper(high_y, camera.fy, camera.cy);
  const auto out_of_sight =
      (right < zero) | (bottom < zero) | (Float8(camera.width) < left) | (Float8(camera.height) < top);
  nothing |= ~straddles & out_of_sight.bits();
  const unsigned open = 0xFFU & ~nothing & ~straddles;
  if (open == 0) return {.nothing = nothing};

  const auto in_sight = (zero <= left) & (zero <= top) & (right <= camera.width) & (bottom <= camera.height);
  const unsigned whole = in_sight.bits();
  // Computes image rectangles in whole pixels, and the finest pyramid level at which each spans at most four
  // cells per side.
  const Float8 x_end(camera.width - 1.0F), y_end(camera.height - 1.0F);
  const Float8 left_px = floor(min(max(left, zero), x_end)), right_px = floor(min(max(right, zero), x_end));
  const Float8 top_px = floor(min(max(top, zero), y_end)), bottom_px = floor(min(max(bottom, zero), y_end));
  const Float8 span_px = max(right_px - left_px, bottom_px - top_px);
  const auto coarsest_px = static_cast<float>(1 << pyramid.levels);
  const Float8 cell_px =
      min(max(power_of_two_within((span_px - 0.5F) * (1.0F / 3.0F)) * 2.0F, 2.0F), coarsest_px);
  const Float8 cells_per_px = Float8(1.0F) / cell_px;
  const Float8 column = floor(left_px * cells_per_px), last_column = floor(right_px * cells_per_px);
  const Float8 row = floor(top_px * cells_per_px), last_row = floor(bottom_px * cells_per_px);
  const Float8 level_row = Float8(coarsest_px) - cells_per_px * (2.0F * coarsest_px);
  const auto stride = static_cast<float>(pyramid.stride);
  const Float8 rows = last_row - row, one(1.0F);
  alignas(32) std::array<int, 8> at, columns_on, second, third, last;
  ((level_row + row) * stride + column).store_truncated(at);
  max(last_column - column - one, zero).store_truncated(columns_on);
  (min(rows, one) * stride).store_truncated(second);
  (max(rows - one, zero) * stride).store_truncated(third);
  (rows * stride).store_truncated(last);
  alignas(32) std::array<int, 8> near_steps, far_steps;
  const Float8 last_step(1e6F);
  min(near_z * pyramid.steps_per_m, last_step).store_truncated(near_steps);
  min(far_z * pyramid.steps_per_m, last_step).store_truncated(far_steps);
  unsigned hidden = 0, before_all = 0, before_measured = 0;
  for (unsigned left_over = open; left_over != 0; left_over &= left_over - 1) {
    const auto i = static_cast<unsigned>(std::countr_zero(left_over));
    const DepthBounds bounds = bounds_within(pyramid, {at[i], columns_on[i], second[i], third[i], last[i]});
    hidden |= static_cast<unsigned>(near_steps[i] > -bounds.behind) << i;
    before_all |= static_cast<unsigned>(far_steps[i] < bounds.front) << i;
    before_measured |= static_cast<unsigned>(far_steps[i] < bounds.nearest) << i;
  }
  const unsigned free = before_all & whole & ~hidden;
  return {.nothing = nothing | hidden, .free = free, .part_free = before_measured & ~hidden & ~free};
}

}  // namespace roomradar
