// shape.hpp: a mesh as collision shape and as GPU mesh.
#pragma once
#include "mapping/types/mesh.hpp"
#include "radar/geometry/triangle_tree.hpp"
#include "radar/gl/gl_context.hpp"
#include "radar/gl/gpu_mesh.hpp"

namespace roomradar {

struct Shape {
  TriangleTree touched;  ///< collision shape, for the radar
  GpuMesh drawn;  ///< render shape, for picture and depth pass; shares the tree's vertices and triangles

  explicit Shape(GlContext& context) : drawn(context) {}

  /// Replaces both. Throws Error as GpuMesh::upload() does; both are then unusable.
  void set(const Mesh& mesh, MeshUsage usage);
  /// The same, with a tree already built from this mesh by build_by_place().
  void set(const Mesh& mesh, TriangleTree tree);
};

}  // namespace roomradar
