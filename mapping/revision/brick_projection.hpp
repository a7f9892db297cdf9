// brick_projection.hpp: projects the cells of bricks into one frame.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "mapping/octree/static_map.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

inline constexpr float kNearestProjected_m = 0.1F;  // min depth, m, for projection into the image

/// Conservative visibility test: false only if no point of the sphere around the centre can be in the image.
inline bool may_be_seen(const Intrinsics& camera, const Eigen::Vector3d& centre_camera, double radius_m) {
  if (centre_camera.z() < kNearestProjected_m - radius_m) return false;
  const double nearest_z = std::max(centre_camera.z() - radius_m, static_cast<double>(kNearestProjected_m));
  const double margin_px = 2.0 * radius_m * std::max(camera.fx_px, camera.fy_px) / nearest_z;
  if (centre_camera.z() < 2.0 * radius_m) return true;  // too near for the test below
  const Eigen::Vector2d pixel = project(camera, centre_camera);
  return pixel.x() > -margin_px && pixel.y() > -margin_px && pixel.x() < camera.width_px + margin_px &&
         pixel.y() < camera.height_px + margin_px;
}

/// Edge of a brick in voxels, a power of two.
inline constexpr int kCellBrickEdge = 8;

/// A brick of 8 x 8 x 8 voxels. Its cells are at begin to end - 1 in the caller's list of cells.
struct CellBrick {
  VoxelIndex first = VoxelIndex::Zero();  ///< lowest voxel; coordinates are multiples of kCellBrickEdge
  std::size_t begin = 0, end = 0;
};

/// Returns the lowest voxel of the brick that contains `voxel`.
inline VoxelIndex cell_brick_of(const VoxelIndex& voxel) {
  return voxel.unaryExpr([](int v) { return v & ~(kCellBrickEdge - 1); });
}

/// Returns the number of the voxel at `offset` from the brick's lowest voxel, 0 to 511. Each coordinate must
/// be in 0..kCellBrickEdge-1.
inline std::size_t cell_brick_offset(const Eigen::Vector3i& offset) {
  return static_cast<std::size_t>((offset.z() * kCellBrickEdge + offset.y()) * kCellBrickEdge + offset.x());
}

/// Position of a cell in its brick.
struct CellInBrick {
  std::size_t offset = 0;  ///< cell_brick_offset() of its lowest voxel
  bool coarse = false;     ///< its edge is two voxels, not one
};

class BrickProjection {
 public:
  /// Precondition: depth_fault_of() returns an empty text for the frame.
  BrickProjection(const Frame& frame, const Eigen::Isometry3d& T_world_camera, double resolution_m)
      : camera_(frame.depth_camera),
        T_camera_world_(T_world_camera.inverse()),
        resolution_m_(resolution_m),
        fx_(static_cast<float>(camera_.fx_px)),
        fy_(static_cast<float>(camera_.fy_px)),
        cx_(static_cast<float>(camera_.cx_px)),
        cy_(static_cast<float>(camera_.cy_px)),
        width_(static_cast<float>(frame.depth_m.width)),
        height_(static_cast<float>(frame.depth_m.height)) {
    const Eigen::Matrix3f R_camera_voxels = (T_camera_world_.linear() * resolution_m).cast<float>();
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < kCellBrickEdge; ++i)
        steps_[static_cast<std::size_t>(axis)][static_cast<std::size_t>(i)] =
            R_camera_voxels.col(axis) * static_cast<float>(i);
    to_coarse_centre_ = R_camera_voxels * Eigen::Vector3f::Constant(0.5F);
  }
  [[nodiscard]] float fx() const { return fx_; }

  /// Calls visit(cell index, cell centre in the camera frame, pixel x, y) for each cell that projects into
  /// the image at a depth below farthest_m.
  /// @param cell_at  callable that returns the CellInBrick of a cell index
  template <typename CellAt, typename Visit>
  void for_each_nearer(float farthest_m, std::span<const CellBrick> bricks, const CellAt& cell_at,
                       const Visit& visit) const {
    const double brick_radius_m = 0.5 * std::sqrt(3.0) * kCellBrickEdge * resolution_m_;
    for (const CellBrick& brick : bricks) {
      const Eigen::Vector3d low_world = brick.first.cast<double>() * resolution_m_;
      const Eigen::Vector3d middle_camera =
          T_camera_world_ * (low_world + Eigen::Vector3d::Constant(0.5 * kCellBrickEdge * resolution_m_));
      if (middle_camera.z() > static_cast<double>(farthest_m) + brick_radius_m ||
          !may_be_seen(camera_, middle_camera, brick_radius_m))
        continue;
      const Eigen::Vector3f first_camera =
          (T_camera_world_ * (low_world + Eigen::Vector3d::Constant(0.5 * resolution_m_))).cast<float>();
      for (std::size_t i = brick.begin; i < brick.end; ++i) {
        const auto [offset, coarse] = cell_at(i);
        Eigen::Vector3f p_camera =
            first_camera + steps_[0][offset & 7U] + steps_[1][offset >> 3U & 7U] + steps_[2][offset >> 6U];
        if (coarse) p_camera += to_coarse_centre_;
        const float z = p_camera.z();
        if (!(z > kNearestProjected_m && z < farthest_m)) continue;
        const float u = fx_ * p_camera.x() / z + cx_ + 0.5F;
        const float v = fy_ * p_camera.y() / z + cy_ + 0.5F;
        if (u >= 0.0F && v >= 0.0F && u < width_ && v < height_)
          visit(i, p_camera, static_cast<int>(u), static_cast<int>(v));
      }
    }
  }

 private:
  Intrinsics camera_;
  Eigen::Isometry3d T_camera_world_;
  double resolution_m_;
  float fx_, fy_, cx_, cy_, width_, height_;
  /// Offsets from the centre of a brick's first voxel to the centres of the voxels along each axis, in the
  /// camera frame, m.
  std::array<std::array<Eigen::Vector3f, kCellBrickEdge>, 3> steps_;
  /// Offset from the centre of a coarse cell's lowest voxel to the cell's centre, in the camera frame, m.
  Eigen::Vector3f to_coarse_centre_;
};

}  // namespace roomradar
