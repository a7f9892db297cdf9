// view_caster.cpp: bins solids into tiles by separating planes through the camera's centre.
#include "app/sim/solids/view_caster.hpp"

#include <algorithm>
#include <cmath>

namespace roomradar {
namespace {

using Eigen::Vector3d;

constexpr int kTile_px = 16;

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
  columns_ = (camera.width_px + kTile_px - 1) / kTile_px;
  rows_ = (camera.height_px + kTile_px - 1) / kTile_px;
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
    Prepared& prepared = prepared_.emplace_back(
        Prepared{solid, R_solid_camera, camera_solid, std::max(depth.least, 0.0), 0, 0, 0, 0});
    if (depth.greatest <= 0.0) continue;
    nearest_first_.push_back(static_cast<int>(i));
    // A tile's column is the wedge between two planes through the camera's centre. It extends half a pixel
    // beyond the outermost pixel centres, so rays between two pixels find their solids too.
    const auto range = [&](int tiles, double focal_px, double centre_px, int axis, int& begin, int& end) {
      const auto plane_at = [&](double edge_px) {  // positive on the side of greater image coordinates
        Vector3d n = Vector3d::Zero();
        n[axis] = focal_px;
        n.z() = centre_px - edge_px;
        return extent_along(n, centre_camera, R_solid_camera, half_m);
      };
      begin = tiles;
      end = 0;
      Extent low = plane_at(-0.5);
      for (int tile = 0; tile < tiles; ++tile) {
        const Extent high = plane_at((tile + 1) * kTile_px - 0.5);
        if (low.greatest >= 0.0 && high.least <= 0.0) {
          begin = std::min(begin, tile);
          end = tile + 1;
        }
        low = high;
      }
    };
    range(columns_, camera.fx_px, camera.cx_px, 0, prepared.column_begin, prepared.column_end);
    range(rows_, camera.fy_px, camera.cy_px, 1, prepared.row_begin, prepared.row_end);
  }
  std::sort(nearest_first_.begin(), nearest_first_.end(), [this](int a, int b) {
    const double depth_a = prepared_[static_cast<std::size_t>(a)].nearest_m;
    const double depth_b = prepared_[static_cast<std::size_t>(b)].nearest_m;
    return depth_a < depth_b || (depth_a == depth_b && a < b);
  });

  tiles_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::vector<int>& tile : tiles_) tile.clear();
  for (const int solid : nearest_first_) {
    const Prepared& prepared = prepared_[static_cast<std::size_t>(solid)];
    for (int row = prepared.row_begin; row < prepared.row_end; ++row)
      for (int column = prepared.column_begin; column < prepared.column_end; ++column)
        tiles_[static_cast<std::size_t>(row * columns_ + column)].push_back(solid);
  }
}

std::span<const int> ViewCaster::candidates(double u_px, double v_px) const {
  const int column = static_cast<int>(std::floor((u_px + 0.5) / kTile_px));
  const int row = static_cast<int>(std::floor((v_px + 0.5) / kTile_px));
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return nearest_first_;
  return tiles_[static_cast<std::size_t>(row * columns_ + column)];
}

double ViewCaster::entry(const Prepared& prepared, double x, double y) const {
  const Vector3d direction = prepared.R_solid_camera.col(0) * x + prepared.R_solid_camera.col(1) * y +
                             prepared.R_solid_camera.col(2);
  return ray_entry_local(prepared.solid, prepared.camera_solid, direction);
}

PixelHit ViewCaster::cast(double u_px, double v_px) const {
  const double x = (u_px - camera_.cx_px) / camera_.fx_px;
  const double y = (v_px - camera_.cy_px) / camera_.fy_px;
  PixelHit hit;
  for (const int index : candidates(u_px, v_px)) {
    const Prepared& prepared = prepared_[static_cast<std::size_t>(index)];
    if (hit.solid >= 0 && prepared.nearest_m >= hit.depth_m) break;
    const double depth_m = entry(prepared, x, y);
    if (depth_m > 0.0 && (hit.solid < 0 || depth_m < hit.depth_m)) hit = {depth_m, index};
  }
  return hit;
}

double ViewCaster::depth_of(int solid, double u_px, double v_px) const {
  const double x = (u_px - camera_.cx_px) / camera_.fx_px;
  const double y = (v_px - camera_.cy_px) / camera_.fy_px;
  return std::max(entry(prepared_[static_cast<std::size_t>(solid)], x, y), 0.0);
}

bool ViewCaster::is_blocked(double u_px, double v_px, double depth_m) const {
  const double x = (u_px - camera_.cx_px) / camera_.fx_px;
  const double y = (v_px - camera_.cy_px) / camera_.fy_px;
  for (const int index : candidates(u_px, v_px)) {
    const Prepared& prepared = prepared_[static_cast<std::size_t>(index)];
    if (prepared.nearest_m >= depth_m) return false;
    const double blocker_m = entry(prepared, x, y);
    if (blocker_m > 0.0 && blocker_m < depth_m) return true;
  }
  return false;
}

Vector3d ViewCaster::local_point(int solid, double u_px, double v_px, double depth_m) const {
  const Prepared& prepared = prepared_[static_cast<std::size_t>(solid)];
  return prepared.camera_solid + prepared.R_solid_camera * back_project(camera_, u_px, v_px, depth_m);
}

}  // namespace roomradar
