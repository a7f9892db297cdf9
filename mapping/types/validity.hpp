// validity.hpp: whether a camera can be one, whether a frame's images fit its cameras, and whether a triangle
// has its corners; as values, without exceptions, for the path of a frame.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <string_view>

#include "mapping/types/frame.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Whether points can be projected with it: focal lengths finite and > 0, principal point finite. Of what
/// size the image is does not matter.
[[nodiscard]] bool can_project(const Intrinsics& camera);

/// Whether it keeps the rules of require_valid().
[[nodiscard]] bool is_valid(const Intrinsics& camera);

/// Whether it is a rotation and a shift and nothing else, all of it finite. A rotation's columns are of
/// length 1 and at right angles, each within the tolerance.
[[nodiscard]] bool is_rigid(const Eigen::Isometry3d& T, double tolerance);

/// What is wrong with a frame whose depth image does not fit its camera, as a sentence; empty where nothing
/// is.
[[nodiscard]] std::string_view depth_fault_of(const Frame& frame);
/// The same of both images. Where there is no colour image its camera is not looked at.
[[nodiscard]] std::string_view fault_of(const Frame& frame);

/// Whether all of its corners are vertices of the mesh that are finite.
[[nodiscard]] inline bool is_usable(const Mesh& mesh, const Triangle& triangle) {
  return std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t vertex) {
    return vertex < mesh.vertices.size() && mesh.vertices[vertex].allFinite();
  });
}

}  // namespace roomradar
