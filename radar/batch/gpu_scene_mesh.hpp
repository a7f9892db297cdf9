// gpu_scene_mesh.hpp: a scene's meshes in OpenGL buffers, for GlRadar.
#pragma once
#include <span>

#include "radar/exact/scene_boxes.hpp"
#include "radar/geometry/contact.hpp"
#include "radar/gl/gpu_mesh.hpp"

namespace roomradar {

/// A mesh that can be touched, its pose, and its kind.
struct GpuSceneMesh {
  MeshInstance instance;
  SurfaceKind kind = SurfaceKind::kStatic;
};
inline bool has_surface(const GpuSceneMesh& s) {
  return s.instance.mesh != nullptr && s.instance.mesh->triangle_count() > 0;
}

/// Builds the hierarchy over the bounding boxes of a scene's meshes, as SceneBoxes::build() does.
inline void build(SceneBoxes& boxes, std::span<const GpuSceneMesh> scene) {
  boxes.clear();
  for (std::size_t i = 0; i < scene.size(); ++i)
    if (has_surface(scene[i])) boxes.add(i, scene[i].instance.mesh->bounds(), scene[i].instance.T_world_mesh);
  boxes.finish();
}

}  // namespace roomradar
