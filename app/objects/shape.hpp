// shape.hpp: a mesh twice: on the renderer, to be drawn, and at hand, to be touched.
#pragma once
#include "mapping/types/mesh.hpp"
#include "radar/geometry/triangle_tree.hpp"
#include "radar/gl/gl_context.hpp"
#include "radar/gl/gpu_mesh.hpp"

namespace roomradar {

struct Shape {
  TriangleTree touched;  ///< what the radar sees
  GpuMesh drawn;         ///< what picture and depth pass see; shares the tree's vertices and triangles

  explicit Shape(GlContext& context) : drawn(context) {}

  /// Replaces both. Throws Error as GpuMesh::upload does; then neither is to be used.
  void set(const Mesh& mesh, MeshUsage usage);
  /// The same with a tree that was built by place from this mesh, elsewhere.
  void set(const Mesh& mesh, TriangleTree tree);
};

}  // namespace roomradar
