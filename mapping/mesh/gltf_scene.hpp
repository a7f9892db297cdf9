// gltf_scene.hpp: collects the meshes of a glTF scene into one mesh.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mapping/mesh/gltf_document.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Contents of a model that are not drawn, one sentence per kind.
class NotDrawn {
 public:
  /// Counts one more of a kind, such as ("animation", "not drawn; the model is drawn at rest").
  /// @param noun    its plural ends in "s"
  void add(const std::string& noun, const std::string& fate, std::size_t count = 1);
  /// Returns sentences such as "2 animations are not drawn; the model is drawn at rest".
  [[nodiscard]] std::vector<std::string> sentences() const;

 private:
  std::vector<std::pair<std::pair<std::string, std::string>, std::size_t>> kinds_;
};

/// Range of vertices and triangles that come from one primitive of one node.
struct GltfPart {
  std::optional<std::size_t> material;
  std::uint32_t first_vertex = 0, vertex_count = 0;
  std::uint32_t first_triangle = 0, triangle_count = 0;
  bool has_normals = false, has_colours = false, has_texture_points = false;
};

struct GltfScene {
  /// In the file's axes (y up). Has normals if any part has; those of other parts are zero. Has no colours.
  Mesh mesh;
  std::vector<Eigen::Vector4f> colours;         ///< linear, with alpha, one per vertex; white where none
  std::vector<Eigen::Vector2f> texture_points;  ///< one per vertex; zero where none
  std::vector<GltfPart> parts;                  ///< in order; together they contain everything
};

/// What a primitive's material asks of its geometry.
struct GltfMaterialUse {
  bool is_visible = true;                  ///< false: the primitive is left out
  std::optional<std::size_t> texture_set;  ///< n of TEXCOORD_n
};
using GltfUseOf = std::function<GltfMaterialUse(std::optional<std::size_t> material)>;

/// Merges the meshes of the default scene: transforms of nodes, instances, default weights of morph targets,
/// and skins in the pose of their nodes. Triangles without an area are dropped, equal vertices merged.
/// @param not_drawn  receives what is left out: points, lines, animations, other scenes, invisible primitives
/// @throws Error naming the file if its parts do not fit each other, a vertex is not finite, or there are
///         more than kMaxMeshTriangles triangles or 3 kMaxMeshTriangles vertices
GltfScene gltf_scene(GltfDocument& document, const GltfUseOf& use_of, NotDrawn& not_drawn);

}  // namespace roomradar
