// png.cpp: wraps libpng. Its errors longjmp() into the functions that call setjmp(), and would skip
// destructors there. Those functions must therefore not own objects with destructors.
#include "mapping/types/codecs/png.hpp"

#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstddef>
#include <cstring>
#include <utility>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr png_uint_32 kMaxPngSide_px = 16384;

struct PngLayout {
  int channels = 3;
  int bits = 8;
};
template <typename Pixel>
constexpr PngLayout kPngLayoutOf{};
template <>
constexpr PngLayout kPngLayoutOf<Rgba>{4, 8};
template <>
constexpr PngLayout kPngLayoutOf<std::uint8_t>{1, 8};
template <>
constexpr PngLayout kPngLayoutOf<std::uint16_t>{1, 16};

/// Return point and text of libpng's errors.
struct PngFaults {
  std::jmp_buf on_error{};
  std::array<char, 128> text{};
};

[[noreturn]] void jump_back(png_structp png, png_const_charp text) {
  auto& faults = *static_cast<PngFaults*>(png_get_error_ptr(png));
  std::strncpy(faults.text.data(), text, faults.text.size() - 1);
  std::longjmp(faults.on_error, 1);
}

void ignore_warning(png_structp, png_const_charp) {}  // the picture is usable

/// A reader of libpng. It stays where it is, since libpng keeps pointers to it.
struct PngReader {
  PngFaults faults;
  std::string_view rest;
  png_structp png = nullptr;
  png_infop info = nullptr;
  int passes = 1;
  std::size_t row_bytes = 0;

  explicit PngReader(std::string_view bytes) : rest(bytes) {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &faults, jump_back, ignore_warning);
    if (png != nullptr) info = png_create_info_struct(png);
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

void take_png_bytes(png_structp png, png_bytep to, png_size_t count) {
  std::string_view& rest = *static_cast<std::string_view*>(png_get_io_ptr(png));
  if (count > rest.size()) png_error(png, "it is cut short");
  std::memcpy(to, rest.data(), count);
  rest.remove_prefix(count);
}

void request_layout(PngReader& reader, PngLayout layout) {
  png_structp png = reader.png;
  const int type = png_get_color_type(png, reader.info), bits = png_get_bit_depth(png, reader.info);
  const bool is_grey = (type & PNG_COLOR_MASK_COLOR) == 0;
  if (layout.channels == 1 && (!is_grey || (bits == 16) != (layout.bits == 16)))
    png_error(png, layout.bits == 16 ? "it is not a 16-bit grey PNG" : "it is not an 8-bit grey PNG");
  png_set_expand(png);  // palettes, bits and transparency to bytes
  if (layout.bits == 8) png_set_strip_16(png);
  if (layout.bits == 16 && std::endian::native == std::endian::little) png_set_swap(png);
  if (layout.channels > 1 && is_grey) png_set_gray_to_rgb(png);
  if (layout.channels == 4)
    png_set_add_alpha(png, 255, PNG_FILLER_AFTER);
  else
    png_set_strip_alpha(png);
}

/// Reads the header; afterwards the size is known. Returns false after an error.
bool read_png_head(PngReader& reader, PngLayout layout) {
  if (setjmp(reader.faults.on_error) != 0) return false;
  png_structp png = reader.png;
  png_set_read_fn(png, &reader.rest, take_png_bytes);
  png_set_user_limits(png, kMaxPngSide_px, kMaxPngSide_px);
  png_read_info(png, reader.info);
  request_layout(reader, layout);
  reader.passes = png_set_interlace_handling(png);
  png_read_update_info(png, reader.info);
  reader.row_bytes = png_get_rowbytes(png, reader.info);
  const png_uint_32 width = png_get_image_width(png, reader.info);
  if (reader.row_bytes != width * static_cast<std::size_t>(layout.channels * layout.bits / 8))
    png_error(png, "its pixels are of an unknown type");
  return true;
}

/// Reads all rows. Returns false after an error.
bool read_png_rows(PngReader& reader, unsigned char* pixels, int height) {
  if (setjmp(reader.faults.on_error) != 0) return false;
  for (int pass = 0; pass < reader.passes; ++pass)
    for (int y = 0; y < height; ++y)
      png_read_row(reader.png, pixels + static_cast<std::size_t>(y) * reader.row_bytes, nullptr);
  png_read_end(reader.png, nullptr);
  return true;
}

template <typename Pixel>
std::optional<std::string> decode_pixels(std::string_view bytes, Image<Pixel>& picture) {
  static_assert(sizeof(Pixel) == static_cast<std::size_t>(kPngLayoutOf<Pixel>.channels) *
                                     static_cast<std::size_t>(kPngLayoutOf<Pixel>.bits) / 8);
  PngReader reader(bytes);
  if (reader.info == nullptr) return "libpng gets no memory";
  if (!read_png_head(reader, kPngLayoutOf<Pixel>)) return reader.faults.text.data();
  const auto width = static_cast<int>(png_get_image_width(reader.png, reader.info));
  const auto height = static_cast<int>(png_get_image_height(reader.png, reader.info));
  // Every pixel of the file takes a bit or more, and no compressed byte of PNG stands for more than 1032.
  if (static_cast<double>(width) * height / 8.0 > 1032.0 * static_cast<double>(bytes.size()))
    return "it is too short for its size";
  if (picture.width != width || picture.height != height) picture.resize(width, height);
  if (!read_png_rows(reader, reinterpret_cast<unsigned char*>(picture.pixels.data()), height))
    return reader.faults.text.data();
  return std::nullopt;
}

/// A writer of libpng. It stays where it is.
struct PngWriter {
  PngFaults faults;
  std::vector<std::uint8_t> bytes;
  png_structp png = nullptr;
  png_infop info = nullptr;

