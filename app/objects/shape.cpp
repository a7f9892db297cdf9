// shape.cpp: uploads a mesh to the GPU and builds its tree.
#include "app/objects/shape.hpp"

#include <utility>

namespace roomradar {

void Shape::set(const Mesh& mesh, MeshUsage usage) {
  if (usage == MeshUsage::kStatic) {
    touched.build_by_place(mesh);
  } else {
    touched.build_in_order(mesh);
  }
  drawn.upload(mesh, usage, touched);
}

void Shape::set(const Mesh& mesh, TriangleTree tree) {
  touched = std::move(tree);
  drawn.upload(mesh, MeshUsage::kStatic, touched);
}

}  // namespace roomradar
