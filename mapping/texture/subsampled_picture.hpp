// subsampled_picture.hpp: a colour picture with chroma at half its width and height.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Colour picture as luma, and chroma averaged over 2 x 2 pixels (4:2:0). Takes 1.5 bytes per pixel. Sensors
/// with a colour filter array, and most JPEG files, hold no more chroma.
/// Source: ITU-T T.871, JPEG File Interchange Format, 2011 (conversion from RGB and back).
struct SubsampledPicture {
  /// Blue and red chroma, minus 128 each: Cb and Cr.
  using Chroma = std::array<std::int8_t, 2>;

  Image<std::uint8_t> luma;
  Image<Chroma> chroma;  ///< half the width and height of `luma`, rounded up
};

SubsampledPicture subsampled(const ColourImage& picture);

/// Returns the interpolated colour at an image coordinate, 0 to 255 per channel. Coordinates outside get the
/// border's colour. The picture must have a pixel.
Eigen::Array3f colour_at(const SubsampledPicture& picture, const Eigen::Vector2f& pixel);

/// Returns the mean colour of the factor x factor pixels from (left, top) on, 0 to 255 per channel.
/// @param left, top, factor  even, so that the mean does not divide a chroma sample; all pixels are inside
Eigen::Array3f mean_colour(const SubsampledPicture& picture, int left, int top, int factor);

}  // namespace roomradar
