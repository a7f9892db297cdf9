// mesh_file.hpp: reads and writes triangle meshes as .ply, .obj, .stl and .glb, and as bytes in files of the
// project.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "mapping/mesh/assimp_import.hpp"
#include "mapping/types/mesh.hpp"
#include "mapping/types/serialize.hpp"

namespace roomradar {

/// A mesh with one texture, into which the room's lighting is baked.
struct TexturedMesh {
  Mesh mesh;
  /// One per vertex; (0, 0) is the texture's top left corner, (1, 1) its bottom right corner.
  std::vector<Eigen::Vector2f> texture_points;
  std::vector<std::uint8_t> texture_jpeg;  ///< sRGB
};

/// Reads all triangles of a file, with normals and colours if every vertex has them. Vertices are read as
/// metres in the file's own axes, unscaled. Only .glb is converted, from y up to z up and from linear colours
/// to sRGB, as its standard requires. Node transforms of a .glb are applied. Degenerate triangles (two equal
/// vertices, or no area) are dropped. The mesh's origin is zero. Throws Error if the file is missing, has an
/// unknown extension or is not a mesh. Also throws if it has no triangles, non-finite vertices, or more than
/// kMaxMeshTriangles triangles or 512 MiB. The message names the file, the fault and a remedy.
Mesh read_mesh(const std::filesystem::path& path);

/// Writes the mesh in the format that the extension names. Vertices are written with the mesh's origin added,
/// as floats; a vertex 300 m from zero is accurate to 0.03 mm. .glb, .ply and .obj keep colours and normals.
/// .stl has no colours. A .glb is rotated to y up. Throws Error if the extension is unknown, the mesh is
/// empty or inconsistent, or writing fails.
void write_mesh(const Mesh& mesh, const std::filesystem::path& path);

/// Writes a textured mesh as .glb, with the texture in it, or as .obj, with NAME.mtl and NAME.jpg in the same
/// folder; these names have '_' for blanks and other characters that readers of .obj take differently. The
/// material is matt, since lighting and highlights are baked into the texture. Throws Error as above, also for
/// other extensions.
void write_mesh(const TexturedMesh& textured, const std::filesystem::path& path);

/// Returns true if write_mesh() writes textures in the format that the extension names.
bool keeps_texture(const std::filesystem::path& path);

/// Reads or writes a mesh. Reading checks sizes only; triangles may have indices past the last vertex.
template <typename Archive>
void serialize(Archive& archive, Ref<Archive, Mesh> mesh) {
  archive(mesh.origin);
  serialize_items(archive, mesh.normals);
  serialize_items(archive, mesh.vertices);
  serialize_items(archive, mesh.colours);
  serialize_items(archive, mesh.triangles);
}

}  // namespace roomradar
