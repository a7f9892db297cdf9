// scene_mesh.cpp: traverses the nodes of an assimp scene, and transforms their meshes.
#include "mapping/mesh/scene_mesh.hpp"

#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "mapping/mesh/assimp_import.hpp"

namespace roomradar {
namespace {

/// Transforms of a part's vertices to the mesh's frame.
class PartTransforms {
 public:
  PartTransforms(const aiScene& scene, const aiMesh& part, const aiMatrix4x4& T_node)
      : T_node_(T_node), of_normals_(normal_matrix(T_node)) {
    if (!part.HasBones()) return;
    blended_.assign(part.mNumVertices, aiMatrix4x4() * 0.0F);
    std::vector<float> sum(part.mNumVertices, 0.0F);
    for (unsigned b = 0; b < part.mNumBones; ++b) {
      const aiBone& bone = *part.mBones[b];
      const aiMatrix4x4 T_bone = in_scene(scene, bone) * bone.mOffsetMatrix;
      for (unsigned i = 0; i < bone.mNumWeights; ++i) {
        const aiVertexWeight& weight = bone.mWeights[i];
        if (weight.mVertexId >= part.mNumVertices || !(weight.mWeight > 0.0F)) continue;
        blended_[weight.mVertexId] = blended_[weight.mVertexId] + T_bone * weight.mWeight;
        sum[weight.mVertexId] += weight.mWeight;
      }
    }
    for (unsigned v = 0; v < part.mNumVertices; ++v)
      blended_[v] = sum[v] > 0.0F ? blended_[v] * (1.0F / sum[v]) : T_node_;
  }

  [[nodiscard]] const aiMatrix4x4& of(unsigned vertex) const {
    return blended_.empty() ? T_node_ : blended_[vertex];
  }
  [[nodiscard]] aiMatrix3x3 of_normal(unsigned vertex) const {
    return blended_.empty() ? of_normals_ : normal_matrix(blended_[vertex]);
  }

 private:
  aiMatrix4x4 T_node_;
  aiMatrix3x3 of_normals_;
  std::vector<aiMatrix4x4> blended_;  // one per vertex of a skinned mesh, else empty

  static aiMatrix3x3 normal_matrix(const aiMatrix4x4& T) { return aiMatrix3x3(T).Inverse().Transpose(); }

  static aiMatrix4x4 in_scene(const aiScene& scene, const aiBone& bone) {
    aiMatrix4x4 T;
    for (const aiNode* node = scene.mRootNode->FindNode(bone.mName); node != nullptr; node = node->mParent)
      T = node->mTransformation * T;
    return T;
  }
};

class Collector {
 public:
  Collector(const std::filesystem::path& path, const aiScene& scene, const SceneMeshConfig& config)
      : path_(path), scene_(scene) {
    bool any_normals = false, all_normals = true;
    has_colours_ = true;
    for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
      const bool has_normals = scene.mMeshes[i]->HasNormals();
      any_normals = any_normals || has_normals;
      all_normals = all_normals && has_normals;
      has_colours_ = has_colours_ && scene.mMeshes[i]->HasVertexColors(0);
    }
    has_normals_ = config.mixes_normals ? any_normals : all_normals;
    if (scene.mRootNode) add(*scene.mRootNode, aiMatrix4x4(), 0);
  }
  SceneMesh take() { return std::move(collected_); }

 private:
  const std::filesystem::path& path_;
  const aiScene& scene_;
  bool has_normals_ = false;
  bool has_colours_ = false;
  SceneMesh collected_;

  void add(const aiNode& node, const aiMatrix4x4& T_parent, int depth) {
    if (depth > 1000) fail_for_file(path_, "its nodes are nested too deeply");
    const aiMatrix4x4 T_node = T_parent * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) add(node.mMeshes[i], T_node);
    for (unsigned i = 0; i < node.mNumChildren; ++i) add(*node.mChildren[i], T_node, depth + 1);
  }

