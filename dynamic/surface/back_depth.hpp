// back_depth.hpp: assumed depth of a dynamic object's unobserved back.
#pragma once
#include <cstdint>
#include <vector>

#include "dynamic/surface/depth_discontinuity.hpp"
#include "dynamic/surface/dynamic_lattice.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

struct BackRules {
  DepthDiscontinuity jump;  ///< between neighbouring lattice points
  float least_thickness_m, most_thickness_m, least_roundness, clearance_m;
};

/// One value per lattice point. Buffers, reused from frame to frame.
struct BackLattice {
  std::vector<float> thickness_m;    ///< 0 where not dynamic
  std::vector<float> inverse_depth;  ///< of the back, 1/m; 0 where not dynamic
  std::vector<float> tolerance;      ///< 1/m: max deviation of the back's mesh

  std::vector<std::uint8_t> joined;  // bit k: same surface as the neighbour in direction k
  std::vector<float> rim_px;         // distance to the object's outline in the image
  std::vector<std::size_t> rim_at;   // index of that outline point
  std::vector<float> width_px;       // half width: greatest rim_px uphill from here
  std::vector<std::uint32_t> part;   // connected component; 0: none
  std::vector<std::size_t> stack;
  struct Part {
    double bulge_by_round = 0.0, round2 = 0.0;
  };
  std::vector<Part> parts;
};

/// Computes a back that mirrors the shape of the visible front at the outline, as for a ball or a finger. A
/// round object of half width r bulges by sqrt(d (2 r - d)) at a distance d inside its outline. Roundness is
/// the ratio of the front's bulge to that of a round object (1: round, 0: flat), fitted per connected
/// component and limited to least_roundness..1. The thickness is least_thickness_m plus twice the round bulge
/// times the roundness, at most most_thickness_m. The back stays clearance_m in front of the static model,
/// but behind the front. There is no outline where a nearer surface or the image's edge cuts the object off.
///
/// @param depth_m           live depth of all pixels, dynamic or not
/// @param expected_depth_m  depth of the static model; 0: unknown, no limit
void make_back(const DynamicPixels& pixels, const DynamicLattice& lattice, const DepthImage& depth_m,
               const DepthImage& expected_depth_m, const Intrinsics& camera, const BackRules& rules,
               BackLattice& back);

/// Returns the inverse depth of the back at any dynamic pixel.
float back_at(int x, int y, float front_inverse_depth, const DynamicLattice& lattice,
              const DepthImage& expected_depth_m, const BackRules& rules, const BackLattice& back);

}  // namespace roomradar
