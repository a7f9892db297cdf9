// session_room.cpp: tests objects for unknown space, and computes the extent of the map.
#include "app/session/session_room.hpp"

#include <algorithm>

namespace roomradar {
namespace {

/// Returns the box around the map's surface and observed space, in the world.
Eigen::AlignedBox3d known_box(const SavedMap& map) {
  Eigen::AlignedBox3d box = map.info.counts.known_world.isEmpty()  // not loaded from a folder
                                ? map.octree->counts().known_world
                                : map.info.counts.known_world;
  for (const Eigen::Vector3f& vertex : map.mesh.vertices) box.extend(map.mesh.origin + vertex.cast<double>());
  return box;
}

}  // namespace

bool is_in_solid_unknown(const SessionRoom& room, const VirtualObject& object) {
  return is_in_solid_unknown(room, object, object.body.T_world_object);
}

bool is_in_solid_unknown(const SessionRoom& room, const VirtualObject& object,
                         const Eigen::Isometry3d& T_world_object) {
  if (!room.unknown_is_solid) return false;
  const UnknownSurface& unknown = *room.unknown;
  const GpuMesh& mesh = object.model->shape.drawn;
  const auto corner = [&](std::uint32_t vertex) -> Eigen::Vector3d {
    return T_world_object * (mesh.origin() + mesh.vertices()[vertex].cast<double>());
  };
  const auto triangles = mesh.triangles();
  return std::any_of(triangles.begin(), triangles.end(), [&](const Triangle& triangle) {
    const Eigen::Vector3d a = corner(triangle[0]), b = corner(triangle[1]), c = corner(triangle[2]);
    return is_unknown(unknown, a) || is_unknown(unknown, b) || is_unknown(unknown, c) ||
           is_unknown(unknown, (a + b + c) / 3.0);
  });
}

double lowest_known_m(const SavedMap& map) { return known_box(map).min().z(); }

double extent_m(const SavedMap& map) {
  const Eigen::AlignedBox3d box = known_box(map);
  return box.isEmpty() ? 0.0 : box.sizes().maxCoeff();
}

}  // namespace roomradar
