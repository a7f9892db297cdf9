// dynamic_surface.hpp: dynamic surfaces as few triangles, the visible front and an assumed back.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "dynamic/surface/back_depth.hpp"
#include "dynamic/surface/dynamic_cells.hpp"
#include "dynamic/surface/dynamic_lattice.hpp"
#include "dynamic/surface/dynamic_pixels.hpp"
#include "dynamic/surface/dynamic_surface_config.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Both meshes have their origin at the camera's position, world axes and no colours; both are empty if
/// nothing is dynamic. Together they are closed: every edge is used equally often in both directions.
struct DynamicSurface {
  Mesh seen_world;  ///< counter-clockwise towards the camera, unit normals
  /// Back and side walls, counter-clockwise from outside, no normals. Assumed, never observed.
  Mesh inferred_world;
};

/// Buffers that mesh_dynamic reuses from frame to frame; their content is meaningless between calls.
struct DynamicSurfaceScratch {
  DynamicPixels pixels;
  DynamicLattice lattice;
  DynamicCells cells;
  BackLattice back;
  std::vector<FineBall> fine;
  std::vector<float> values, tolerances;       // one per lattice point
  std::vector<std::uint8_t> needed;            // one per lattice point
  std::vector<float> smoothed;                 // 1/m, of seen vertices that are not lattice points
  std::vector<std::uint32_t> vertex_of_pixel;  // 0xFFFFFFFF between uses
  std::vector<std::uint32_t> pixel_of_vertex;  // of the mesh being assembled
  std::vector<std::uint32_t> seen_pixels;      // of the seen mesh's vertices
  std::vector<std::uint32_t> rim_of_seen;      // copies of seen vertices in the inferred mesh
  struct Edge {
    std::uint32_t from, to, next;
  };
  std::vector<Edge> edges;
  std::vector<std::uint32_t> first_edge;  // per vertex
};

/// Meshes the dynamic pixels and adds an assumed back.
///
///   1. Pixels of the mask with depth, outline smoothed by a 3 x 3 majority. Lines and specks lost by
///      the majority become slabs one pixel wide.
///   2. Every fourth pixel: inverse depth averaged over 5 x 5 pixels, then over flat neighbours; noise
///      from depth and angle. Pixels at a bend or an outline are averaged only over opposite pixels
///      that deviate from a line by noise only; so are vertices that are not lattice points.
///   3. Cells of 4 x 4 pixels, each flat, cut or full. In cut cells straight lines follow outlines and
///      discontinuities within a pixel. In full cells every pixel is a vertex; full are the cells in the
///      regions, and those that are neither flat nor well cut.
///   4. RTIN: right triangles over flat cells, up to 32 pixels, bisected until no lattice point is
///      farther than deviation_sigmas from them. No cracks, as adjacent triangles share whole edges.
///   5. The back: the same outline, farther away (make_back). Walls connect it to the front.
///
/// Error bound: over flat cells no averaged point is farther than deviation_sigmas from the mesh. Averaging
/// rounds off bends by at most 0.7 sigmas more (1.5 sigmas of bend in each of 4 of 9 places). The pixels of a
/// cut cell have an RMS distance of at most cut_sigmas. A pixel of the mask is at most a pixel beside the
/// mesh, except specks whose neighbours are at other depths.
///
/// @param depth_m           height x width, metres along the axis, 0 = no measurement
/// @param dynamic_mask        same size; not 0: dynamic
/// @param expected_depth_m  same size; depth of the static model, which limits the back; 0: unknown
/// @param T_world_camera    pose of the depth camera
/// @param regions           may be empty; regions that are not finite are skipped
/// @param surface           overwritten, allocations kept
/// Sizes must agree (asserted). Throws only if memory runs out; allocates in the first frame of a size only.
void mesh_dynamic(const DepthImage& depth_m, const MaskImage& dynamic_mask,
                  const DepthImage& expected_depth_m, const Intrinsics& camera,
                  const Eigen::Isometry3d& T_world_camera, std::span<const FineRegion> regions,
                  const DynamicSurfaceConfig& config, DynamicSurfaceScratch& scratch,
                  DynamicSurface& surface);

}  // namespace roomradar
