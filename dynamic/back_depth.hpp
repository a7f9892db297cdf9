// back_depth.hpp: how far behind what is seen of a moved thing its back may be.
#pragma once
#include <cstdint>
#include <vector>

#include "dynamic/jump_rule.hpp"
#include "dynamic/moved_lattice.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

struct BackRules {
  JumpRule jump;  ///< between lattice points that are neighbours
  float least_thickness_m, most_thickness_m, least_slope, clearance_m;
};

/// One value a lattice point. Buffers, reused from frame to frame.
struct BackLattice {
  std::vector<float> thickness_m;    ///< 0 where nothing is in
  std::vector<float> inverse_depth;  ///< of the back, 1/m; 0 where nothing is in
  std::vector<float> tolerance;      ///< 1/m: how far from these the back may be meshed

  std::vector<std::uint8_t> joined;      // bits, towards which neighbours the surface goes on
  std::vector<float> rim_px;             // distance to the thing's outline in the image
  std::vector<float> rim_inverse_depth;  // there
  std::vector<std::uint32_t> part;       // points that hang together have one number, 0: not in
  std::vector<std::size_t> stack;
  struct Part {
    double bulge_by_distance = 0.0, distance2 = 0.0;
  };
  std::vector<Part> parts;
};

/// A thing is taken to be as thick as the part that is seen of it bulges out of its outline, twice over, as a
/// body is that has the same shape behind as in front: over each part that hangs together the slope of the
/// bulge against the distance from the outline is found, and the thickness is that slope times the distance,
/// times two (a ball's: 2), and at least least_slope times it. What a nearer thing or the image's border cuts
/// off has no outline there. No thicker than most_thickness_m, and the back stays clearance_m before what the
/// static model expects, but behind the front.
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
