// mesh_file.hpp: triangle meshes from and to files: .ply, .obj, .stl and .glb.
#pragma once
#include <cstddef>
#include <filesystem>

#include "mapping/types/mesh.hpp"

namespace roomradar {

inline constexpr std::size_t kMaxMeshTriangles = 2'000'000;

/// Reads all triangles of the file, with normals and colours where it has them for every vertex. Vertices are
/// taken as metres in the file's own axes, nothing is turned or scaled but a .glb, in which y points up and
/// colours are linear, as its standard has it; node transforms inside it are applied. Degenerate triangles
/// (two corners in one place, no area) are dropped. The mesh's origin is zero. Throws Error with file, fault
/// and what to do: missing, unknown extension, not a mesh, no triangles, vertices that are not finite, more
/// than kMaxMeshTriangles triangles.
Mesh read_mesh(const std::filesystem::path& path);

/// Writes by extension; the origin is added back, so that the file is in the mesh's frame (float: 300 m from
/// the origin a vertex keeps 0.03 mm). .stl has no colours; .glb, .ply and .obj keep colours and normals. A
/// .glb is turned so that y points up. Throws Error if the extension is unknown, the mesh is empty or
/// inconsistent, or the disk does not take it.
void write_mesh(const Mesh& mesh, const std::filesystem::path& path);

}  // namespace roomradar
