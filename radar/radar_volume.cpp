// radar_volume.cpp: fit the volume around an object and a direction.
#include "radar/radar_volume.hpp"

#include <algorithm>
#include <cmath>

namespace roomradar {
namespace {

/// Two unit vectors that make a right-handed frame with u.
/// Source: Duff et al., Building an Orthonormal Basis, Revisited, JCGT 6(1), 2017.
void complete_frame(const Eigen::Vector3d& u, Eigen::Vector3d& x, Eigen::Vector3d& y) {
  const double sign = std::copysign(1.0, u.z());
  const double a = -1.0 / (sign + u.z());
  const double b = u.x() * u.y() * a;
  x = {1.0 + sign * u.x() * u.x() * a, sign * b, -sign * u.x()};
  y = {b, sign + u.y() * u.y() * a, -u.y()};
}

/// Bounds of the triangles' vertices in a turned frame. Chunks whose box lies within what is known are passed
/// over.
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

RadarVolume fit_volume(const MeshInstance& object, const Eigen::Vector3d& u_world, double distance_m,
                       int resolution_px) {
  RadarVolume volume;
  volume.u_world = u_world;
  complete_frame(u_world, volume.x_world, volume.y_world);
  Eigen::Matrix3d R_frame_world;
  R_frame_world << volume.x_world.transpose(), volume.y_world.transpose(), u_world.transpose();

  // Relative to the mesh's own origin, so that nothing is lost far from the world's.
  const Eigen::AlignedBox3d bounds =
      turned_bounds(*object.mesh, R_frame_world * object.T_world_mesh.linear());
  const Eigen::Vector3d size_m = bounds.sizes();
  volume.length_m = size_m.z();
  const double pad_m = 1e-5 + 1e-6 * (size_m.z() + distance_m);
  volume.depth_m = size_m.z() + distance_m + 2.0 * pad_m;

  constexpr double kLeastSide_m = 1e-6;  // an object seen edge-on still gets pixels
  volume.pixel_m = std::max({size_m.x(), size_m.y(), kLeastSide_m}) / resolution_px;
  const auto pixels = [&](double side_m) {
    return std::clamp(static_cast<int>(std::ceil(side_m / volume.pixel_m - 1e-9)), 1, resolution_px);
  };
  volume.width_px = pixels(size_m.x());
  volume.height_px = pixels(size_m.y());

  const Eigen::Vector3d corner(bounds.center().x() - 0.5 * volume.width_px * volume.pixel_m,
                               bounds.center().y() - 0.5 * volume.height_px * volume.pixel_m,
                               bounds.min().z() - pad_m);
  volume.origin_world = object.T_world_mesh * object.mesh->origin() + R_frame_world.transpose() * corner;
  return volume;
}

Eigen::Matrix4d clip_from_world(const RadarVolume& volume) {
  Eigen::Matrix4d clip = Eigen::Matrix4d::Identity();
  const Eigen::Vector3d& origin = volume.origin_world;
  const Eigen::Vector3d x = volume.x_world * (2.0 / (volume.width_px * volume.pixel_m));
  const Eigen::Vector3d y = volume.y_world * (2.0 / (volume.height_px * volume.pixel_m));
  const Eigen::Vector3d z = volume.u_world / volume.depth_m;
  clip.row(0) << x.transpose(), -x.dot(origin) - 1.0;
  clip.row(1) << y.transpose(), -y.dot(origin) - 1.0;
  clip.row(2) << z.transpose(), -z.dot(origin);
  return clip;
}

Eigen::Matrix4d reflected_clip_from_world(const RadarVolume& volume) {
  Eigen::Matrix4d clip = clip_from_world(volume);
  clip.row(2) = clip.row(3) - clip.row(2);
  return clip;
}

}  // namespace roomradar
