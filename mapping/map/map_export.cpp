// map_export.cpp: chooses part and format by the extension.
#include "mapping/map/map_export.hpp"

#include "mapping/map/map_folder.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

void export_map(const std::filesystem::path& folder, const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  const bool octree = extension == ".ot" || extension == ".bt";
  if (!octree && extension != ".ply" && extension != ".obj" && extension != ".stl" && extension != ".glb")
    throw Error(path.string() + ": the extension \"" + extension +
                "\" is not an export format; use .ot or .bt for the octree, .ply .obj .stl or .glb for "
                "the mesh, .html for a page");
  require_outside_maps(path);
  if (extension == ".ot") return load_map_octree(folder).write_ot(path);
  if (extension == ".bt") return load_map_octree(folder).write_bt(path);
  if (!keeps_texture(path)) return write_mesh(load_map_mesh(folder), path);
  const auto [mesh, texture] = load_textured_map_mesh(folder);
  if (texture.corners.empty()) return write_mesh(mesh, path);
  write_mesh(textured_mesh(mesh, texture), path);
}

}  // namespace roomradar
