// light_bench_pictures.hpp: compares a picture of a virtual object with one of the real object.
#pragma once
#include <cstddef>
#include <vector>

#include "app/sim/sensor/kinect_depth.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Returns the sum of the channels' absolute differences.
int difference(const Rgb& a, const Rgb& b);

/// Returns the indices of pixels whose neighbourhood shows only the object.
std::vector<std::size_t> object_pixels(const ExactView& exact, std::size_t object_begin);

/// Returns the mean difference of two pictures in some pixels, per channel.
double mean_difference(const ColourImage& a, const ColourImage& b, const std::vector<std::size_t>& pixels);

/// Returns the mean absolute change of tiles of 16 x 16 pixels, weighted by the given pixels in them.
double tile_change(const ColourImage& a, const ColourImage& b, const std::vector<std::size_t>& pixels);

/// Returns the standard deviation of the noise in pixels whose neighbourhood is the object's, from the median
/// of second differences.
double noise_in(const ColourImage& picture, const std::vector<std::size_t>& pixels);

}  // namespace roomradar
