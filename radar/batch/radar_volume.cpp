// radar_volume.cpp: fits pixels around an object seen along a direction.
#include "radar/batch/radar_volume.hpp"

#include <algorithm>
#include <cmath>

#include "radar/geometry/frame_along.hpp"

namespace roomradar {
namespace {

/// Returns the bounds of the triangles' vertices in a rotated frame. Skips chunks whose box lies within the
/// bounds so far.
Eigen::AlignedBox3d turned_bounds(const GpuMesh& mesh, const Eigen::Matrix3d& R_frame_mesh) {
  Eigen::AlignedBox3d bounds;
  const Eigen::Matrix3d reach = R_frame_mesh.cwiseAbs();
  for (const MeshChunk& chunk : mesh.chunks()) {
    const Eigen::Vector3d centre = R_frame_mesh * chunk.bounds_local.center().cast<double>();
    const Eigen::Vector3d half = reach * (0.5 * chunk.bounds_local.sizes().cast<double>());
    if (bounds.contains(Eigen::AlignedBox3d(centre - half, centre + half))) continue;
    for (const Triangle& triangle : mesh.triangles().subspan(chunk.first_triangle, chunk.triangle_count)) {
      for (const std::uint32_t vertex : triangle) {
        bounds.extend(R_frame_mesh * mesh.vertices()[vertex].cast<double>());
      }
    }
  }
  return bounds;
}

}  // namespace

RadarOutline fit_outline(const GpuMesh& mesh, const Eigen::Vector3d& u_mesh, int resolution_px) {
  RadarOutline outline;
  outline.R_outline_mesh = frame_along(u_mesh);
  const Eigen::AlignedBox3d bounds = turned_bounds(mesh, outline.R_outline_mesh);
  const Eigen::Vector3d size_m = bounds.sizes();
  outline.length_m = size_m.z();

  const PixelGrid grid = fit_pixels(size_m.x(), size_m.y(), resolution_px);
  outline.pixel_m = grid.pixel_m;
  outline.width_px = grid.width_px;
  outline.height_px = grid.height_px;
  outline.corner_m = {bounds.center().x() - 0.5 * outline.width_px * outline.pixel_m,
                      bounds.center().y() - 0.5 * outline.height_px * outline.pixel_m, bounds.max().z()};
  return outline;
}

Eigen::Matrix<double, 3, 4> outline_from_object(const RadarOutline& outline) {
  Eigen::Matrix<double, 3, 4> result;
  result << outline.R_outline_mesh, -outline.corner_m;
  result.topRows<2>() /= outline.pixel_m;
  return result;
}

Eigen::Matrix<double, 3, 4> outline_from_local(const RadarOutline& outline, const MeshInstance& object,
                                               const MeshInstance& instance) {
  const Eigen::Matrix3d R_outline_world = outline.R_outline_mesh * object.T_world_mesh.linear().transpose();
  const Eigen::Vector3d between_origins_world =
      instance.T_world_mesh * instance.mesh->origin() - object.T_world_mesh * object.mesh->origin();
  Eigen::Matrix<double, 3, 4> result;
  result << R_outline_world * instance.T_world_mesh.linear(),
      R_outline_world * between_origins_world - outline.corner_m;
  result.topRows<2>() /= outline.pixel_m;
  return result;
}

RadarVolume volume_of(const RadarOutline& outline, const MeshInstance& object, double distance_m) {
  const Eigen::Matrix3d R_world_outline = object.T_world_mesh.linear() * outline.R_outline_mesh.transpose();
  RadarVolume volume;
  volume.x_world = R_world_outline.col(0);
  volume.y_world = R_world_outline.col(1);
  volume.u_world = R_world_outline.col(2);
  volume.pixel_m = outline.pixel_m;
  volume.length_m = outline.length_m;
  volume.depth_m = outline.length_m + distance_m;
  volume.width_px = outline.width_px;
  volume.height_px = outline.height_px;
  volume.origin_world = object.T_world_mesh * object.mesh->origin() + R_world_outline * outline.corner_m -
                        outline.length_m * volume.u_world;
  return volume;
}

double vertex_error_px(const GpuMesh& mesh, const RadarOutline& outline) {
  const Eigen::AlignedBox3d bounds = mesh.bounds();
  const Eigen::Vector3d farthest =
      (bounds.min() - mesh.origin()).cwiseAbs().cwiseMax((bounds.max() - mesh.origin()).cwiseAbs());
  const Eigen::Matrix<double, 3, 4> to_outline = outline_from_object(outline).cwiseAbs();
  return 4.3e-7 * (to_outline.leftCols<3>() * farthest + to_outline.col(3)).head<2>().maxCoeff();
}

double touching_m(const RadarOutline& outline, double distance_m) {
  return 1e-5 + 1e-6 * (outline.length_m + distance_m);
}

}  // namespace roomradar
