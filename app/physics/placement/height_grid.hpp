// height_grid.hpp: height map, seen from above, of the surfaces in a depth image.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

struct HeightGridConfig {
  double cell_m = 0.02;       ///< cell size, > 0
  double flatness_m = 0.015;  ///< points up to twice this below a cell's highest point are averaged
  double min_range_m = 0.4;   ///< min depth along the camera's axis
  double max_range_m = 4.0;   ///< max depth along the camera's axis
};

/// Height of the topmost surface in each cell of a horizontal grid around the visible points, padded by
/// `margin` unseen cells on each side. The grid is empty if nothing is visible. Gaps of up to 6 cm between
/// neighbouring sampled pixels are interpolated if their heights differ by at most flatness_m / 2.
class HeightGrid {
 public:
  static constexpr float kUnseen = -std::numeric_limits<float>::infinity();

  /// @param depth_m         depth image, width_px x height_px of `camera`
  /// @param T_world_camera  world with +z up
  HeightGrid(const DepthImage& depth_m, const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
             const HeightGridConfig& config, int margin);

  /// Cells per side; 0 if nothing is visible.
  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(size_) + static_cast<std::size_t>(i);
  }
  /// Returns a pointer to a cell's height above the camera (m), usually negative; kUnseen if nothing was
  /// seen. Cells are stored row by row. The pointer may be moved by up to `margin` cells from a seen cell.
  [[nodiscard]] const float* top_m(int i, int j) const { return &top_m_[index(i, j)]; }
  /// Returns the world point at the middle of a cell, at a height above the camera.
  [[nodiscard]] Eigen::Vector3d point_world(int i, int j, double height_m) const {
    return origin_world_ +
           Eigen::Vector3d((i - half_) * config_.cell_m, (j - half_) * config_.cell_m, height_m);
  }

 private:
  struct Seen {
    int i, j;  // cell indices relative to the camera
    float height_m;
  };
  /// Points of a row of sampled pixels, relative to the camera; NaN where nothing was seen.
  using PixelRow = std::vector<Eigen::Vector3f>;

  HeightGridConfig config_;
  Eigen::Vector3d origin_world_;  // above the middle cell, at the camera's height
  int half_ = 0;
  int size_ = 0;
  std::vector<Seen> points_;
  Eigen::AlignedBox2i seen_;  // bounds of the points' cells
  std::vector<float> top_m_;

  void append(const Eigen::Vector3f& point);
  void append_between(const std::array<Eigen::Vector3f, 4>& corners);
  void collect(const DepthImage& depth_m, const Intrinsics& camera, const Eigen::Matrix3f& R_world_camera);
  void fill(int margin);
};

}  // namespace roomradar
