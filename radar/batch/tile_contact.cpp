// tile_contact.cpp: status and bounds from the tile's least gap; point and normal from the touched triangle.
#include "radar/batch/tile_contact.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "radar/exact/radar_pictures.hpp"

namespace roomradar {
namespace {

const Eigen::Vector2d kSample_px(kSampleX_px, kSampleY_px);  // as in tile_shaders.hpp

}  // namespace

Contact contact_of(const GlQuery& query, const RadarOutline& outline, const TileResult& result,
                   std::span<const SceneRun> runs, std::span<const GpuSceneMesh> scene) {
  const double touching = touching_m(outline, query.distance_m);
  Contact contact;
  contact.pixel_m = outline.pixel_m;
  constexpr double kSubtraction = 1.0 - 2e-7;  // rounding of the z of scene and object to float
  contact.lower_m = std::min(kSubtraction * result.lower_m, query.distance_m);
  if (!(result.contact_distance_m <= query.distance_m + touching)) {
    contact.status = ContactStatus::kNoTarget;
    return contact;
  }
  if (result.contact_distance_m < -touching) {
    contact.status = ContactStatus::kOverlap;
    contact.contact_distance_m = contact.lower_m = contact.upper_m = result.contact_distance_m;
  } else {
    contact.status = ContactStatus::kContact;
    contact.contact_distance_m = std::max(static_cast<double>(result.contact_distance_m), 0.0);
    contact.lower_m = std::min(contact.lower_m, contact.contact_distance_m);
    contact.upper_m =
        std::max(static_cast<double>(result.upper_m) / kSubtraction, contact.contact_distance_m);
  }

  // The touched triangle at the pixel's centre line, in double.
  const RadarVolume volume = volume_of(outline, query.object, query.distance_m);
  contact.normal_world = -volume.u_world;
  Eigen::Vector3d at(result.x_px + kSample_px.x(), result.y_px + kSample_px.y(), result.contact_distance_m);
  const auto past =
      std::upper_bound(runs.begin(), runs.end(), result.key,
                       [](std::uint32_t key, const SceneRun& run) { return key < run.first_key; });
  if (result.key != std::numeric_limits<std::uint32_t>::max() && past != runs.begin()) {
    const SceneRun& run = *(past - 1);
    const GpuSceneMesh& met = scene[run.scene_index];
    const GpuMesh& mesh = *met.instance.mesh;
    const Triangle& triangle = mesh.triangles()[run.first_triangle + (result.key - run.first_key)];
    std::array<Eigen::Vector3d, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = mesh.vertices()[triangle[i]].cast<double>();
    const Eigen::Vector3d normal_local = (p[1] - p[0]).cross(p[2] - p[0]);
    const Eigen::Matrix<double, 3, 4> to_outline = outline_from_local(outline, query.object, met.instance);
    for (Eigen::Vector3d& corner : p) corner = to_outline.leftCols<3>() * corner + to_outline.col(3);
    const Eigen::Vector3d normal_outline = (p[1] - p[0]).cross(p[2] - p[0]);
    at.z() = p[0].z() - normal_outline.head<2>().dot(at.head<2>() - p[0].head<2>()) / normal_outline.z();
    contact.normal_world = (met.instance.T_world_mesh.linear() * normal_local).stableNormalized();
    if (contact.normal_world.dot(volume.u_world) > 0.0) contact.normal_world = -contact.normal_world;
    contact.touched = met.kind;
  }
  contact.point_world = volume.origin_world + at.x() * outline.pixel_m * volume.x_world +
                        at.y() * outline.pixel_m * volume.y_world +
                        (at.z() + outline.length_m) * volume.u_world;
  return contact;
}

}  // namespace roomradar
