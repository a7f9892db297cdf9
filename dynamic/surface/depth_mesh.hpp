// depth_mesh.hpp: triangle mesh through the pixels of a depth frame.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "dynamic/surface/surface_policy.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

struct DepthMeshConfig {
  DepthNoise noise = {};  ///< of the sensor
  /// Every stride-th pixel becomes a vertex; the mask's contours lose up to stride - 1 pixels.
  int stride_px = 2;
  float jump_sigmas = 4.0F;          ///< max noise, in sigmas, between the depths of one surface
  float jump_incidence_deg = 80.0F;  ///< max angle between view ray and normal of one surface
  /// Max width of unmeasured gaps (projector shadow) that a skirt closes. A skirt is a strip of polygons
  /// across a depth discontinuity.
  int skirt_gap_px = 64;
  /// Distance by which SurfacePolicy::kBorder moves vertices on the image's border outwards, and also nearer.
  float border_push_m = 0.5F;
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const DepthMeshConfig& config);

/// Buffers of mesh_whole(), reused from frame to frame. Their content is meaningless
/// between calls.
struct DepthMeshScratch {
  std::vector<std::uint32_t> vertex_above, vertex_here;  // vertex index per grid column, in two rows
  std::vector<float> filled_m;                           // image with its gaps filled, for skirts
};

/// Meshes the whole frame, as a system without a map would. kHoles and kMap leave depth discontinuities open.
/// kSkirt connects the two sides of each discontinuity, and of each unmeasured gap within a row, by polygons.
/// kBorder adds two steps to kSkirt. The first step extends each row's first and last depth over the
/// unmeasured pixels at the row's ends. The second step moves vertices on the image's border by border_push_m
/// outwards in the image plane and by border_push_m nearer, so objects that leave the view do not fall.
/// Source of kBorder: the depth collider of Google's ARCore Depth Lab (2020).
///
/// Vertices are the measured pixels on the stride grid that belong to a triangle. Triangles connect
/// neighbours on one surface.
/// @param mesh  overwritten, allocations kept. Origin at the camera's position, axes of the world frame, unit
///              normals, counter-clockwise towards the camera, no colours. Empty if no pixel is measured
void mesh_whole(const PosedDepth& measured, SurfacePolicy policy, const DepthMeshConfig& config,
                DepthMeshScratch& scratch, Mesh& mesh);

}  // namespace roomradar
