// draw_positions.cpp: sets the matrix and draws the mesh.
#include "radar/gl/draw_positions.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

namespace roomradar {

std::size_t draw_positions(const MeshInstance& instance, const Eigen::Matrix4d& clip_from_world) {
  const Eigen::Matrix4d clip = clip_from_local(instance, clip_from_world);
  const Eigen::Matrix4f clip_float = clip.cast<float>();
  glUniformMatrix4fv(0, 1, GL_FALSE, clip_float.data());
  return instance.mesh->draw(clip);
}

}  // namespace roomradar
