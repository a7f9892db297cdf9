// depth_regions.hpp: pixels that hang together on one surface, as runs of rows that are joined.
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
  std::uint32_t region =
      0;  ///< index of a run that is nearer to the region's own; its own's, after the search
};

/// Of all runs of a region.
struct DepthRegion {
  std::uint32_t pixels = 0;
  std::uint32_t strong = 0;    ///< pixels with the strong bit
  std::uint32_t doubtful = 0;  ///< pixels with the doubtful bit and without the strong one
  std::uint32_t before = 0;    ///< pixels with the before bit
  std::uint32_t core = 0;      ///< pixels with the core bit
  float depth2_m2 = 0.0F;  ///< sum of squared depths: times 1 / (fx fy) the area, as if it faced the camera
};

/// Which bits of a pixel mean what to the search.
struct RegionBits {
  std::uint8_t weak = 0, strong = 0, doubtful = 0, before = 0, core = 0;
};

/// runs[i].region is an index into regions, which has an entry a run; only those are used that a run names.
struct DepthRegions {
  std::vector<PixelRun> runs;
  std::vector<DepthRegion> regions;
};

/// Finds the regions of pixels that have the weak or the strong bit. Neighbours belong together if both are
/// strong, or if their depths are one surface's: apart by noise, or by what a plane shows that is seen at 80
/// degrees from its normal.
/// @param evidence  bits, of depth_m's size
/// Allocates only where an image is larger than those before.
void find_regions(const DepthImage& depth_m, const std::vector<std::uint8_t>& evidence,
                  const RegionBits& bits, const Intrinsics& camera, DepthRegions& found);

}  // namespace roomradar
