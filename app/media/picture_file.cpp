// picture_file.cpp: encodes PNG files in memory, then writes them atomically.
#include "app/media/picture_file.hpp"

#include <cstdint>
#include <vector>

#include "mapping/types/codecs/png.hpp"
#include "mapping/types/system/atomic_file.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

template <typename Pixel>
void write_picture(const Image<Pixel>& picture, const std::filesystem::path& path) {
  if (picture.empty()) throw Error(path.string() + ": the image to be written is empty");
  const std::vector<std::uint8_t> bytes = encode_png(picture, PngEffort::kSmall);
  AtomicFile file(path);
  file.stream().write(reinterpret_cast<const char*>(bytes.data()),
                      static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

}  // namespace

void require_png_name(const std::filesystem::path& path) {
  if (!path.empty() && path.extension() != ".png")
    throw Error(path.string() + ": is not the name of a PNG picture; give one that ends in .png");
}

void write_png(const ColourImage& picture, const std::filesystem::path& path) {
  write_picture(picture, path);
}

void write_png(const MaskImage& mask, const std::filesystem::path& path) { write_picture(mask, path); }

}  // namespace roomradar
