// shape.hpp: one mesh as a collision shape and as a GPU mesh.
#pragma once
#include "mapping/types/mesh.hpp"
#include "radar/geometry/triangle_tree.hpp"
#include "radar/gl/gl_context.hpp"
#include "radar/gl/gpu_mesh.hpp"

namespace roomradar {

struct Shape {
  TriangleTree touched;  ///< collision shape for Cyber Radar
  /// Render shape, for colour and depth passes. Shares the vertices and triangles of `touched`.
  GpuMesh drawn;

  explicit Shape(GlContext& context) : drawn(context) {}

  /// Replaces both shapes. Throws Error as GpuMesh::upload() does. Both shapes are then unusable.
  void set(const Mesh& mesh, MeshUsage usage);
  /// Replaces both shapes, with a tree that build_by_place() has built from `mesh`.
  void set(const Mesh& mesh, TriangleTree tree);
};

}  // namespace roomradar
