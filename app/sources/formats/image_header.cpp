// image_header.cpp: parses the headers and end marks of PNG, JPEG, PGM and PPM.
#include "app/sources/formats/image_header.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kPngStart = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::array<std::uint8_t, 4> kPngEnd = {'I', 'E', 'N', 'D'};
constexpr std::array<std::uint8_t, 2> kJpegEnd = {0xff, 0xd9};
constexpr std::size_t kTrailer = 1024;  // some writers leave padding after the end mark

bool starts_with(Bytes bytes, Bytes start) {
  return bytes.size() >= start.size() && std::equal(start.begin(), start.end(), bytes.begin());
}
bool ends_near_end(Bytes bytes, Bytes mark) {
  const Bytes tail = bytes.last(std::min(bytes.size(), kTrailer));
  return std::search(tail.begin(), tail.end(), mark.begin(), mark.end()) != tail.end();
}
int big_endian16(Bytes bytes, std::size_t at) { return bytes[at] << 8 | bytes[at + 1]; }
std::int64_t big_endian32(Bytes bytes, std::size_t at) {
  return static_cast<std::int64_t>(big_endian16(bytes, at)) << 16 | big_endian16(bytes, at + 2);
}
int checked_size(std::int64_t size, const std::string& name) {
  if (size < 1 || size > 16384)
    throw Error(name + ": the header gives a width or height of " + std::to_string(size) +
                "; it must be in 1..16384");
  return static_cast<int>(size);
}
[[noreturn]] void fail_cut_short(const std::string& name, std::size_t bytes) {
  throw Error(name + ": is cut short (" + std::to_string(bytes) + " bytes are there)");
}
/// Returns the header, or throws Error if a file of this many bytes cannot contain its pixels. Deflate
/// compresses by at most 1,032; JPEG, whose blocks take at least two bits each, by no more.
ImageHeader require_room(const ImageHeader& header, int bits_per_pixel, std::size_t file_bytes,
                         const std::string& name) {
  constexpr std::int64_t kMostPacked = 1032;
  const auto pixel_bytes = std::int64_t{header.width_px} * header.height_px * bits_per_pixel / 8;
  if (pixel_bytes / kMostPacked > static_cast<std::int64_t>(file_bytes))
    throw Error(name + ": is cut short or damaged: " + std::to_string(file_bytes) + " bytes cannot hold " +
                to_string(header));
  return header;
}

ImageHeader read_png(Bytes bytes, const std::string& name) {
  constexpr std::size_t kHeaderBytes = 33;
  if (bytes.size() < kHeaderBytes || !ends_near_end(bytes, kPngEnd)) fail_cut_short(name, bytes.size());
  const int colour_type = bytes[25];
  const int channels = colour_type == 0 ? 1 : colour_type == 4 ? 2 : colour_type == 6 ? 4 : 3;
  const ImageHeader header{ImageKind::kPng,
                           checked_size(big_endian32(bytes, 16), name),
                           checked_size(big_endian32(bytes, 20), name),
                           channels,
                           bytes[24],
                           0};
  const bool is_palette = colour_type == 3;
  return require_room(header, header.bits * (is_palette ? 1 : channels), bytes.size(), name);
}

ImageHeader read_jpeg(Bytes bytes, const std::string& name) {
  if (!ends_near_end(bytes, kJpegEnd)) fail_cut_short(name, bytes.size());
  // Segments: ff, kind, 16 bit length that includes itself. Frame headers are c0..cf except c4, c8 and cc.
  for (std::size_t at = 2; at + 9 < bytes.size();) {
    if (bytes[at] != 0xff) break;
    const int kind = bytes[at + 1];
    if (kind == 0xff) {
      ++at;  // padding
    } else if (kind >= 0xc0 && kind <= 0xcf && kind != 0xc4 && kind != 0xc8 && kind != 0xcc) {
      const ImageHeader header{ImageKind::kJpeg,
                               checked_size(big_endian16(bytes, at + 7), name),
                               checked_size(big_endian16(bytes, at + 5), name),
                               bytes[at + 9],
                               bytes[at + 4],
                               0};
      return require_room(header, 8, bytes.size(), name);
    } else {
      at += 2 + static_cast<std::size_t>(big_endian16(bytes, at + 2));
    }
  }
  throw Error(name + ": is a JPEG without a frame header");
}

ImageHeader read_pnm(Bytes bytes, const std::string& name) {
  const bool grey = bytes[1] == '5';
  std::array<std::int64_t, 3> numbers{};  // width, height, maximum value
  std::size_t at = 2;
  for (std::int64_t& number : numbers) {
    while (at < bytes.size() && (std::isspace(bytes[at]) || bytes[at] == '#')) {
      if (bytes[at] == '#')
        while (at < bytes.size() && bytes[at] != '\n') ++at;
      else
        ++at;
    }
    const std::size_t start = at;
    for (; at < bytes.size() && std::isdigit(bytes[at]) && number < 100'000; ++at)
      number = number * 10 + (bytes[at] - '0');
    if (at == start) throw Error(name + ": the PGM or PPM header is not three numbers");
  }
  if (at >= bytes.size() || !std::isspace(bytes[at])) fail_cut_short(name, bytes.size());
  if (numbers[2] < 1 || numbers[2] > 65535)
    throw Error(name + ": the PGM or PPM header's greatest value is not in 1..65535");
  const ImageHeader header{grey ? ImageKind::kPgm : ImageKind::kPpm,
                           checked_size(numbers[0], name),
                           checked_size(numbers[1], name),
                           grey ? 1 : 3,
                           numbers[2] > 255 ? 16 : 8,
                           at + 1};
  const auto wanted = header.pixels_at + static_cast<std::size_t>(header.width_px) *
                                             static_cast<std::size_t>(header.height_px) *
                                             static_cast<std::size_t>(header.channels * header.bits / 8);
  if (bytes.size() < wanted)
    throw Error(name + ": is cut short: " + std::to_string(bytes.size()) + " bytes instead of " +
                std::to_string(wanted) + " for " + to_string(header));
  return header;
}

}  // namespace

ImageHeader read_image_header(std::span<const std::uint8_t> bytes, const std::string& name) {
  if (bytes.empty()) throw Error(name + ": is empty");
  if (starts_with(bytes, kPngStart)) return read_png(bytes, name);
  if (bytes.size() > 2 && bytes[0] == 0xff && bytes[1] == 0xd8) return read_jpeg(bytes, name);
  if (bytes.size() > 2 && bytes[0] == 'P' && (bytes[1] == '5' || bytes[1] == '6'))
    return read_pnm(bytes, name);
  const bool text = std::all_of(
      bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(bytes.size(), 64)),
      [](std::uint8_t c) { return std::isprint(c) || std::isspace(c); });
  throw Error(name + ": is not an image, neither PNG, JPEG, PGM nor PPM" +
              (text ? "; it looks like text" : ""));
}

ImageHeader read_image_header(std::string_view bytes, const std::string& name) {
  return read_image_header(std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()),
                           name);
}

std::string to_string(const ImageHeader& header) {
  constexpr std::array<std::string_view, 4> kKinds = {"PNG", "JPEG", "PGM", "PPM"};
  return std::to_string(header.width_px) + " x " + std::to_string(header.height_px) + " " +
         std::to_string(header.bits) + " bit " + (header.channels <= 2 ? "grey " : "colour ") +
         std::string(kKinds[static_cast<std::size_t>(header.kind)]);
}

}  // namespace roomradar
