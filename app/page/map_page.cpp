// map_page.cpp: collects what a page shows of a map.
#include "app/page/map_page.hpp"

#include <memory>

#include "app/page/room_page.hpp"
#include "mapping/coverage/coverage.hpp"
#include "mapping/mesh/mesh_file.hpp"

namespace roomradar {
namespace {

std::string title_of(const std::filesystem::path& folder) {
  const std::filesystem::path plain = folder.lexically_normal();
  return (plain.has_filename() ? plain : plain.parent_path()).filename().string();
}

/// Returns the map's texture, or null if it has none that fits.
const SurfaceTexture* texture_of(const SavedMap& map) {
  const std::shared_ptr<const SurfaceTexture>& texture = *map.texture;
  return texture && fits(*texture, map.mesh) ? texture.get() : nullptr;
}

Mesh moved(const Mesh& mesh, const Eigen::Isometry3d& T) {
  Mesh out = mesh;
  const Eigen::Matrix3f R = T.linear().cast<float>();
  out.origin = T * mesh.origin;
  for (Eigen::Vector3f& vertex : out.vertices) vertex = R * vertex;
  for (Eigen::Vector3f& normal : out.normals) normal = R * normal;
  return out;
}

}  // namespace

bool is_page(const std::filesystem::path& path) { return lower_extension(path) == ".html"; }

void write_map_page(const SavedMap& map, const std::filesystem::path& folder,
                    const std::filesystem::path& path) {
  RoomPage page;
  page.title = title_of(folder);
  page.rooms = {{page.title, &map.mesh, texture_of(map)}};
  page.holes = survey_coverage(map.octree, map.mesh, map.trajectory).holes;
  page.trajectory = map.trajectory;
  write_room_page(page, path);
}

void write_diff_page(const NamedMap& a, const NamedMap& b, const Eigen::Isometry3d& T_a_b,
                     std::span<const Change> changes, const std::filesystem::path& path) {
  RoomPage page;
  const std::string name_a = title_of(a.folder), name_b = title_of(b.folder);
  const Mesh mesh_b = moved(b.map.mesh, T_a_b);
  page.title = name_a + " and " + name_b;
  page.rooms = {{name_a, &a.map.mesh, texture_of(a.map)}, {name_b, &mesh_b, texture_of(b.map)}};
  page.trajectory = a.map.trajectory;
  page.changes.assign(changes.begin(), changes.end());
  write_room_page(page, path);
}

}  // namespace roomradar
