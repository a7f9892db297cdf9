// map_page.cpp: collects the contents of a map's page.
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

}  // namespace

bool is_page(const std::filesystem::path& path) { return lower_extension(path) == ".html"; }

void write_map_page(const SavedMap& map, const std::filesystem::path& folder,
                    const std::filesystem::path& path) {
  RoomPage page;
  page.title = title_of(folder);
  const auto texture = fitting_texture(map);
  page.rooms = {{page.title, &map.mesh, texture.get()}};
  page.holes = survey_coverage(map.octree.load(), map.mesh, map.trajectory).holes;
  page.trajectory = map.trajectory;
  write_room_page(page, path);
}

void write_diff_page(const NamedMap& a, const NamedMap& b, const Eigen::Isometry3d& T_a_b,
                     std::span<const Change> changes, const std::filesystem::path& path) {
  RoomPage page;
  const std::string name_a = title_of(a.folder), name_b = title_of(b.folder);
  const Mesh mesh_b = transformed(b.map.mesh, T_a_b);
  const auto texture_a = fitting_texture(a.map), texture_b = fitting_texture(b.map);
  page.title = name_a + " and " + name_b;
  page.rooms = {{name_a, &a.map.mesh, texture_a.get()}, {name_b, &mesh_b, texture_b.get()}};
  page.trajectory = a.map.trajectory;
  page.changes.assign(changes.begin(), changes.end());
  write_room_page(page, path);
}

}  // namespace roomradar
