// exr_depth.hpp: depth images in OpenEXR files.
#pragma once
#include <string>
#include <string_view>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Decodes a single-part scan-line OpenEXR image with one channel: depth along the optical axis, m, as half
/// or float, uncompressed or zip-compressed. Values that are not finite or <= 0 become 0. Throws Error naming
/// `where` if the image is damaged, is another kind of OpenEXR image, or has a side outside 1..16384 px. Does
/// not use the OpenEXR library, which allocates memory for whatever sizes a damaged header states. Source:
/// openexr.com, File Layout.
void decode_exr_depth(std::string_view bytes, const std::string& where, DepthImage& depth_m);

}  // namespace roomradar
