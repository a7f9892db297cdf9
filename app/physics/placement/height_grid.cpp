// height_grid.cpp: sorts the points of a depth image into horizontal cells.
#include "app/physics/placement/height_grid.hpp"

#include <algorithm>
#include <cmath>

namespace roomradar {

HeightGrid::HeightGrid(const DepthImage& depth_m, const Intrinsics& camera,
                       const Eigen::Isometry3d& T_world_camera, const HeightGridConfig& config, int margin)
    : config_(config), origin_world_(T_world_camera.translation()) {
  collect(depth_m, camera, T_world_camera.linear().cast<float>());
  if (!points_.empty()) fill(margin);
  points_ = {};
}

/// Adds a point, relative to the camera, in the world's axes.
void HeightGrid::append(const Eigen::Vector3f& point) {
  const auto per_m = static_cast<float>(1.0 / config_.cell_m);
  // A wide-angle lens sees farther to the sides.
  const int most = static_cast<int>(std::ceil(1.5 * config_.max_range_m / config_.cell_m));
  const int i = static_cast<int>(std::floor(point.x() * per_m + 0.5F));
  const int j = static_cast<int>(std::floor(point.y() * per_m + 0.5F));
  if (std::max(std::abs(i), std::abs(j)) > most) return;
  points_.push_back({i, j, point.z()});
  seen_.extend(Eigen::Vector2i(i, j));
}

/// Adds points between four neighbouring pixels that see one level surface and are more than a cell apart, as
/// in images of few pixels: no pixel between them could show anything else.
void HeightGrid::append_between(const std::array<Eigen::Vector3f, 4>& corners) {
  constexpr float kFarthest_m = 0.06F;  // pixels farther apart may hide something
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& corner : corners) {
    if (!corner.allFinite()) return;
    box.extend(corner);
  }
  const Eigen::Vector3f size = box.sizes();
  const float wide_m = std::max(size.x(), size.y());
  const auto cell_m = static_cast<float>(config_.cell_m);
  if (wide_m <= cell_m || wide_m > kFarthest_m) return;
  // Surface seen past a low edge lies farther apart, and at another height.
  if (size.z() > static_cast<float>(0.5 * config_.flatness_m)) return;
  const int steps = static_cast<int>(std::ceil(1.5F * wide_m / cell_m));
  for (int j = 0; j <= steps; ++j)
    for (int i = 0; i <= steps; ++i) {
      const float u = static_cast<float>(i) / static_cast<float>(steps);
      const float v = static_cast<float>(j) / static_cast<float>(steps);
      append((1 - v) * ((1 - u) * corners[0] + u * corners[1]) + v * ((1 - u) * corners[2] + u * corners[3]));
    }
}

/// Sets points_ to the visible points within range.
void HeightGrid::collect(const DepthImage& depth_m, const Intrinsics& camera,
                         const Eigen::Matrix3f& R_world_camera) {
  // Subsampling: enough pixels per row for the farthest cells; more per column, since floors are seen at a
  // slant.
  constexpr double kOfCell = 0.75;
  const double apart_px = kOfCell * config_.cell_m * camera.fx_px / config_.max_range_m;
  const int across = static_cast<int>(std::clamp(apart_px, 1.0, static_cast<double>(camera.width_px)));
  const int down = std::max(across / 2, 1);
  points_.reserve(depth_m.pixels.size() / static_cast<std::size_t>(across * down));
  const auto nearest_m = static_cast<float>(config_.min_range_m),
             farthest_m = static_cast<float>(config_.max_range_m);
  const int columns = (camera.width_px + across - 1) / across;
  PixelRow above(static_cast<std::size_t>(columns)), row(above);
  for (int y = 0; y < camera.height_px; y += down, above.swap(row)) {
    for (int column = 0; column < columns; ++column) {
      const int x = column * across;
      const auto at = static_cast<std::size_t>(column);
      const float z_m = depth_m.at(x, y);
      const bool is_seen = z_m >= nearest_m && z_m <= farthest_m;
      row[at] = is_seen ? Eigen::Vector3f(R_world_camera * back_project(camera, x, y, z_m).cast<float>())
                        : Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
      if (is_seen) append(row[at]);
      if (y > 0 && column > 0) append_between({above[at - 1], above[at], row[at - 1], row[at]});
    }
  }
}

/// Lays the grid around the visible points and sets the height of each cell.
void HeightGrid::fill(int margin) {
  // A square around the visible points.
  half_ = (seen_.sizes().maxCoeff() + 1) / 2 + margin;
  size_ = 2 * half_ + 1;
  const Eigen::Vector2i middle = seen_.min() + seen_.sizes() / 2;
  origin_world_.head<2>() += config_.cell_m * middle.cast<double>();
  const std::size_t cells = static_cast<std::size_t>(size_) * static_cast<std::size_t>(size_);
  std::vector<float> highest_m(cells, kUnseen);
  std::vector<float> sum_m(cells, 0.0F);
  std::vector<int> count(cells, 0);
  const auto cell_of = [&](const Seen& point) {
    return index(point.i - middle.x() + half_, point.j - middle.y() + half_);
  };
  for (const Seen& point : points_)
    highest_m[cell_of(point)] = std::max(highest_m[cell_of(point)], point.height_m);
  // The mean of the topmost layer; its highest point would be the noisiest.
  const auto layer_m = static_cast<float>(2.0 * config_.flatness_m);
  for (const Seen& point : points_) {
    const std::size_t cell = cell_of(point);
    if (point.height_m < highest_m[cell] - layer_m) continue;
    sum_m[cell] += point.height_m;
    ++count[cell];
  }
  top_m_.assign(cells, kUnseen);
  for (std::size_t cell = 0; cell < cells; ++cell)
    if (count[cell] > 0) top_m_[cell] = sum_m[cell] / static_cast<float>(count[cell]);
}

}  // namespace roomradar
