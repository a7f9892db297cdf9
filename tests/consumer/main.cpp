// main.cpp: computes how far a plate can fall onto a floor and, given a saved map, onto the surface below a
// point in it.
#include <cstdio>
#include <exception>
#include <vector>

#include "mapping/map/map_folder.hpp"
#include "radar/exact/cyber_radar.hpp"

namespace {

roomradar::Mesh square(float half_m, float z_m) {
  roomradar::Mesh mesh;
  mesh.vertices = {
      {-half_m, -half_m, z_m}, {half_m, -half_m, z_m}, {half_m, half_m, z_m}, {-half_m, half_m, z_m}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

roomradar::Contact fall(const roomradar::TriangleTree& object, const roomradar::TriangleTree& ground,
                        const Eigen::Vector3d& from_world) {
  const std::vector<roomradar::SceneTree> scene{{{&ground, Eigen::Isometry3d::Identity()}}};
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  T_world_object.translation() = from_world;
  roomradar::CyberRadar radar;
  return radar.query({{&object, T_world_object}, -Eigen::Vector3d::UnitZ(), 10.0}, {scene, {}});
}

}  // namespace

int main(int argc, char** argv) {
  try {
    roomradar::TriangleTree plate, floor;
    plate.build_by_place(square(0.1F, 0.0F));
    floor.build_by_place(square(2.0F, -0.75F));
    std::printf("falls %.6f m\n", fall(plate, floor, {0.3, 0.2, 0.0}).contact_distance_m);
    if (argc < 2) return 0;
    const roomradar::SavedMap map = roomradar::load_map(argv[1]);
    floor.build_by_place(map.mesh);
    if (map.mesh.vertices.empty()) return 0;
    const Eigen::Vector3d above_a_vertex =
        map.mesh.origin + map.mesh.vertices.front().cast<double>() + Eigen::Vector3d(0.0, 0.0, 0.5);
    const roomradar::Contact contact = fall(plate, floor, above_a_vertex);
    std::printf("map of %zu triangles: ", map.mesh.triangles.size());
    if (contact.status == roomradar::ContactStatus::kContact)
      std::printf("falls %.3f m\n", contact.contact_distance_m);
    else
      std::printf("nothing is in the way, or the plate stands in it\n");
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "consumer: %s\n", error.what());
    return 1;
  }
}
