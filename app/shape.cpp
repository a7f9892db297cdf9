// shape.cpp: one mesh to the renderer and under a tree.
#include "app/shape.hpp"

namespace roomradar {

void Shape::set(const Mesh& mesh, MeshUsage usage) {
  drawn.upload(mesh, usage);  // refuses what is no mesh
  if (usage == MeshUsage::kStatic) {
    touched.build_by_place(mesh);
  } else {
    touched.build_in_order(mesh);
  }
}

}  // namespace roomradar
