// connected_components.hpp: connected components of pixels on one surface, as runs of rows joined by
// union-find.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// Pixels first..last of one row.
struct PixelRun {
  std::uint32_t first = 0;  ///< index into the image
  std::uint32_t last = 0;
  std::uint32_t region = 0;  ///< union-find parent; after the search, the region's root run
};

/// Sums over all runs of a region.
struct ConnectedComponent {
  std::uint32_t pixels = 0;
  std::uint32_t strong = 0;     ///< pixels with the strong bit
  std::uint32_t ambiguous = 0;  ///< pixels with the doubtful bit and without the strong one
  std::uint32_t before = 0;     ///< pixels with the before bit
  std::uint32_t core = 0;       ///< pixels with the core bit
  float depth2_m2 = 0.0F;       ///< sum of squared depths; over fx fy: area of a region that faces the camera
};

/// Meaning of a pixel's evidence bits to the search.
struct RegionBits {
  std::uint8_t weak = 0, strong = 0, ambiguous = 0, before = 0, core = 0;
};

/// runs[i].region is an index into regions. There is one region per run, but only regions that a run refers
/// to are valid.
struct ConnectedComponents {
  std::vector<PixelRun> runs;
  std::vector<ConnectedComponent> regions;
};

/// Finds the connected regions of pixels with the weak or the strong bit. Neighbours are connected if both
/// are strong, or if their depths are on one surface: they differ by no more than noise and the slope of a
/// plane seen at 80 degrees from its normal.
/// @param evidence  bits per pixel, of depth_m's size
///
/// Allocates only if the image is larger than those before.
void find_components(const DepthImage& depth_m, const std::vector<std::uint8_t>& evidence,
                     const RegionBits& bits, const Intrinsics& camera, ConnectedComponents& found);

}  // namespace roomradar
