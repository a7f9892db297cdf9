// back_depth.hpp: assumed depth of a dynamic object's unobserved back.
#pragma once
#include <cstdint>
#include <vector>

#include "dynamic/surface/depth_discontinuity.hpp"
#include "dynamic/surface/dynamic_lattice.hpp"
#include "dynamic/surface/dynamic_pixels.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Limits on the assumed back. The four numbers are fields of DynamicSurfaceConfig.
struct BackRules {
  DepthDiscontinuity jump;  ///< test between neighbouring lattice points
  float least_thickness_m, most_thickness_m, least_roundness, clearance_m;
};

/// Result and buffers of make_back(), reused from frame to frame. Most vectors have one value per lattice
/// point (DynamicLattice).
struct BackLattice {
  std::vector<float> thickness_m;    ///< 0 where not dynamic
  std::vector<float> inverse_depth;  ///< inverse depth of the back, 1/m; 0 where not dynamic
  std::vector<float> tolerance;      ///< 1/m: max deviation of the back's mesh

  std::vector<std::uint8_t> joined;  // bit k: one surface with the neighbour in direction k
  // Distance to the object's outline (contour in the image); very large: none.
  std::vector<float> rim_px;
  std::vector<std::size_t> rim_at;  // lattice point from which rim_px is measured
  std::vector<float> width_px;      // half width: max rim_px on paths of ascending rim_px
  std::vector<std::uint32_t> part;  // connected component, an index into parts; 0: none
  std::vector<std::size_t> stack;   // scratch
  /// Sums over a component's points for the least-squares fit of its roundness, m2. bulge_by_round sums the
  /// products of the front's bulge and a round object's bulge. round2 sums the squares of a round object's
  /// bulge.
  struct Part {
    double bulge_by_round = 0.0, round2 = 0.0;
  };
  std::vector<Part> parts;
};

/// Computes an assumed back. The back mirrors the bulge of the visible front, as for a ball or a finger. A
/// round object of half width r bulges by sqrt(d (2 r - d)) at a distance d inside its outline. Roundness is
/// the ratio of the front's bulge to that of a round object (1: round, 0: flat). The roundness is fitted per
/// connected component and limited to least_roundness..1. The thickness is least_thickness_m plus twice the
/// round object's bulge times the roundness, at most most_thickness_m. The back stays clearance_m in front of
/// the static model, but always behind the front. A boundary where a nearer surface or the image's edge cuts
/// the object off is not an outline. The thickness does not decrease towards such a boundary.
///
/// @param view  its expected depth limits the back, where it is known
void make_back(const DynamicPixels& pixels, const DynamicLattice& lattice, const DynamicView& view,
               const BackRules& rules, BackLattice& back);

/// A dynamic pixel (x, y) and the inverse depth of its front, 1/m.
struct FrontPixel {
  int x, y;
  float inverse_depth;
};

/// Returns the inverse depth of the back, 1/m, behind a dynamic pixel.
float back_at(const FrontPixel& front, const DynamicLattice& lattice, const DepthImage& expected_depth_m,
              const BackRules& rules, const BackLattice& back);

}  // namespace roomradar
