// packed_view.cpp: differences of neighbouring pixels, compressed as columns.
#include "mapping/alignment/packed_view.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/storage/compressed_columns.hpp"

namespace roomradar {
namespace {

/// Returns the difference of each pixel from the one before.
template <typename Pixel>
std::vector<Pixel> differences(const std::vector<Pixel>& pixels) {
  std::vector<Pixel> out;
  out.reserve(pixels.size());
  Pixel before = 0;
  for (const Pixel pixel : pixels) {
    out.push_back(with_sign_last(static_cast<Pixel>(pixel - before)));
    before = pixel;
  }
  return out;
}

template <typename Pixel>
Image<Pixel> image_of(const std::vector<Pixel>& differences, const Intrinsics& camera) {
  Image<Pixel> image(camera.width_px, camera.height_px);
  Pixel before = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    before = image.pixels[i] = static_cast<Pixel>(before + from_sign_last(differences[i]));
  }
  return image;
}

}  // namespace

PackedView packed(const StoredView& view) {
  PackedView out{view.camera, view.noise, !view.intensity.empty(), {}};
  if (view.inverse_depth.empty()) return out;
  put_column(out.columns, differences(view.inverse_depth.pixels));
  if (out.has_intensity) put_column(out.columns, differences(view.intensity.pixels));
  put_column(out.columns, view.measured.pixels);
  out.columns.shrink_to_fit();
  return out;
}

StoredView unpacked(const PackedView& view) {
  StoredView out{view.camera, view.noise, {}, {}, {}};
  if (view.columns.empty()) return out;
  ColumnReader in(view.columns, "a keyframe's view");
  const std::size_t pixels =
      static_cast<std::size_t>(view.camera.width_px) * static_cast<std::size_t>(view.camera.height_px);
  out.inverse_depth = image_of(in.take<std::uint16_t>("depth", pixels), view.camera);
  if (view.has_intensity) out.intensity = image_of(in.take<std::uint8_t>("intensity", pixels), view.camera);
  out.measured.resize(view.camera.width_px, view.camera.height_px);
  out.measured.pixels = in.take<std::uint8_t>("counts", pixels);
  return out;
}

}  // namespace roomradar