  PngWriter() {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &faults, jump_back, ignore_warning);
    if (png != nullptr) info = png_create_info_struct(png);
  }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
  ~PngWriter() { png_destroy_write_struct(&png, &info); }
};

void append_png_bytes(png_structp png, png_bytep from, png_size_t count) {
  auto& bytes = *static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  bytes.insert(bytes.end(), from, from + count);
}

bool write_png_rows(PngWriter& writer, const unsigned char* pixels, int width, int height, PngLayout layout,
                    PngEffort effort) {
  if (setjmp(writer.faults.on_error) != 0) return false;
  png_structp png = writer.png;
  png_set_write_fn(png, &writer.bytes, append_png_bytes, nullptr);
  if (effort == PngEffort::kFast) {
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_set_compression_level(png, Z_BEST_SPEED);
    png_set_compression_strategy(png, Z_RLE);
  } else {
    png_set_compression_level(png, 3);
  }
  png_set_IHDR(png, writer.info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height),
               layout.bits, layout.channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, writer.info);
  if (layout.bits == 16 && std::endian::native == std::endian::little) png_set_swap(png);
  const std::size_t row_bytes = png_get_rowbytes(png, writer.info);
  for (int y = 0; y < height; ++y) png_write_row(png, pixels + static_cast<std::size_t>(y) * row_bytes);
  png_write_end(png, writer.info);
  return true;
}

template <typename Pixel>
std::vector<std::uint8_t> encode_pixels(const Image<Pixel>& picture, PngEffort effort) {
  const std::string size = std::to_string(picture.width) + " x " + std::to_string(picture.height);
  const std::string fault = "a picture of " + size + " pixels cannot be written as PNG";
  if (picture.empty() || std::max(picture.width, picture.height) > static_cast<int>(kMaxPngSide_px))
    throw Error(fault + ": each side must be in 1..16384");
  PngWriter writer;
  if (writer.info == nullptr) throw Error(fault + ": libpng gets no memory");
  if (!write_png_rows(writer, reinterpret_cast<const unsigned char*>(picture.pixels.data()), picture.width,
                      picture.height, kPngLayoutOf<Pixel>, effort))
    throw Error(fault + ": " + writer.faults.text.data());
  return std::move(writer.bytes);
}

}  // namespace

std::optional<std::string> decode_png(std::string_view bytes, Image<Rgba>& picture) {
  return decode_pixels(bytes, picture);
}
std::optional<std::string> decode_png(std::string_view bytes, ColourImage& picture) {
  return decode_pixels(bytes, picture);
}
std::optional<std::string> decode_png(std::string_view bytes, Image<std::uint8_t>& picture) {
  return decode_pixels(bytes, picture);
}
std::optional<std::string> decode_png(std::string_view bytes, Image<std::uint16_t>& picture) {
  return decode_pixels(bytes, picture);
}

std::vector<std::uint8_t> encode_png(const ColourImage& picture, PngEffort effort) {
  return encode_pixels(picture, effort);
}
std::vector<std::uint8_t> encode_png(const Image<std::uint8_t>& picture, PngEffort effort) {
  return encode_pixels(picture, effort);
}
std::vector<std::uint8_t> encode_png(const Image<std::uint16_t>& picture, PngEffort effort) {
  return encode_pixels(picture, effort);
}

}  // namespace roomradar
