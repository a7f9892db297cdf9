// map_export.hpp: writes parts of a saved map as files of other programs.
#pragma once
#include <filesystem>

namespace roomradar {

/// Exports one part of the map saved in `folder` to the file `path`. The extension of `path` selects the part
/// and the format. Writes the octree as .ot or .bt, the mesh as .ply, .obj, .stl or .glb. A map's texture is
/// kept in .glb, and in .obj with NAME.mtl and NAME.jpg in the same folder. Throws Error if the extension is
/// none of these, the map is damaged, or `path` is in a map's folder.
void export_map(const std::filesystem::path& folder, const std::filesystem::path& path);

}  // namespace roomradar
