// tga_picture.cpp: header, run-length packets, order of rows.
#include "app/models/tga_picture.hpp"

#include <algorithm>
#include <cstddef>

namespace roomradar {
namespace {

constexpr std::size_t kHeadBytes = 18;
constexpr int kMaxSide_px = 16384;

/// Returns the pixels' bytes as they are stored, run-length packets expanded; shorter if the file is cut.
std::string stored_pixels(std::string_view packed, std::size_t pixel_bytes, std::size_t wanted_bytes,
                          bool is_run_length) {
  if (!is_run_length) return std::string(packed.substr(0, wanted_bytes));
  std::string pixels;
  while (pixels.size() < wanted_bytes && !packed.empty()) {
    const auto head = static_cast<unsigned char>(packed.front());
    packed.remove_prefix(1);
    const std::size_t count = (head & 0x7fU) + 1U;
    const bool repeats = (head & 0x80U) != 0;
    const std::size_t taken = std::min(packed.size(), repeats ? pixel_bytes : count * pixel_bytes);
    for (std::size_t i = 0; i < (repeats ? count : 1); ++i) pixels.append(packed.substr(0, taken));
    packed.remove_prefix(taken);
  }
  return pixels;
}

}  // namespace

std::optional<TgaPicture> decode_tga(std::string_view bytes) {
  if (bytes.size() < kHeadBytes) return std::nullopt;
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(bytes[at]); };
  const auto word = [&](std::size_t at) { return byte(at) + 256 * byte(at + 1); };
  const int map_kind = byte(1), kind = byte(2), bits = byte(16);
  const bool is_grey = kind == 3 || kind == 11, is_colour = kind == 2 || kind == 10;
  TgaPicture picture{word(12), word(14), {}};
  const bool is_readable = map_kind == 0 &&
                           ((is_grey && bits == 8) || (is_colour && (bits == 24 || bits == 32))) &&
                           picture.width > 0 && picture.height > 0 && picture.width <= kMaxSide_px &&
                           picture.height <= kMaxSide_px;
  const std::size_t start = kHeadBytes + byte(0);
  if (!is_readable || bytes.size() < start) return std::nullopt;

  const auto pixel_bytes = static_cast<std::size_t>(bits / 8);
  const auto width = static_cast<std::size_t>(picture.width),
             height = static_cast<std::size_t>(picture.height);
  const std::string pixels =
      stored_pixels(bytes.substr(start), pixel_bytes, width * height * pixel_bytes, kind >= 10);
  if (pixels.size() < width * height * pixel_bytes) return std::nullopt;
  const bool from_top = (byte(17) & 0x20U) != 0, from_right = (byte(17) & 0x10U) != 0;
  picture.bgra.reserve(4 * width * height);
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t row = from_top ? y : height - 1 - y, column = from_right ? width - 1 - x : x;
      const std::string_view pixel =
          std::string_view(pixels).substr((row * width + column) * pixel_bytes, pixel_bytes);
      if (is_grey)
        picture.bgra.append(3, pixel[0]);
      else
        picture.bgra.append(pixel.substr(0, 3));
      picture.bgra.push_back(pixel_bytes == 4 ? pixel[3] : '\xff');
    }
  return picture;
}

}  // namespace roomradar
