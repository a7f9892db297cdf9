// depth_blocks.hpp: a depth image as a scene: only the part that a volume projects into, eight by eight cells
// at a time.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "radar/geometry/radar_scene.hpp"
#include "radar/geometry/triangle_gap.hpp"

namespace roomradar {

/// A box along a frame's axes, m.
struct FrameBox {
  float x0, x1, y0, y1, z0, z1;
};

/// A depth image placed in a frame, and the part of its grid of vertices that matters.
struct DepthView {
  const SceneDepth* scene = nullptr;
  Eigen::Matrix3d R_frame_camera;
  Eigen::Vector3d t_frame_camera;
  Eigen::Matrix3f rays;  ///< a point is depth * rays * (u, v, 1) + shift
  Eigen::Vector3f shift;
  /// Float may put a point this far, plus this much a metre of its depth, from where it is.
  float slack_m = 0.0F, slack_per_m = 0.0F;
  int columns = 0;                       ///< of the whole grid of vertices
  int i0 = 0, i1 = -1, j0 = 0, j1 = -1;  ///< vertices that matter, both ends included
};

/// Finds the rectangle of vertices whose cells can lie in `volume` (in the frame): the volume's outline in
/// the image, since a cell's triangles lie in the pyramid between the camera and the cell.
/// @return whether there is any
bool place_depth(const SceneDepth& scene, const Eigen::Matrix3d& R_frame_world,
                 const Eigen::Vector3d& origin_world, const Eigen::AlignedBox3d& volume, DepthView& view);

/// Up to 8 x 8 cells and the box around their vertices.
struct DepthBlock {
  FrameBox box;
  std::int32_t i, j;  ///< top left vertex
};
/// Appends the blocks of the view that have vertices. O(vertices in the view), nothing else is touched.
void append_blocks(const DepthView& view, std::vector<float>& scratch, std::vector<DepthBlock>& blocks);

/// A triangle of a cell and the box around it.
struct DepthTriangle {
  FrameBox box;
  std::uint32_t id;
};
/// Appends the triangles of a block (see SceneDepth for which there are).
void append_triangles(const DepthView& view, const DepthBlock& block, std::vector<DepthTriangle>& triangles);

/// The triangle with this id, in double from its float vertices.
FrameTriangle depth_triangle(const DepthView& view, std::uint32_t id);

}  // namespace roomradar
