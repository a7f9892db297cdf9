// validity.hpp: non-throwing validity checks of cameras, poses, frames and triangles, for per-frame code.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <string_view>

#include "mapping/types/frame.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Returns true if focal lengths are finite and > 0 and the principal point is finite. Ignores the image
/// size.
[[nodiscard]] bool can_project(const Intrinsics& camera);

/// Returns true if the camera satisfies the rules of require_valid().
[[nodiscard]] bool is_valid(const Intrinsics& camera);

/// Returns true if T is finite and consists of a proper rotation R and a translation. No entry of R^T R may
/// differ from the identity by `tolerance` or more.
[[nodiscard]] bool is_rigid(const Eigen::Isometry3d& T, double tolerance);

/// Returns a sentence saying why the frame's depth image does not fit its depth camera; empty if it fits.
[[nodiscard]] std::string_view depth_fault_of(const Frame& frame);
/// Returns a sentence saying why the frame's depth or colour image does not fit its camera; empty if both
/// fit. Without a colour image, the colour camera is not checked.
[[nodiscard]] std::string_view fault_of(const Frame& frame);

/// Returns true if all three indices refer to existing, finite vertices of the mesh.
[[nodiscard]] inline bool is_usable(const Mesh& mesh, const Triangle& triangle) {
  return std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t vertex) {
    return vertex < mesh.vertices.size() && mesh.vertices[vertex].allFinite();
  });
}

}  // namespace roomradar
