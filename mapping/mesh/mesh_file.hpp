// mesh_file.hpp: reads and writes triangle meshes as .ply, .obj, .stl and .glb.
#pragma once
#include <cstddef>
#include <filesystem>

#include "mapping/types/mesh.hpp"

namespace roomradar {

inline constexpr std::size_t kMaxMeshTriangles = 2'000'000;

/// Reads all triangles of the file, with normals and colours if every vertex has them. Vertices are taken as
/// metres in the file's own axes, unscaled. Only .glb is converted, per its standard: y up to z up, linear
/// colours to sRGB. Node transforms are applied; degenerate triangles (two equal corners, no area) are
/// dropped. The mesh's origin is zero. Throws Error with file, fault and remedy: file missing, unknown
/// extension, not a mesh, no triangles, non-finite vertices, more than kMaxMeshTriangles triangles.
Mesh read_mesh(const std::filesystem::path& path);

/// Writes in the format of the extension, in the mesh's frame: the origin is added back (float: a vertex 300
/// m from the origin is accurate to 0.03 mm). .glb, .ply and .obj keep colours and normals; .stl has no
/// colours. .glb is rotated to y up. Throws Error if the extension is unknown, the mesh is empty or
/// inconsistent, or writing fails.
void write_mesh(const Mesh& mesh, const std::filesystem::path& path);

}  // namespace roomradar
