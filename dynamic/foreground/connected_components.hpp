// connected_components.hpp: connected components of marked pixels, as runs of pixels merged by union-find.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// A run of connected pixels in one row.
struct PixelRun {
  std::uint32_t first = 0;   ///< image index of the first pixel
  std::uint32_t last = 0;    ///< image index of the last pixel
  std::uint32_t region = 0;  ///< union-find parent; after the search, the region's root run
};

/// Sums over all pixels of a region.
struct ConnectedComponent {
  std::uint32_t pixels = 0;
  std::uint32_t strong = 0;     ///< pixels with the strong bit
  std::uint32_t ambiguous = 0;  ///< pixels with the ambiguous bit but not the strong bit
  std::uint32_t before = 0;     ///< pixels with the before bit
  std::uint32_t core = 0;       ///< pixels with the core bit
  float depth2_m2 = 0.0F;       ///< sum of squared depths; over fx fy: area if facing the camera
};

/// Masks of the evidence bits that find_components() reads. Weak or strong: the pixel is part of a region.
/// The others are only counted.
struct RegionBits {
  std::uint8_t weak = 0, strong = 0, ambiguous = 0, before = 0, core = 0;
};

/// runs[i].region is an index into regions. regions has one entry per run; entries that no run refers to are
/// meaningless.
struct ConnectedComponents {
  std::vector<PixelRun> runs;
  std::vector<ConnectedComponent> regions;
};

/// Finds the connected regions of pixels with the weak or the strong bit. Neighbours are connected if both
/// are strong, or if they are on one surface: their depths differ by no more than the noise plus the slope of
/// a plane seen at 80 degrees from its normal.
/// @param evidence  bits of each pixel of depth_m
///
/// Allocates only if the image is larger than those before.
void find_components(const DepthImage& depth_m, const std::vector<std::uint8_t>& evidence,
                     const RegionBits& bits, const Intrinsics& camera, ConnectedComponents& found);

}  // namespace roomradar
