// frame_images.cpp: compresses depth, and differences of colours, with zstd.
#include "app/sources/recordings/frame_images.hpp"

#include <zstd.h>

#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <string_view>

#include "app/sources/formats/image_file.hpp"
#include "mapping/types/serialize.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kImagesMagic = "RRIMAGES";
constexpr std::int32_t kMaxImageSide_px = 16384;
constexpr int kZstdLevel = 1;  // level 2 takes 1.4 times as long and is no smaller

/// The bytes of a file, in memory that is not filled before it is written.
struct FileBytes {
  explicit FileBytes(std::size_t most)
      : capacity(most), bytes(std::make_unique_for_overwrite<char[]>(most)) {}
  std::size_t capacity = 0, size = 0;
  std::unique_ptr<char[]> bytes;

  void put(const void* from, std::size_t count) {
    std::memcpy(bytes.get() + size, from, count);
    size += count;
  }
};

template <typename Pixel>
void put_size(const Image<Pixel>& image, const fs::path& path, FileBytes& out) {
  if (image.width > kMaxImageSide_px || image.height > kMaxImageSide_px)
    throw Error(path.string() + ": an image of " + std::to_string(image.width) + " x " +
                std::to_string(image.height) + " px is too large; a side may have 16,384 px");
  for (const std::int32_t side : {image.width, image.height}) out.put(&side, sizeof side);
}

template <typename Pixel>
void take_size(ByteReader& in, Image<Pixel>& image) {
  const auto width = in.number<std::int32_t>(), height = in.number<std::int32_t>();
  if (width < 0 || height < 0 || width > kMaxImageSide_px || height > kMaxImageSide_px)
    in.fail("is damaged: the size of an image is impossible");
  // Bounds the memory that a damaged file takes.
  const std::uint64_t most_bytes = (std::uint64_t{64} << 20U) + 1000 * std::uint64_t{in.left()};
  if (static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) * sizeof(Pixel) > most_bytes)
    in.fail("is damaged: it is too short for its images");
  if (image.width != width || image.height != height) image.resize(width, height);
}

using Compressor = std::unique_ptr<ZSTD_CCtx, std::size_t (*)(ZSTD_CCtx*)>;

Compressor make_compressor() {
  Compressor zstd(ZSTD_createCCtx(), ZSTD_freeCCtx);
  if (!zstd) throw std::bad_alloc();
  ZSTD_CCtx_setParameter(zstd.get(), ZSTD_c_compressionLevel, kZstdLevel);
  ZSTD_CCtx_setParameter(zstd.get(), ZSTD_c_checksumFlag, 1);
  return zstd;
}

void pack(const Compressor& zstd, const void* bytes, std::size_t count, const fs::path& path,
          FileBytes& out) {
  const std::size_t begin = out.size + sizeof(std::uint64_t);
  const std::size_t size =
      ZSTD_compress2(zstd.get(), out.bytes.get() + begin, out.capacity - begin, bytes, count);
  if (ZSTD_isError(size) != 0)
    throw Error(path.string() + ": zstd cannot compress an image: " + ZSTD_getErrorName(size));
  const auto stored = std::uint64_t{size};
  out.put(&stored, sizeof stored);
  out.size += size;
}

void unpack(ByteReader& in, void* bytes, std::size_t count) {
  const auto stored = in.number<std::uint64_t>();
  const std::string_view packed = in.take(stored);
  const std::size_t size = ZSTD_decompress(bytes, count, packed.data(), packed.size());
  if (ZSTD_isError(size) != 0 || size != count) in.fail("is damaged: an image cannot be unpacked");
}

void to_planes(const ColourImage& colour, std::uint8_t* planes) {
  const std::size_t count = colour.pixels.size();
  std::uint8_t *green = planes, *red = green + count, *blue = red + count;
  Rgb before{0, 0, 0};
  for (std::size_t i = 0; i < count; ++i) {
    const Rgb& pixel = colour.pixels[i];
    green[i] = static_cast<std::uint8_t>(pixel.g - before.g);
    red[i] = static_cast<std::uint8_t>(pixel.r - pixel.g - before.r + before.g);
    blue[i] = static_cast<std::uint8_t>(pixel.b - pixel.g - before.b + before.g);
    before = pixel;
  }
}

void from_planes(const std::uint8_t* planes, ColourImage& colour) {
  const std::size_t count = colour.pixels.size();
  const std::uint8_t *green = planes, *red = green + count, *blue = red + count;
  std::uint8_t g = 0, red_less_green = 0, blue_less_green = 0;
  for (std::size_t i = 0; i < count; ++i) {
    g = static_cast<std::uint8_t>(g + green[i]);
    red_less_green = static_cast<std::uint8_t>(red_less_green + red[i]);
    blue_less_green = static_cast<std::uint8_t>(blue_less_green + blue[i]);
    colour.pixels[i] = {static_cast<std::uint8_t>(red_less_green + g), g,
                        static_cast<std::uint8_t>(blue_less_green + g)};
  }
}

}  // namespace

void write_frame_images(const Frame& frame, const fs::path& path) {
  const std::size_t depth_bytes = frame.depth_m.pixels.size() * sizeof(float);
  const std::size_t colour_bytes = frame.colour.pixels.size() * sizeof(Rgb);
  FileBytes out(64 + ZSTD_compressBound(depth_bytes) + ZSTD_compressBound(colour_bytes));
  out.put(kImagesMagic.data(), kImagesMagic.size());
  put_size(frame.depth_m, path, out);
  put_size(frame.colour, path, out);
  const Compressor zstd = make_compressor();
  pack(zstd, frame.depth_m.pixels.data(), depth_bytes, path, out);
  const auto planes = std::make_unique_for_overwrite<std::uint8_t[]>(colour_bytes);
  to_planes(frame.colour, planes.get());
  pack(zstd, planes.get(), colour_bytes, path, out);
  write_bytes(path, {out.bytes.get(), out.size});
}

void read_frame_images(const fs::path& path, Frame& frame) {
  const std::string bytes = read_bytes(path, "the images of a frame");
  ByteReader in(bytes, path.string());
  if (in.left() < kImagesMagic.size() || in.take(kImagesMagic.size()) != kImagesMagic)
    in.fail("is not a file of frame images");
  take_size(in, frame.depth_m);
  take_size(in, frame.colour);
  unpack(in, frame.depth_m.pixels.data(), frame.depth_m.pixels.size() * sizeof(float));
  const std::size_t colour_bytes = frame.colour.pixels.size() * sizeof(Rgb);
  const auto planes = std::make_unique_for_overwrite<std::uint8_t[]>(colour_bytes);
  unpack(in, planes.get(), colour_bytes);
  in.require_end();
  from_planes(planes.get(), frame.colour);
  require_depth(frame.depth_m, path.string());
}

}  // namespace roomradar
