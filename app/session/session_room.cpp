// session_room.cpp: whether an object is in unknown space, and where the map ends.
#include "app/session/session_room.hpp"

#include <algorithm>

namespace roomradar {

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

double lowest_known_m(const SavedMap& map) {
  const Eigen::AlignedBox3d known_world = map.info.counts.known_world.isEmpty()  // not loaded from a folder
                                              ? map.octree.counts().known_world
                                              : map.info.counts.known_world;
  double lowest_m = known_world.min().z();
  for (const Eigen::Vector3f& vertex : map.mesh.vertices)
    lowest_m = std::min(lowest_m, map.mesh.origin.z() + static_cast<double>(vertex.z()));
  return lowest_m;
}

}  // namespace roomradar