  void add(unsigned source, const aiMatrix4x4& T_node) {
    const aiMesh& part = *scene_.mMeshes[source];
    Mesh& mesh = collected_.mesh;
    if (mesh.triangles.size() + part.mNumFaces > kMaxMeshTriangles)
      fail_for_size(path_, mesh.triangles.size() + part.mNumFaces);
    // Nodes may reference one mesh any number of times; a mesh without triangles would be copied without
    // limit.
    if (mesh.vertices.size() + part.mNumVertices > 3 * kMaxMeshTriangles)
      fail_for_file(
          path_, "has more than " + std::to_string(3 * kMaxMeshTriangles) + " vertices; simplify it first");
    ScenePart added{source, static_cast<std::uint32_t>(mesh.vertices.size()), part.mNumVertices,
                    static_cast<std::uint32_t>(mesh.triangles.size()), 0};
    const PartTransforms transforms(scene_, part, T_node);
    for (unsigned i = 0; i < part.mNumVertices; ++i) add_vertex(part, i, transforms);
    const bool mirrored = part.mNumVertices > 0 && aiMatrix3x3(transforms.of(0)).Determinant() < 0.0F;
    for (unsigned i = 0; i < part.mNumFaces; ++i)
      add_face(part, part.mFaces[i], added.first_vertex, mirrored);
    added.triangle_count = static_cast<std::uint32_t>(mesh.triangles.size()) - added.first_triangle;
    collected_.parts.push_back(added);
  }

  void add_vertex(const aiMesh& part, unsigned i, const PartTransforms& transforms) {
    Mesh& mesh = collected_.mesh;
    const aiVector3D p = transforms.of(i) * part.mVertices[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      fail_for_file(path_,
                    "vertex " + std::to_string(mesh.vertices.size()) + " is not finite; repair the mesh");
    mesh.vertices.emplace_back(p.x, p.y, p.z);
    if (has_normals_) {
      Eigen::Vector3f normal = Eigen::Vector3f::Zero();
      if (part.HasNormals()) {
        const aiVector3D n = transforms.of_normal(i) * part.mNormals[i];
        normal = Eigen::Vector3f(n.x, n.y, n.z).normalized();
      }
      mesh.normals.push_back(normal.allFinite() ? normal : Eigen::Vector3f(Eigen::Vector3f::Zero()));
    }
    if (has_colours_) {
      const aiColor4D& c = part.mColors[0][i];
      mesh.colours.push_back({channel_of(c.r), channel_of(c.g), channel_of(c.b)});
    }
  }

  void add_face(const aiMesh& part, const aiFace& face, std::uint32_t first_vertex, bool mirrored) {
    if (face.mNumIndices != 3) return;
    Triangle triangle{};
    for (unsigned k = 0; k < 3; ++k) {
      if (face.mIndices[k] >= part.mNumVertices)
        fail_for_file(path_, "a triangle names a vertex that is not there");
      triangle[k] = first_vertex + face.mIndices[mirrored ? 2 - k : k];
    }
    if (triangle_area_m2(collected_.mesh, triangle) > 0.0) collected_.mesh.triangles.push_back(triangle);
  }
};

}  // namespace

SceneMesh scene_mesh(const std::filesystem::path& path, const aiScene& scene, const SceneMeshConfig& config) {
  return Collector(path, scene, config).take();
}

float linear_of(float srgb01) {
  return srgb01 <= 0.04045F ? srgb01 / 12.92F : std::pow((srgb01 + 0.055F) / 1.055F, 2.4F);
}

float srgb_of(float linear01) {
  return linear01 <= 0.0031308F ? 12.92F * linear01 : 1.055F * std::pow(linear01, 1.0F / 2.4F) - 0.055F;
}

std::uint8_t channel_of(float value01) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value01, 0.0F, 1.0F) * 255.0F));
}

}  // namespace roomradar
