// back_depth.hpp: how far behind what is seen of a moved thing its back may be.
#pragma once
#include <cstdint>
#include <vector>

#include "dynamic/surface/depth_discontinuity.hpp"
#include "dynamic/surface/dynamic_lattice.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

struct BackRules {
  JumpRule jump;  ///< between lattice points that are neighbours
  float least_thickness_m, most_thickness_m, least_roundness, clearance_m;
};

/// One value a lattice point. Buffers, reused from frame to frame.
struct BackLattice {
  std::vector<float> thickness_m;    ///< 0 where nothing is in
  std::vector<float> inverse_depth;  ///< of the back, 1/m; 0 where nothing is in
  std::vector<float> tolerance;      ///< 1/m: how far from these the back may be meshed

  std::vector<std::uint8_t> joined;  // bits, towards which neighbours the surface goes on
  std::vector<float> rim_px;         // distance to the thing's outline in the image
  std::vector<std::size_t> rim_at;   // the point there
  std::vector<float> width_px;       // that distance where it is greatest, uphill from here
  std::vector<std::uint32_t> part;   // points that hang together have one number, 0: not in
  std::vector<std::size_t> stack;
  struct Part {
    double bulge_by_round = 0.0, round2 = 0.0;
  };
  std::vector<Part> parts;
};

/// A thing is taken to have behind its outline the shape that is seen before it, as a ball or a finger has.
/// Half as wide as r where a point lies d within the outline, a round thing bulges by sqrt(d (2 r - d)); over
/// each part that hangs together the share of that is found by which what is seen bulges (1: round, 0: flat),
/// and twice that share of it is the thickness: least_roundness for what looks flat. What a nearer thing or
/// the image's border cuts off has no outline there. No thicker than most_thickness_m, and the back stays
/// clearance_m before what the static model expects, but behind the front.
///
/// @param depth_m           live depth of all pixels, moved or not
/// @param expected_depth_m  of the static model; 0: not known, which limits nothing
void make_back(const MovedPixels& pixels, const MovedLattice& lattice, const DepthImage& depth_m,
               const DepthImage& expected_depth_m, const Intrinsics& camera, const BackRules& rules,
               BackLattice& back);

/// Inverse depth of the back at any pixel that is in.
float back_at(int x, int y, float front_inverse_depth, const MovedLattice& lattice,
              const DepthImage& expected_depth_m, const BackRules& rules, const BackLattice& back);

}  // namespace roomradar
