// depth_blocks.hpp: triangles of a depth image inside a volume, in blocks of 8 x 8 cells.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "radar/geometry/radar_scene.hpp"
#include "radar/geometry/triangle_gap.hpp"

namespace roomradar {

/// Axis-aligned box in a frame, m.
struct FrameBox {
  float x0, x1, y0, y1, z0, z1;
};

/// A depth image placed in a frame, and the part of its vertex grid that may reach a volume.
struct DepthView {
  const SceneDepth* scene = nullptr;
  Eigen::Matrix3d R_frame_camera;
  Eigen::Vector3d t_frame_camera;
  Eigen::Matrix3f rays;  ///< pixel (u, v) is at depth * rays * (u, v, 1) + shift
  Eigen::Vector3f shift;
  /// Error bound of a point computed in float: slack_m + slack_per_m * depth.
  float slack_m = 0.0F, slack_per_m = 0.0F;
  int columns = 0;                       ///< columns of the whole vertex grid
  int i0 = 0, i1 = -1, j0 = 0, j1 = -1;  ///< range of vertices that may reach the volume, both ends included
};

/// Finds the rectangle of vertices whose cells can lie in `volume` (in the frame). It is the volume's outline
/// in the image, since a cell's triangles lie in the pyramid between camera and cell.
/// @return false if there is no such cell
bool place_depth(const SceneDepth& scene, const Eigen::Matrix3d& R_frame_world,
                 const Eigen::Vector3d& origin_world, const Eigen::AlignedBox3d& volume, DepthView& view);

/// Up to 8 x 8 cells, and the bounding box of their vertices.
struct DepthBlock {
  FrameBox box;
  std::int32_t i, j;  ///< column and row of the top left vertex
};
/// Appends the blocks of the view that have measured vertices. O(vertices in the view); reads no other
/// pixels.
void append_blocks(const DepthView& view, std::vector<float>& scratch, std::vector<DepthBlock>& blocks);

/// A triangle of a cell, and its bounding box.
struct DepthTriangle {
  FrameBox box;
  std::uint32_t id;
};
/// Appends the triangles of a block; SceneDepth says which triangles exist.
void append_triangles(const DepthView& view, const DepthBlock& block, std::vector<DepthTriangle>& triangles);

/// Returns the triangle with this id, in double from its float vertices.
FrameTriangle depth_triangle(const DepthView& view, std::uint32_t id);

}  // namespace roomradar
