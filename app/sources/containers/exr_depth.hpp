// exr_depth.hpp: depth images in OpenEXR files.
#pragma once
#include <string>
#include <string_view>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Decodes a single-part scan-line OpenEXR image with one channel, half or float, m along the optical axis,
/// stored raw or compressed by zip. Values that are not finite or <= 0 become 0. Throws Error naming `where`
/// if the image is damaged, of another form, or has a side that is not in 1..16384. Does not use the OpenEXR
/// library, which allocates memory by the sizes in a damaged header. Source: openexr.com, File Layout.
void decode_exr_depth(std::string_view bytes, const std::string& where, DepthImage& depth_m);

}  // namespace roomradar
