// scene_mesh.hpp: collects the meshes of an assimp scene into one mesh.
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "mapping/types/mesh.hpp"

struct aiScene;

namespace roomradar {

/// Range of vertices and triangles that come from one mesh of one node. A mesh that several nodes use has one
/// part per node.
struct ScenePart {
  unsigned source = 0;  ///< index in aiScene::mMeshes
  std::uint32_t first_vertex = 0, vertex_count = 0;
  std::uint32_t first_triangle = 0, triangle_count = 0;
};

struct SceneMesh {
  Mesh mesh;
  std::vector<ScenePart> parts;  ///< in order; together they contain all vertices and triangles
};

struct SceneMeshConfig {
  /// True: the mesh has normals if any part has them. The normals of other parts are then zero. False: the
  /// mesh has normals only if all parts have them.
  bool mixes_normals = false;
};

/// Merges the scene's meshes. Applies the transforms of the nodes, and the bones of skinned meshes in their
/// rest pose. The merged mesh has colours if all parts have them. Degenerate triangles (two equal vertices,
/// or no area) are dropped. Throws Error naming the file if a vertex is not finite, an index is out of range,
/// or the scene has more than kMaxMeshTriangles triangles or 3 kMaxMeshTriangles vertices.
SceneMesh scene_mesh(const std::filesystem::path& path, const aiScene& scene, const SceneMeshConfig& config);

/// Convert a colour channel in 0..1 from sRGB to linear (linear_of) and back (srgb_of). Source: IEC
/// 61966-2-1.
float linear_of(float srgb01);
float srgb_of(float linear01);
/// Converts a colour channel in 0..1 to a byte; values outside 0..1 are clamped.
std::uint8_t channel_of(float value01);

}  // namespace roomradar
