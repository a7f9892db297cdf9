// camera_noise.hpp: measures the grain of the camera's image and adds the same grain to rendered objects.
#pragma once
#include <cstdint>
#include <optional>

#include "app/render/object_layer.hpp"
#include "app/render/occlusion.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Returns the standard deviation of the brightness noise, in grey levels of 0..255. Uses the smoothest fifth
/// of the image's blocks, since texture looks like noise elsewhere. Unset if fewer than 20 blocks are neither
/// saturated nor black. Source of the filter: Immerkaer, Fast noise variance estimation, CVIU 1996.
std::optional<float> noise_of(const ColourImage& image);

/// Adds grain to the visible parts of objects: the same for the three channels of a pixel, independent
/// between pixels. Deterministic in `seed`.
/// @param layer      the objects that lay_objects() blended over `picture`, with `occlusion`
/// @param deviation  standard deviation, in grey levels of 0..255
void add_grain(const ObjectLayer& layer, const Occlusion& occlusion, float deviation, std::uint64_t seed,
               ColourImage& picture);

}  // namespace roomradar
