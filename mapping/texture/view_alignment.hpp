// view_alignment.hpp: photometric refinement of the poses of views.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mapping/texture/texture_view.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A point of the mesh's surface.
struct MeshPoint {
  std::uint32_t triangle = 0;
  Eigen::Vector3f weights = Eigen::Vector3f::Zero();  ///< barycentric
  Eigen::Vector3f p_local = Eigen::Vector3f::Zero();  ///< relative to the mesh's origin
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();  ///< unit
};

/// @param weights  barycentric coordinates in the triangle
MeshPoint mesh_point(const Mesh& mesh, std::uint32_t triangle, const Eigen::Vector3f& weights);

/// Returns about `count` points, evenly distributed over the surface. Deterministic.
std::vector<MeshPoint> sample_mesh(const Mesh& mesh, std::size_t count);

/// Refines the pose of each view so that its colours agree with the colours of the other views of the same
/// surface. Tracked poses have errors of some millimetres, which correspond to some pixels. Also, colour may
/// come from another camera and another time than depth. Alternates two steps, at an eighth, a quarter and
/// then half of the pictures' size. The first step sets each point's brightness to the mean over the views
/// that show the point. The second step aligns each view to these means by a Gauss-Newton step. Visibility is
/// computed only at the initial poses, since corrections are some centimetres at most.
/// @param mesh   with normals
/// @param views  with gains from even_exposure()
/// Source: Zhou, Koltun, Color map optimization for 3D reconstruction with consumer depth cameras, ACM TOG
/// 2014.
void align_views(const Mesh& mesh, std::span<TextureView> views);

/// Aligns one view to points of known brightness (0..255), with the Gauss-Newton steps of align_views().
/// @param brightness  one per point; negative: unknown
void align_view(std::span<const MeshPoint> points, std::span<const float> brightness, TextureView& view);

}  // namespace roomradar
