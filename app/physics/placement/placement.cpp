// placement.cpp: finds a level surface in view, on a height map seen from above.
#include "app/physics/placement/placement.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/linear_algebra.hpp"
#include "mapping/types/system/config_check.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

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

constexpr float kUnseen = HeightGrid::kUnseen;

/// Cells of the grid that an object covers, relative to its centre.
struct FootprintCells {
  struct Cell {
    std::ptrdiff_t away;  // offset in the grid
    double x_m, y_m;
    float most_rise_m;  // max height difference from the centre of a surface on which the object can stand
    bool is_core;       // must be measured
  };
  std::vector<Cell> cells;  // from the rim inwards, since edges show first at the rim
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();  // sums of (1, x, y) (1, x, y)^T
};

double steepest_of(const PlacementConfig& config) {
  return std::tan(config.max_tilt_deg * std::numbers::pi / 180.0);
}

FootprintCells cells_under(double radius_cells, int grid_size, const PlacementConfig& config) {
  constexpr double kCore_m = 0.06;  // a hole this near the centre could let a small object through
  FootprintCells footprint;
  const int reach = static_cast<int>(std::floor(radius_cells));
  for (int j = -reach; j <= reach; ++j) {
    for (int i = -reach; i <= reach; ++i) {
      if (i * i + j * j > radius_cells * radius_cells) continue;
      const Eigen::Vector3d row(1.0, i * config.cell_m, j * config.cell_m);
      footprint.moments += row * row.transpose();
      footprint.cells.push_back(
          {static_cast<std::ptrdiff_t>(j) * grid_size + i, row.y(), row.z(),
           static_cast<float>(2.0 * config.flatness_m + steepest_of(config) * row.tail<2>().norm()),
           row.tail<2>().norm() <= kCore_m});
    }
  }
  std::stable_sort(footprint.cells.begin(), footprint.cells.end(),
                   [](const auto& a, const auto& b) { return a.most_rise_m > b.most_rise_m; });
  return footprint;
}

struct Footprint {
  bool is_level = false;
  double height_m = 0.0;  // of the fitted plane, at the centre
};

/// Fits z = a + b x + c y to the heights under the footprint, and decides if an object can stand there.
/// @param top_m  of the centre, in a grid whose margin is at least the footprint's radius
Footprint footprint_at(const float* top_m, const FootprintCells& footprint, const PlacementConfig& config) {
  const float middle_m = *top_m;
  if (middle_m == kUnseen) return {};
  const auto all = static_cast<double>(footprint.cells.size());
  const int most_unseen = static_cast<int>(std::min((1.0 - config.min_seen) * all, all - 3.0));
  if (most_unseen < 0) return {};  // too few cells for a plane
  Eigen::Matrix3d moments = footprint.moments;
  double rises_m = 0.0, x_rises_m2 = 0.0, y_rises_m2 = 0.0;
  int unseen = 0;
  for (const FootprintCells::Cell& cell : footprint.cells) {
    const float cell_top_m = top_m[cell.away];
    if (cell_top_m == kUnseen) {
      if (cell.is_core || ++unseen > most_unseen) return {};
      const Eigen::Vector3d row(1.0, cell.x_m, cell.y_m);
      moments -= row * row.transpose();
      continue;
    }
    const float rise_m = cell_top_m - middle_m;
    if (std::abs(rise_m) > cell.most_rise_m) return {};  // an edge: no fit needed
    rises_m += rise_m;
    x_rises_m2 += cell.x_m * rise_m;
    y_rises_m2 += cell.y_m * rise_m;
  }
  const Eigen::Vector3d plane = solve_symmetric(moments, Eigen::Vector3d(rises_m, x_rises_m2, y_rises_m2));
  if (!plane.allFinite() || plane.tail<2>().norm() > steepest_of(config)) return {};

  for (const FootprintCells::Cell& cell : footprint.cells) {
    const float cell_top_m = top_m[cell.away];
    if (cell_top_m == kUnseen) continue;
    const double off_m = cell_top_m - middle_m - plane[0] - plane[1] * cell.x_m - plane[2] * cell.y_m;
    if (std::abs(off_m) > config.flatness_m) return {};
  }
  return {true, middle_m + plane[0]};
}

/// Computes the footprint of this radius at each cell of a grid; the grid's margin must be at least as large.
std::vector<Footprint> footprints(const HeightGrid& grid, double radius_m, const PlacementConfig& config) {
  const FootprintCells cells = cells_under(radius_m / config.cell_m, grid.size(), config);
  std::vector<Footprint> all(static_cast<std::size_t>(grid.size()) * static_cast<std::size_t>(grid.size()));
  for (int j = 0; j < grid.size(); ++j)
    for (int i = 0; i < grid.size(); ++i)
      all[grid.index(i, j)] = footprint_at(grid.top_m(i, j), cells, config);
  return all;
}

/// Distance of a place from where it is wanted, m or fractions of the picture's width; infinite if too far.
using Distance = std::function<double(const Eigen::Vector3d& point_world)>;

