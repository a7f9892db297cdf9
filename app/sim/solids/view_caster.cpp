// view_caster.cpp: bins solids into tiles by separating planes through the camera's centre.
#include "app/sim/solids/view_caster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace roomradar {
namespace {

using Eigen::Vector3d;

constexpr int kTile_px = 16;
/// Tiles left and right of the image, for a projector's rays to surfaces that the camera sees: a Kinect's
/// disparity is 88 px at 0.5 m.
constexpr int kColumnsBeside = 6;
/// Tiles above and below it, for rays that deviate from their pixel's centre.
constexpr int kRowsBeside = 1;

/// Image coordinate of the edge between a tile and the one before it.
double edge_px(int tile, int tiles_beside) { return (tile - tiles_beside) * kTile_px - 0.5; }
int tile_at(double at_px, int tiles_beside) {
  return static_cast<int>(std::floor((at_px + 0.5) / kTile_px)) + tiles_beside;
}

/// Min and max of n . p over a solid's bounding box, in camera coordinates.
struct Extent {
  double least, greatest;
};
Extent extent_along(const Vector3d& n, const Vector3d& centre_camera, const Eigen::Matrix3d& R_solid_camera,
                    const Vector3d& half_m) {
  const double middle = n.dot(centre_camera);
  const double reach = (R_solid_camera * n).cwiseAbs().dot(half_m);
  return {middle - reach, middle + reach};
}

}  // namespace

void ViewCaster::prepare(std::span<const Solid> solids, const Intrinsics& camera,
                         const Eigen::Isometry3d& T_world_camera) {
  camera_ = camera;
  columns_ = (camera.width_px + kTile_px - 1) / kTile_px + 2 * kColumnsBeside;
  rows_ = (camera.height_px + kTile_px - 1) / kTile_px + 2 * kRowsBeside;
  prepared_.clear();
  nearest_first_.clear();

  for (std::size_t i = 0; i < solids.size(); ++i) {
    const Solid& solid = solids[i];
    const Eigen::Matrix3d R_solid_world = solid.T_world_solid.linear().transpose();
    const Eigen::Matrix3d R_solid_camera = R_solid_world * T_world_camera.linear();
    const Vector3d camera_solid =
        R_solid_world * (T_world_camera.translation() - solid.T_world_solid.translation());
    const Vector3d centre_camera = -(R_solid_camera.transpose() * camera_solid);
    const Vector3d half_m = bounds_half_m(solid);
    const Extent depth = extent_along(Vector3d::UnitZ(), centre_camera, R_solid_camera, half_m);
    Prepared& prepared = prepared_.emplace_back(Prepared{solid, R_solid_camera, camera_solid, 0, 0, 0, 0});
    if (depth.greatest <= 0.0) continue;
    nearest_first_.push_back({static_cast<int>(i), std::max(depth.least, 0.0)});
    // A tile's column is the wedge between two planes through the camera's centre. It extends half a pixel
    // beyond the outermost pixel centres, so rays between two pixels find their solids too.
    const auto range = [&](int tiles, int beside, double focal_px, double centre_px, int axis) {
      const auto plane_before = [&](int tile) {  // positive on the side of greater image coordinates
        Vector3d n = Vector3d::Zero();
        n[axis] = focal_px;
        n.z() = centre_px - edge_px(tile, beside);
        return extent_along(n, centre_camera, R_solid_camera, half_m);
      };
      int begin = tiles, end = 0;
      Extent low = plane_before(0);
      for (int tile = 0; tile < tiles; ++tile) {
        const Extent high = plane_before(tile + 1);
        if (low.greatest >= 0.0 && high.least <= 0.0) {
          begin = std::min(begin, tile);
          end = tile + 1;
        }
        low = high;
      }
      return std::pair(begin, end);
    };
    std::tie(prepared.column_begin, prepared.column_end) =
        range(columns_, kColumnsBeside, camera.fx_px, camera.cx_px, 0);
    std::tie(prepared.row_begin, prepared.row_end) = range(rows_, kRowsBeside, camera.fy_px, camera.cy_px, 1);
  }
  const auto is_nearer = [](const Candidate& a, const Candidate& b) {
    return a.nearest_m < b.nearest_m || (a.nearest_m == b.nearest_m && a.solid < b.solid);
  };
  std::sort(nearest_first_.begin(), nearest_first_.end(), is_nearer);

  tiles_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::vector<Candidate>& tile : tiles_) tile.clear();
  for (const Candidate& candidate : nearest_first_) {
    const Prepared& prepared = prepared_[static_cast<std::size_t>(candidate.solid)];
    for (int row = prepared.row_begin; row < prepared.row_end; ++row)
      for (int column = prepared.column_begin; column < prepared.column_end; ++column) {
        const double nearest_m = nearest_in_tile_m(prepared, column, row);
        if (std::isfinite(nearest_m))
          tiles_[static_cast<std::size_t>(row * columns_ + column)].push_back({candidate.solid, nearest_m});
      }
  }
  for (std::vector<Candidate>& tile : tiles_) std::sort(tile.begin(), tile.end(), is_nearer);
}

