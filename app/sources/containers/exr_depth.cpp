// exr_depth.cpp: header attributes, blocks of rows, and their compression by zlib.
#include "app/sources/containers/exr_depth.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "app/sources/containers/decompress.hpp"
#include "mapping/types/serialize.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr std::uint32_t kExrMagic = 20000630, kExrVersion = 2, kLongNames = 0x400;
constexpr std::int32_t kHalf = 1, kFloat = 2;
enum class ExrCompression : std::uint8_t { kNone = 0, kZipPerRow = 2, kZip = 3 };

/// Reads a text that ends with a zero, of at most 255 characters.
std::string zero_ended(ByteReader& reader) {
  std::string text;
  for (char c = reader.number<char>(); c != '\0'; c = reader.number<char>()) {
    text += c;
    if (text.size() > 255) reader.fail("is damaged: a name in its header is too long");
  }
  return text;
}

/// The attributes of the header that matter here.
struct ExrHeader {
  std::int32_t pixel_type = -1;
  ExrCompression compression = ExrCompression::kNone;
  std::array<std::int32_t, 4> data_window{0, 0, -1, -1};  ///< first and last column and row
};

void read_channels(std::string_view value, const std::string& where, ExrHeader& header) {
  ByteReader reader(value, where);
  const std::string name = zero_ended(reader);
  header.pixel_type = reader.number<std::int32_t>();
  (void)reader.take(4);
  const auto x_sampling = reader.number<std::int32_t>(), y_sampling = reader.number<std::int32_t>();
  if (name.empty() || reader.number<char>() != '\0' || x_sampling != 1 || y_sampling != 1 ||
      (header.pixel_type != kHalf && header.pixel_type != kFloat))
    throw Error(where + ": must have one channel of half or float, the depth in metres");
}

ExrHeader read_header(ByteReader& reader) {
  ExrHeader header;
  for (std::string name = zero_ended(reader); !name.empty(); name = zero_ended(reader)) {
    (void)zero_ended(reader);  // its type
    const auto size = reader.number<std::int32_t>();
    if (size < 0) reader.fail("is damaged: an attribute's size is below 0");
    const std::string_view value = reader.take(static_cast<std::size_t>(size));
    ByteReader value_reader(value, reader.where());
    if (name == "channels") read_channels(value, reader.where(), header);
    if (name == "compression") header.compression = value_reader.number<ExrCompression>();
    if (name == "dataWindow") header.data_window = value_reader.number<std::array<std::int32_t, 4>>();
  }
  return header;
}

/// Undoes the differences and the order of bytes that EXR applies before zlib: even bytes are first, then odd
/// ones.
std::string in_order(std::string bytes) {
  for (std::size_t i = 1; i < bytes.size(); ++i)
    bytes[i] = static_cast<char>(static_cast<std::uint8_t>(bytes[i - 1]) +
                                 static_cast<std::uint8_t>(bytes[i]) - 128);
  std::string ordered(bytes.size(), '\0');
  const std::size_t half = (bytes.size() + 1) / 2;
  for (std::size_t i = 0; i < bytes.size(); ++i) ordered[i] = bytes[i / 2 + (i % 2) * half];
  return ordered;
}

float float_of_half(std::uint16_t half) {
  const std::uint32_t sign = static_cast<std::uint32_t>(half >> 15U) << 31U;
  const std::uint32_t exponent = (half >> 10U) & 0x1FU, mantissa = half & 0x3FFU;
  if (exponent == 0) {  // zero and denormal numbers, units of 2^-24
    const float value = std::ldexp(static_cast<float>(mantissa), -24);
    return sign ? -value : value;
  }
  const std::uint32_t wide = exponent == 31 ? 255 : exponent + 112;
  return std::bit_cast<float>(sign | wide << 23U | mantissa << 13U);
}

}  // namespace

void decode_exr_depth(std::string_view bytes, const std::string& where, DepthImage& depth_m) {
  constexpr std::int64_t kMaxSide_px = 16384;
  constexpr std::int64_t kMostPacked = 1032;  // deflate compresses by no more
  ByteReader reader(bytes, where);
  if (bytes.size() < 8 || reader.number<std::uint32_t>() != kExrMagic)
    throw Error(where + ": is not an EXR image");
  if ((reader.number<std::uint32_t>() & ~kLongNames) != kExrVersion)
    throw Error(where +
                ": is tiled, deep, of several parts or of another version; must be a plain EXR image");
  const ExrHeader header = read_header(reader);
  const auto& [left, top, right, bottom] = header.data_window;
  const std::int64_t width = std::int64_t{right} - left + 1, height = std::int64_t{bottom} - top + 1;
  if (width < 1 || height < 1 || width > kMaxSide_px || height > kMaxSide_px)
    throw Error(where + ": its size of " + std::to_string(width) + " x " + std::to_string(height) +
                " is not in 1..16384");
  if (header.pixel_type < 0) throw Error(where + ": is damaged: its header lists no channel");
  if (header.compression != ExrCompression::kNone && header.compression != ExrCompression::kZip &&
      header.compression != ExrCompression::kZipPerRow)
    throw Error(where + ": its compression is not supported; must be zip or none");
  const std::int64_t pixel_bytes = header.pixel_type == kHalf ? 2 : 4;
  if (width * height * pixel_bytes / kMostPacked > static_cast<std::int64_t>(bytes.size()))
    throw Error(where + ": is cut short or damaged: " + std::to_string(bytes.size()) +
                " bytes cannot hold an image of " + std::to_string(width) + " x " + std::to_string(height));
  const std::int64_t rows_per_block = header.compression == ExrCompression::kZip ? 16 : 1;
  const std::int64_t blocks = (height + rows_per_block - 1) / rows_per_block;
  (void)reader.take(static_cast<std::size_t>(blocks) * sizeof(std::uint64_t));  // offsets of the blocks

  depth_m.resize(static_cast<int>(width), static_cast<int>(height));
  for (std::int64_t block = 0; block < blocks; ++block) {
    const std::int64_t first_row = std::int64_t{reader.number<std::int32_t>()} - top;
    const auto size = reader.number<std::int32_t>();
    if (first_row < 0 || first_row >= height || first_row % rows_per_block != 0 || size < 0)
      reader.fail("is damaged: a block of rows is out of place");
    const std::int64_t rows = std::min(rows_per_block, height - first_row);
    const auto raw_bytes = static_cast<std::size_t>(rows * width * pixel_bytes);
    const std::string_view stored = reader.take(static_cast<std::size_t>(size));
    // Rows that zip would enlarge are stored as they are.
    const std::string rows_bytes = stored.size() == raw_bytes
                                       ? std::string(stored)
                                       : in_order(decompress(Compression::kZlib, stored, raw_bytes, where));
    float* to = depth_m.row(static_cast<int>(first_row));
    for (std::size_t i = 0; i < raw_bytes / static_cast<std::size_t>(pixel_bytes); ++i) {
      std::uint16_t half = 0;
      if (header.pixel_type == kHalf)
        std::memcpy(&half, rows_bytes.data() + 2 * i, sizeof half);
      else
        std::memcpy(to + i, rows_bytes.data() + 4 * i, sizeof(float));
      if (header.pixel_type == kHalf) to[i] = float_of_half(half);
      if (!(std::isfinite(to[i]) && to[i] > 0.0F)) to[i] = 0.0F;
    }
  }
}

}  // namespace roomradar
