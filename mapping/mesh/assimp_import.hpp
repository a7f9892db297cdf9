// assimp_import.hpp: reads files of triangle meshes through assimp, with explicit limits.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace Assimp {
class Importer;
}
struct aiScene;

namespace roomradar {

inline constexpr std::size_t kMaxMeshTriangles = 2'000'000;

/// Throws Error with the message "FILE: fault".
[[noreturn]] void fail_for_file(const std::filesystem::path& path, const std::string& fault);
/// Throws Error that states the number of triangles and the limit.
[[noreturn]] void fail_for_size(const std::filesystem::path& path, std::uint64_t triangles);

/// Returns the extension in lower case, including the dot.
std::string lower_extension(const std::filesystem::path& path);

/// Throws Error if the file is missing, empty or larger than 512 MiB. Throws if an .stl or .ply declares more
/// than kMaxMeshTriangles triangles. Throws if a .ply declares more elements than the file has bytes.
/// Allocates nothing for the mesh.
void require_plausible_size(const std::filesystem::path& path);

/// Reads a file as triangles, without animations, lights and cameras. assimp crashes or hangs on some damaged
/// files, so call this function within run_sandboxed(). Files that the file names, such as materials, are
/// opened only if they lie in its folder. In an .stl, vertices at equal positions are joined
/// and facet normals dropped. Coordinates are in the file's own axes. Coordinates of a .dae are scaled to
/// metres by the unit that the file states.
/// @param dropped  further assimp components (aiComponent) to drop
/// @return the scene, owned by the importer
/// @throws Error naming the file and the fault
const aiScene& import_scene(Assimp::Importer& importer, const std::filesystem::path& path, int dropped);

}  // namespace roomradar
