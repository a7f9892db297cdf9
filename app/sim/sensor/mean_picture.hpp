// mean_picture.hpp: mean of pictures, which simulates a sensor's exposure.
#pragma once
#include <algorithm>
#include <array>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Mean of the added pictures, which must have the same size.
class MeanPicture {
 public:
  MeanPicture(int width_px, int height_px) : sums_(width_px, height_px) {}

  void add(const ColourImage& picture) {
    ++count_;
    for (std::size_t i = 0; i < sums_.pixels.size(); ++i) {
      const Rgb& pixel = picture.pixels[i];
      std::array<int, 3>& sum = sums_.pixels[i];
      sum = {sum[0] + pixel.r, sum[1] + pixel.g, sum[2] + pixel.b};
    }
  }

  /// Writes the mean of at least one picture.
  void write(ColourImage& picture) const {
    const auto mean = [this](int sum) { return static_cast<std::uint8_t>((sum + count_ / 2) / count_); };
    std::transform(sums_.pixels.begin(), sums_.pixels.end(), picture.pixels.begin(),
                   [&](const std::array<int, 3>& sum) {
                     return Rgb{mean(sum[0]), mean(sum[1]), mean(sum[2])};
                   });
  }

 private:
  Image<std::array<int, 3>> sums_;
  int count_ = 0;
};

}  // namespace roomradar
