// dynamic_surface.hpp: meshes dynamic surfaces with few triangles: the visible front and an assumed back.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "dynamic/surface/back_depth.hpp"
#include "dynamic/surface/dynamic_cells.hpp"
#include "dynamic/surface/dynamic_lattice.hpp"
#include "dynamic/surface/dynamic_pixels.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// One "sigma" is the standard deviation of the sensor's noise at the surface's depth and angle.
struct DynamicSurfaceConfig {
  DepthNoise noise = {};  ///< of the sensor
  /// Max deviation of the mesh, in depth, from the average over 5 x 5 pixels.
  float deviation_sigmas = 0.8F;
  float flat_sigmas = 2.0F;  ///< max RMS distance of 5 x 5 pixels from a plane; above it: a bend
  /// Max RMS distance of a cut cell's pixels from the cell's triangles. Above it, the cell is full: every
  /// pixel becomes a vertex.
  float cut_sigmas = 2.5F;
  float jump_sigmas = 4.0F;          ///< max noise, in sigmas, between the depths of one surface
  float jump_incidence_deg = 80.0F;  ///< max angle between view ray and normal of one surface
  bool has_back = true;              ///< false: no inferred mesh
  float least_thickness_m = 0.005F;  ///< thickness at the outline
  float most_thickness_m = 0.3F;     ///< the thickness of a person's chest
  float least_roundness = 0.3F;      ///< roundness assumed for flat fronts; 1: as round as a ball
  float back_clearance_m = 0.005F;   ///< min distance of the back from the static model
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const DynamicSurfaceConfig& config);

/// A ball in which the mesh has the image's resolution, such as around a virtual object.
struct FineRegion {
  Eigen::Vector3d centre_world;
  double radius_m;
};

/// Meshes of a frame's dynamic surfaces. Both have their origin at the camera's position, the axes of the
/// world frame, and no colours. Both are empty if no pixel is dynamic. If DynamicSurfaceConfig::has_back is
/// set, the two meshes together are closed: their triangles use every edge equally often in both directions.
struct DynamicSurface {
  Mesh seen_world;  ///< counter-clockwise towards the camera, unit normals
  /// Assumed (never observed) back and side walls, counter-clockwise seen from outside, without normals.
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
  std::vector<float> smoothed;                 // per pixel, 1/m; set for front vertices off the lattice
  std::vector<std::uint32_t> vertex_of_pixel;  // vertex index per pixel; 0xFFFFFFFF: none
  std::vector<std::uint32_t> pixel_of_vertex;  // pixel of each vertex of the mesh being assembled
  std::vector<std::uint32_t> seen_pixels;      // pixel of each vertex of the seen mesh
  std::vector<std::uint32_t> rim_of_seen;      // per seen vertex: its copy in the inferred mesh
  struct Edge {
    std::uint32_t from, to, next;
  };
  std::vector<Edge> edges;
  std::vector<std::uint32_t> first_edge;  // per vertex: head of its list of edges
};

/// Meshes the dynamic pixels and adds an assumed back.
///
///   1. Selects the mask's pixels with depth, and smooths their outline (contour) by a 3 x 3 majority filter.
///      Lines and specks that the filter removes become slabs one pixel wide.
///   2. Makes a lattice of every fourth pixel. At flat points, inverse depth is averaged over 5 x 5 pixels,
///      then with flat neighbours. At bends, outlines and vertices off the lattice, inverse depth is averaged
///      with pairs of opposite pixels whose mean agrees with the point within noise.
///   3. Classifies cells of 4 x 4 pixels as flat, cut or full. In cut cells, straight lines follow outlines
///      and discontinuities to about a pixel. In full cells, every pixel is a vertex. Cells in `regions` are
///      full, and so are cells whose outlines differ too much from straight lines.
///   4. Meshes flat cells as an RTIN (rtin.hpp): right triangles with legs of up to 32 pixels, bisected until
///      every lattice point is within deviation_sigmas of its triangle. The mesh has no cracks.
///   5. Makes the back, which has the front's outline but is farther away (make_back()). Walls connect the
///      back to the front.
///
/// Error bound: over flat cells, no averaged point is farther than deviation_sigmas from the mesh. Averaging
/// with neighbours adds at most 0.7 sigmas at bends (four pairs, each off a line by up to 1.5 sigmas, divided
/// by nine values). The pixels of a cut cell have an RMS distance from the mesh of at most cut_sigmas. In the
/// image, the mesh comes within a pixel of every pixel of the mask, except for specks whose neighbours are at
/// other depths.
///
/// @param view     its expected depth limits the back, where it is known
/// @param regions  balls to mesh at full resolution; may be empty; non-finite regions are skipped
/// @param surface  overwritten, allocations kept
/// Sizes must agree (asserted). Only the first frame of a size allocates.
void mesh_dynamic(const DynamicView& view, std::span<const FineRegion> regions,
                  const DynamicSurfaceConfig& config, DynamicSurfaceScratch& scratch,
                  DynamicSurface& surface);

}  // namespace roomradar