double ViewCaster::nearest_in_tile_m(const Prepared& prepared, int column, int row) const {
  constexpr double kRounding = 1e-9;
  const Eigen::Matrix3d& R = prepared.R_solid_camera;
  const double half_x = 0.5 * kTile_px / camera_.fx_px, half_y = 0.5 * kTile_px / camera_.fy_px;
  const double x = (edge_px(column, kColumnsBeside) + 0.5 * kTile_px - camera_.cx_px) / camera_.fx_px;
  const double y = (edge_px(row, kRowsBeside) + 0.5 * kTile_px - camera_.cy_px) / camera_.fy_px;
  // The tile's rays have directions middle +- spread in the solid's frame.
  const Vector3d middle = R.col(0) * x + R.col(1) * y + R.col(2);
  const Vector3d spread = R.col(0).cwiseAbs() * half_x + R.col(1).cwiseAbs() * half_y;
  const Vector3d half_m = bounds_half_m(prepared.solid);
  double enters_m = 0.0;
  double leaves_m = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double speed = std::abs(middle[axis]);
    const bool is_one_way = speed > spread[axis];
    const double way_m = is_one_way ? -std::copysign(1.0, middle[axis]) * prepared.camera_solid[axis]
                                    : std::abs(prepared.camera_solid[axis]);
    enters_m = std::max(enters_m, (way_m - half_m[axis]) / (speed + spread[axis]));
    if (is_one_way) leaves_m = std::min(leaves_m, (way_m + half_m[axis]) / (speed - spread[axis]));
  }
  return enters_m <= leaves_m * (1.0 + kRounding) ? enters_m * (1.0 - kRounding)
                                                  : std::numeric_limits<double>::infinity();
}

std::span<const ViewCaster::Candidate> ViewCaster::candidates(double u_px, double v_px) const {
  const int column = tile_at(u_px, kColumnsBeside);
  const int row = tile_at(v_px, kRowsBeside);
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return nearest_first_;
  return tiles_[static_cast<std::size_t>(row * columns_ + column)];
}

double ViewCaster::entry(int solid, double x, double y) const {
  const Prepared& prepared = prepared_[static_cast<std::size_t>(solid)];
  const Vector3d direction = prepared.R_solid_camera.col(0) * x + prepared.R_solid_camera.col(1) * y +
                             prepared.R_solid_camera.col(2);
  return ray_entry_local(prepared.solid, prepared.camera_solid, direction);
}

PixelHit ViewCaster::cast(double u_px, double v_px) const {
  const double x = (u_px - camera_.cx_px) / camera_.fx_px;
  const double y = (v_px - camera_.cy_px) / camera_.fy_px;
  PixelHit hit;
  for (const Candidate& candidate : candidates(u_px, v_px)) {
    if (hit.solid >= 0 && candidate.nearest_m >= hit.depth_m) break;
    const double depth_m = entry(candidate.solid, x, y);
    if (depth_m > 0.0 && (hit.solid < 0 || depth_m < hit.depth_m)) hit = {depth_m, candidate.solid};
  }
  return hit;
}

double ViewCaster::depth_of(int solid, double u_px, double v_px) const {
  const double x = (u_px - camera_.cx_px) / camera_.fx_px;
  const double y = (v_px - camera_.cy_px) / camera_.fy_px;
  return std::max(entry(solid, x, y), 0.0);
}

bool ViewCaster::is_blocked(double u_px, double v_px, double depth_m) const {
  const double x = (u_px - camera_.cx_px) / camera_.fx_px;
  const double y = (v_px - camera_.cy_px) / camera_.fy_px;
  for (const Candidate& candidate : candidates(u_px, v_px)) {
    if (candidate.nearest_m >= depth_m) return false;
    const double blocker_m = entry(candidate.solid, x, y);
    if (blocker_m > 0.0 && blocker_m < depth_m) return true;
  }
  return false;
}

Vector3d ViewCaster::local_point(int solid, double u_px, double v_px, double depth_m) const {
  const Prepared& prepared = prepared_[static_cast<std::size_t>(solid)];
  return prepared.camera_solid + prepared.R_solid_camera * back_project(camera_, u_px, v_px, depth_m);
}

}  // namespace roomradar
