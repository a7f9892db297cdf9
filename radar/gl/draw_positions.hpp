// draw_positions.hpp: draws meshes with positions only, for depth passes.
#pragma once
#include <Eigen/Core>
#include <cstddef>

#include "radar/gl/gpu_mesh.hpp"

namespace roomradar {

/// Vertex shader of programs used with draw_positions(). Attribute 0 is the local position; uniform 0 is the
/// matrix from local to clip space.
inline constexpr const char* kPositionShader = R"(#version 450 core
layout(location = 0) in vec3 p_local;
layout(location = 0) uniform mat4 clip_from_local;
void main() { gl_Position = clip_from_local * vec4(p_local, 1.0); }
)";

/// Draws the instance with the current program. Its mesh must not be null.
/// @return number of triangles passed to the renderer
std::size_t draw_positions(const MeshInstance& instance, const Eigen::Matrix4d& clip_from_world);

}  // namespace roomradar
