// connected_components.hpp: finds connected components of marked pixels, by union-find over runs of pixels.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/types/depth_noise.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// A run of connected pixels in one row.
struct PixelRun {
  std::uint32_t first = 0;   ///< image index of the first pixel
  std::uint32_t last = 0;    ///< image index of the last pixel
  std::uint32_t region = 0;  ///< parent run in union-find; at the end, the region's root run
};

/// Sums over all pixels of a region.
struct ConnectedComponent {
  std::uint32_t pixels = 0;
  std::uint32_t strong = 0;     ///< number of pixels with the strong bit
  std::uint32_t ambiguous = 0;  ///< number of pixels with the ambiguous but not the strong bit
  /// Number of pixels with the before bit: the previous frame had a region there.
  std::uint32_t before = 0;
  std::uint32_t core = 0;  ///< number of pixels with the core bit
  float depth2_m2 = 0.0F;  ///< sum of squared depths; sum / (fx fy): area if it faces the camera
};

/// Masks of the evidence bits (pixel_evidence.hpp) that find_components() reads. A pixel with the weak or the
/// strong bit is part of a region. The other bits are only counted.
struct RegionBits {
  std::uint8_t weak = 0, strong = 0, ambiguous = 0, before = 0, core = 0;
};

/// When two pixels belong to one surface.
struct ConnectionRules {
  DepthNoise noise = {};
  int max_gap_px = 0;  ///< max number of unmeasured pixels between neighbours; 0: only adjacent pixels
};

/// Result of find_components(). runs[i].region is an index into `regions`. `regions` has one entry per run.
/// Entries to which no run refers are meaningless.
struct ConnectedComponents {
  std::vector<PixelRun> runs;
  std::vector<std::uint32_t> first_run;  ///< scratch: per row, its first run; at the end, the number of runs
  std::vector<ConnectedComponent> regions;
};

/// Finds the connected regions of pixels with the weak or the strong bit. Neighbours are connected if both
/// have the strong bit, or if they are on one surface. Two pixels are on one surface if their depths differ
/// by at most a bound. The bound is the noise plus the depth change of a plane at 80 degrees incidence.
///
/// Pixels of a row or column with up to ConnectionRules::max_gap_px unmeasured pixels between them, and
/// nothing else, are neighbours too, if they are on one surface. A surface that is measured only here and
/// there, such as dark or shiny skin, is thus one region.
/// @param evidence  bits of each pixel of depth_m
///
/// Allocates only if the image is larger than those of earlier calls.
void find_components(const DepthImage& depth_m, const std::vector<std::uint8_t>& evidence,
                     const RegionBits& bits, const Intrinsics& camera, const ConnectionRules& rules,
                     ConnectedComponents& found);

}  // namespace roomradar
