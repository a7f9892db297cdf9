// session_room.cpp: tests objects for unknown space, and computes the extent of the map.
#include "app/session/session_room.hpp"

#include <algorithm>
#include <utility>

namespace roomradar {
namespace {

/// Returns the box around the map's surface and observed space, in the world.
Eigen::AlignedBox3d known_box(const SavedMap& map) {
  Eigen::AlignedBox3d box = map.info.counts.known_world.isEmpty()  // not loaded from a folder
                                ? map.octree.load().counts().known_world
                                : map.info.counts.known_world;
  for (const Eigen::Vector3f& vertex : map.mesh.vertices) box.extend(map.mesh.origin + vertex.cast<double>());
  return box;
}

}  // namespace

RoomPreparation prepare_room(const SavedMap& map, bool will_search) {
  RoomPreparation preparation;
  preparation.tree = std::async(std::launch::async, [&map] {
    TriangleTree tree;
    tree.build_by_place(map.mesh);
    return tree;
  });
  if (will_search)
    preparation.patches =
        std::async(std::launch::async, [&map] { return build_patch_index(map.keyframe_database.load()); });
  return preparation;
}

bool is_unknown_at(const SessionRoom& room, const Eigen::Vector3d& p_world) {
  return room.tiles != nullptr ? room.tiles->is_unknown_at(p_world) : is_unknown(*room.unknown, p_world);
}

bool is_loaded_round(const SessionRoom& room, const VirtualObject& object) {
  constexpr double kMargin_m = 0.3;  // an object falls less than this from frame to frame
  if (room.tiles == nullptr) return true;
  const Eigen::Vector3d reach_m = Eigen::Vector3d::Constant(radius_m(object) + kMargin_m);
  const Eigen::Vector3d middle = middle_world(object);
  return room.tiles->is_loaded({middle - reach_m, middle + reach_m});
}

void set_unknown(SessionRoom& room, const SavedMap& map) {
  room.unknown = map.unknown.load()
                     ? map.unknown.load()
                     : std::make_shared<const UnknownSurface>(unknown_surface(map.octree.load(), map.mesh));
  room.unknown_tree.build_by_place(room.unknown->mesh_world);
}

void take_over(SessionRoom& room, ChangedRoom& changed) {
  room.shape.set(changed.mesh, std::move(changed.tree));
  if (!room.unknown) return;
  room.unknown = std::make_shared<const UnknownSurface>(std::move(changed.unknown));
  room.unknown_tree = std::move(changed.unknown_tree);
}

bool is_in_solid_unknown(const SessionRoom& room, const VirtualObject& object) {
  return is_in_solid_unknown(room, object, object.body.T_world_object);
}

bool is_in_solid_unknown(const SessionRoom& room, const VirtualObject& object,
                         const Eigen::Isometry3d& T_world_object) {
  if (!room.unknown_is_solid) return false;
  const GpuMesh& mesh = object.model->shape.drawn;
  const auto corner = [&](std::uint32_t vertex) -> Eigen::Vector3d {
    return T_world_object * (mesh.origin() + mesh.vertices()[vertex].cast<double>());
  };
  const auto triangles = mesh.triangles();
  return std::any_of(triangles.begin(), triangles.end(), [&](const Triangle& triangle) {
    const Eigen::Vector3d a = corner(triangle[0]), b = corner(triangle[1]), c = corner(triangle[2]);
    return is_unknown_at(room, a) || is_unknown_at(room, b) || is_unknown_at(room, c) ||
           is_unknown_at(room, (a + b + c) / 3.0);
  });
}

void set_extent(SessionRoom& room, const SavedMap& map) {
  const Eigen::AlignedBox3d box = known_box(map);
  room.lowest_known_m = box.min().z();
  room.extent_m = box.isEmpty() ? 0.0 : box.sizes().maxCoeff();
}

}  // namespace roomradar
