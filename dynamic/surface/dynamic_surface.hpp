// moved_surface.hpp: what moved, as few triangles: what is seen of it, and the back that it is taken to have.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "dynamic/surface/back_depth.hpp"
#include "dynamic/surface/dynamic_cells.hpp"
#include "dynamic/surface/dynamic_lattice.hpp"
#include "dynamic/surface/dynamic_pixels.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// "Sigmas" are of the sensor's noise at the depth and the angle of the surface.
struct MovedSurfaceConfig {
  /// How far, in depth, the mesh may be from the surface that the pixels show on average over 5 x 5 of them.
  float deviation_sigmas = 0.8F;
  float flat_sigmas = 2.0F;  ///< RMS of 5 x 5 pixels from a plane; more, and they are a bend, not noise
  float cut_sigmas =
      2.5F;  ///< the same of 4 x 4 pixels at an outline from their triangles; else all are vertices
  float jump_sigmas = 4.0F;          ///< two pixels whose depths differ by noise alone are one surface
  float jump_incidence_deg = 80.0F;  ///< and so are two on a plane seen at up to this angle from its normal
  bool has_back = true;              ///< false: no inferred mesh
  float least_thickness_m = 0.005F;  ///< of the back at the outline
  float most_thickness_m = 0.3F;     ///< a person's chest
  float least_roundness = 0.3F;      ///< of what looks flat: 1 is as round as a ball
  float back_clearance_m = 0.005F;   ///< the back stays this far before the static model
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const MovedSurfaceConfig& config);

/// A place, such as a virtual object's, within which the mesh is to be as fine as the image.
struct FineRegion {
  Eigen::Vector3d centre_world;
  double radius_m;
};

/// Both meshes have their origin at the camera's position, axes of the world, no colours; both are empty
/// where nothing moved. Together they are closed: each edge has as many triangles on one side as on the
/// other.
struct MovedSurface {
  Mesh seen_world;  ///< counter-clockwise towards the camera, unit normals
  /// Back and side walls, counter-clockwise from outside, no normals. Inferred: nobody has seen them.
  Mesh inferred_world;
};

/// Buffers that mesh_moved reuses from frame to frame; their content means nothing between calls.
struct MovedSurfaceScratch {
  MovedPixels pixels;
  MovedLattice lattice;
  MovedCells cells;
  BackLattice back;
  std::vector<FineBall> fine;
  std::vector<float> values, tolerances;       // one a lattice point
  std::vector<std::uint8_t> needed;            // one a lattice point
  std::vector<float> smoothed;                 // 1/m, of the seen mesh's vertices beside the lattice
  std::vector<std::uint32_t> vertex_of_pixel;  // kNoVertex between uses
  std::vector<std::uint32_t> pixel_of_vertex;  // of the mesh being made
  std::vector<std::uint32_t> seen_pixels;      // of the seen mesh's vertices
  std::vector<std::uint32_t> rim_of_seen;      // copies of the seen mesh's vertices in the other
  struct Edge {
    std::uint32_t from, to, next;
  };
  std::vector<Edge> edges;
  std::vector<std::uint32_t> first_edge;  // of each vertex
};

/// Meshes the pixels that moved, and gives them a back.
///
///  1. Pixels of the mask with depth, their outline made smooth: what has most of 3 x 3 pixels about it.
///  Lines
///     and specks that are lost by that become slabs one pixel wide.
///  2. Every fourth pixel: inverse depth averaged over 5 x 5 pixels and then over flat neighbours, the noise
///  by
///     depth and angle. Pixels that bend, or lie at an outline, are averaged with those alone that lie
///     opposite each other on one line but for noise; so are the vertices beside these points.
///  3. Cells of 4 x 4 pixels: flat; cut by outlines or jumps, where straight lines follow these to a pixel;
///  or
///     full, with every pixel a vertex: where neither will do, and in the regions.
///  4. Right triangles over flat cells, up to 32 pixels, halved until no point of the lattice is farther than
///     deviation_sigmas from them. No cracks anywhere: what two triangles share they share whole.
///  5. The back: the same outline, behind (make_back); walls join the two.
///
/// The bound: over flat cells no averaged point is farther than deviation_sigmas from the mesh, and averaging
/// rounds off what bends by at most 0.7 sigmas more (1.5 sigmas of bend in each of 4 of 9 places); a cut
/// cell's pixels are cut_sigmas (RMS) from it at most. A pixel of the mask lies no more than a pixel beside
/// the mesh, but for specks whose neighbours are at other depths.
///
/// @param depth_m           height x width, metres along the axis, 0 = no measurement
/// @param moved_mask        same size, not 0 = in
/// @param expected_depth_m  same size, the static model's depth, which the back stays before; 0: not known
/// @param T_world_camera    pose of the depth camera
/// @param regions           may be empty; other than finite ones are left out
/// @param surface           overwritten, allocations kept
/// Sizes must agree (asserted). Never throws but for memory; allocates on the first frame of a size only.
void mesh_moved(const DepthImage& depth_m, const MaskImage& moved_mask, const DepthImage& expected_depth_m,
                const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                std::span<const FineRegion> regions, const MovedSurfaceConfig& config,
                MovedSurfaceScratch& scratch, MovedSurface& surface);

}  // namespace roomradar
