// image.hpp: a dense row-major image that owns its pixels, without OpenCV.
#pragma once
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace roomradar {

struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
  friend bool operator==(const Rgb&, const Rgb&) = default;
};

/// Image of height x width pixels, row-major from the top left, without padding between rows.
template <typename Pixel>
struct Image {
  int width = 0;
  int height = 0;
  std::vector<Pixel> pixels;

  Image() = default;
  Image(int width_px, int height_px, Pixel fill = Pixel{}) { resize(width_px, height_px, fill); }

  /// Resizes the image and sets every pixel. Keeps the allocation if it is large enough.
  void resize(int width_px, int height_px, Pixel fill = Pixel{}) {
    assert(width_px >= 0 && height_px >= 0);
    width = width_px;
    height = height_px;
    pixels.assign(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), fill);
  }
  [[nodiscard]] bool empty() const { return pixels.empty(); }
  [[nodiscard]] bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  Pixel& at(int x, int y) { return pixels[index(x, y)]; }
  const Pixel& at(int x, int y) const { return pixels[index(x, y)]; }
  Pixel* row(int y) { return pixels.data() + index(0, y); }
  const Pixel* row(int y) const { return pixels.data() + index(0, y); }
};

/// Depth along the optical axis, m; 0: no measurement. Always finite and >= 0: frame sources guarantee this
/// range, and all other code relies on it.
using DepthImage = Image<float>;
using ColourImage = Image<Rgb>;
/// Mask with one byte per pixel, 0 or 255.
using MaskImage = Image<std::uint8_t>;

}  // namespace roomradar
