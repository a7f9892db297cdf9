// drawn_mesh.hpp: a mesh in the buffers of the window's renderer.
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "mapping/types/image.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A mesh in the window's OpenGL context, which must be current for all calls.
class DrawnMesh {
 public:
  DrawnMesh();
  ~DrawnMesh();
  DrawnMesh(const DrawnMesh&) = delete;
  DrawnMesh& operator=(const DrawnMesh&) = delete;

  /// @param changes_often  true: the mesh is replaced every few frames
  void upload(const Mesh& mesh, bool changes_often);
  /// Adds a texture to the uploaded mesh, in place of colours. Removes it if there are no points.
  /// @param points  one per vertex; (0, 0) is the texture's top left corner, (1, 1) its bottom right corner
  void upload_texture(const std::vector<Eigen::Vector2f>& points, const ColourImage& texture);

 private:
  friend class OrbitCanvas;
  unsigned vertex_array_ = 0;
  std::array<unsigned, 4> buffers_{};  // positions, colours, indices, texture points
  unsigned texture_ = 0;               // 0: none
  int index_count_ = 0;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  bool has_colours_ = false;
};

}  // namespace roomradar