Distance distance_from_wanted(const SupportQuery& query, const Intrinsics& camera,
                              const Eigen::Isometry3d& T_world_camera, const PlacementConfig& config) {
  constexpr double kTooFar = std::numeric_limits<double>::infinity();
  if (query.near_world)
    return [near = *query.near_world, most_m = config.max_away_m](const Eigen::Vector3d& point_world) {
      const double away_m = (point_world - near).norm();
      return away_m <= most_m ? away_m : kTooFar;
    };
  return [camera, T_camera_world = T_world_camera.inverse()](const Eigen::Vector3d& point_world) {
    const Eigen::Vector3d p_camera = T_camera_world * point_world;
    if (p_camera.z() <= 0.0) return kTooFar;
    const Eigen::Vector2d p = project(camera, p_camera);
    const Eigen::Vector2d size(camera.width_px, camera.height_px);
    const Eigen::Vector2d off = p + Eigen::Vector2d::Constant(0.5) - 0.5 * size;
    if ((off.cwiseAbs() - 0.5 * size).maxCoeff() > 0.0) return kTooFar;
    return off.norm() / camera.width_px;
  };
}

/// Returns the nearest place that the query's is_free accepts.
Support nearest_free(std::vector<std::pair<double, Eigen::Vector3d>>& places, const SupportQuery& query) {
  const double apart_m = std::max(0.06, 0.75 * query.footprint_radius_m);
  constexpr std::size_t kMaxTried = 48;
  std::sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Eigen::Vector3d> rejected;
  for (const auto& [distance, point_world] : places) {
    if (std::any_of(rejected.begin(), rejected.end(),
                    [&, &p = point_world](const auto& other) { return (p - other).norm() < apart_m; }))
      continue;
    if (!query.is_free || query.is_free(point_world)) return {SupportStatus::kFound, point_world};
    rejected.push_back(point_world);
    if (rejected.size() == kMaxTried) break;
  }
  return {SupportStatus::kBlocked};
}

}  // namespace

void require_valid(const PlacementConfig& config) {
  const ConfigCheck rules{"placement"};
  const auto require = [&](const char* name, double value, double lowest, double highest) {
    rules(value >= lowest && value <= highest, name, value,
          ("in " + format_number(lowest) + ".." + format_number(highest)).c_str());
  };
  require("cell_m", config.cell_m, 0.005, 0.1);
  require("max_tilt_deg", config.max_tilt_deg, 0.0, 60.0);
  require("flatness_m", config.flatness_m, 0.0, 0.2);
  require("min_seen", config.min_seen, 0.0, 1.0);
  require("room_to_spare_m", config.room_to_spare_m, 0.0, 1.0);
  require("min_range_m", config.min_range_m, 0.0, 10.0);
  require("max_range_m", config.max_range_m, config.min_range_m, 10.0);
  require("max_away_m", config.max_away_m, 0.0, 10.0);
}

Support find_support(const DepthImage& depth_m, const Intrinsics& camera,
                     const Eigen::Isometry3d& T_world_camera, const SupportQuery& query,
                     const PlacementConfig& config) {
  require_valid(config);
  if (!(query.footprint_radius_m > 0.0 && query.footprint_radius_m <= kMostFootprint_m)) return {};
  if (depth_m.empty() || depth_m.width != camera.width_px || depth_m.height != camera.height_px) return {};
  if (!T_world_camera.matrix().allFinite()) return {};
  if (query.near_world && !query.near_world->allFinite()) return {};

  const double radius_m = query.footprint_radius_m + config.room_to_spare_m;
  const HeightGrid grid(depth_m, camera, T_world_camera,
                        {config.cell_m, config.flatness_m, config.min_range_m, config.max_range_m},
                        std::max(static_cast<int>(radius_m / config.cell_m), 2) + 1);
  if (grid.size() == 0) return {SupportStatus::kNothingMeasured};
  const auto is_level = [](const Footprint& footprint) { return footprint.is_level; };
  const std::vector<Footprint> all = footprints(grid, radius_m, config);
  if (std::none_of(all.begin(), all.end(), is_level)) {
    const std::vector<Footprint> small =
        footprints(grid, std::max(config.room_to_spare_m, 2.0 * config.cell_m), config);
    const bool has_level = std::any_of(small.begin(), small.end(), is_level);
    return {has_level ? SupportStatus::kTooSmall : SupportStatus::kNotLevel};
  }

  const Distance distance_of = distance_from_wanted(query, camera, T_world_camera, config);
  std::vector<std::pair<double, Eigen::Vector3d>> places;
  for (int j = 0; j < grid.size(); ++j) {
    for (int i = 0; i < grid.size(); ++i) {
      const Footprint& footprint = all[grid.index(i, j)];
      if (!footprint.is_level) continue;
      const Eigen::Vector3d point_world = grid.point_world(i, j, footprint.height_m);
      const double distance = distance_of(point_world);
      if (std::isfinite(distance)) places.emplace_back(distance, point_world);
    }
  }
  if (places.empty()) return {SupportStatus::kTooFar};
  return nearest_free(places, query);
}

}  // namespace roomradar
