// image_file.cpp: image files through the codecs for PNG and JPEG, with checks before and after.
#include "app/sources/formats/image_file.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "app/sources/formats/image_header.hpp"
#include "app/sources/formats/kinect_units.hpp"
#include "mapping/types/codecs/jpeg.hpp"
#include "mapping/types/codecs/png.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

constexpr std::uintmax_t kLargestImage_bytes = std::uintmax_t{1} << 30;

std::string read_image_bytes(const std::filesystem::path& path) {
  return read_bytes(path, "an image", kLargestImage_bytes);
}

template <typename Pixel>
void write_png(const Image<Pixel>& image, const std::filesystem::path& path) {
  std::vector<std::uint8_t> bytes;
  try {
    bytes = encode_png(image);
  } catch (const Error& fault) {
    throw Error(path.string() + ": " + fault.what());
  }
  write_bytes(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

/// Throws Error if the codec found a fault, or another size than the header's.
template <typename Pixel>
void require_decoded(const std::optional<std::string>& fault, const Image<Pixel>& image,
                     const ImageHeader& header, const std::string& name) {
  if (fault) throw Error(name + ": is damaged: its pixels cannot be decoded: " + *fault);
  if (image.width != header.width_px || image.height != header.height_px)
    throw Error(name + ": is damaged: its pixels' size differs from its header's");
}

/// Decodes a 16 bit PNG, or a 16 bit PGM, whose pixels are big-endian by its specification.
Image<std::uint16_t> decode_16_bit(std::string_view bytes, const std::string& name) {
  const ImageHeader header = read_image_header(bytes, name);
  if (header.kind == ImageKind::kPgm && header.bits == 16) {
    Image<std::uint16_t> image(header.width_px, header.height_px);
    const std::uint8_t* raw = reinterpret_cast<const std::uint8_t*>(bytes.data()) + header.pixels_at;
    for (std::uint16_t& pixel : image.pixels) {
      pixel = static_cast<std::uint16_t>(raw[0] << 8 | raw[1]);
      raw += 2;
    }
    return image;
  }
  if (header.kind != ImageKind::kPng || header.bits != 16 || header.channels != 1)
    throw Error(name + ": is a " + to_string(header) + "; depth must be a 16 bit grey PNG or PGM");
  Image<std::uint16_t> image;
  require_decoded(decode_png(bytes, image), image, header, name);
  return image;
}

/// Returns the number of units in a metre. A number that is almost whole is rounded: dividing by a whole number
/// gives the float nearest to the depth.
float units_per_m(double unit_m) {
  const double units = 1.0 / unit_m, whole = std::round(units);
  return static_cast<float>(std::abs(units - whole) < 1e-3 ? whole : units);
}

/// Converts units to m; `invalid` is no measurement.
void convert(const Image<std::uint16_t>& image, float units_per_m, int invalid, DepthImage& depth_m) {
  depth_m.resize(image.width, image.height);
  const std::uint16_t* from = image.pixels.data();
  float* to = depth_m.pixels.data();
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {  // vectorised, since it always divides
    const float depth = static_cast<float>(from[i]) / units_per_m;
    to[i] = from[i] == invalid ? 0.0F : depth;
  }
}

void read_kinect_raw(const std::filesystem::path& path, DepthImage& depth_m) {
  const std::string name = path.string();
  const std::string bytes = read_image_bytes(path);
  const ImageHeader header = read_image_header(bytes, name);
  if (header.kind != ImageKind::kPgm || header.bits != 16)
    throw Error(name + ": is a " + to_string(header) + "; raw Kinect depth must be a 16 bit PGM");
  depth_m.resize(header.width_px, header.height_px);
  const std::uint8_t* raw = reinterpret_cast<const std::uint8_t*>(bytes.data()) + header.pixels_at;
  for (float& pixel : depth_m.pixels) {
    pixel = raw_depth_m(static_cast<std::uint16_t>(raw[0] | raw[1] << 8));
    raw += 2;
  }
}

}  // namespace

void read_depth_file(const std::filesystem::path& path, DepthEncoding encoding, DepthImage& depth_m) {
  read_depth_file(path, encoding, depth_unit_m(encoding), depth_m);
}

void read_depth_file(const std::filesystem::path& path, DepthEncoding encoding, double unit_m,
                     DepthImage& depth_m) {
  if (encoding == DepthEncoding::kKinectRaw) {
    read_kinect_raw(path, depth_m);
    return scale_depth(unit_m, depth_m);
  }
  const Image<std::uint16_t> image = decode_16_bit(read_image_bytes(path), path.string());
  convert(image, units_per_m(unit_m), encoding == DepthEncoding::kTum ? 0 : 65535, depth_m);
}

double depth_unit_m(DepthEncoding encoding) {
  return encoding == DepthEncoding::kTum ? 1.0 / 5000.0 : encoding == DepthEncoding::kKinectRaw ? 1.0 : 0.001;
}

void scale_depth(double factor, DepthImage& depth_m) {
  if (factor == 1.0) return;
  for (float& depth : depth_m.pixels) depth = static_cast<float>(depth * factor);
}

void decode_depth_png(std::string_view bytes, float units_per_m, const std::string& name,
                      DepthImage& depth_m) {
  convert(decode_16_bit(bytes, name), units_per_m, 65535, depth_m);
}

void decode_float_png(std::string_view bytes, const std::string& name, DepthImage& depth_m) {
  const ImageHeader header = read_image_header(bytes, name);
  if (header.kind != ImageKind::kPng || header.bits != 8 || header.channels != 4)
    throw Error(name + ": is a " + to_string(header) + "; must be a PNG of four 8 bit channels");
  Image<Rgba> image;
  require_decoded(decode_png(bytes, image), image, header, name);
  depth_m.resize(image.width, image.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const Rgba& part = image.pixels[i];  // OpenCV writes the float's first byte as blue
    const auto depth = std::bit_cast<float>(std::array{part.b, part.g, part.r, part.a});
    depth_m.pixels[i] = std::isfinite(depth) && depth > 0.0F ? depth : 0.0F;
  }
}

void decode_grey_png(std::string_view bytes, const std::string& name, Image<std::uint8_t>& image) {
  const ImageHeader header = read_image_header(bytes, name);
  if (header.kind != ImageKind::kPng || header.bits != 8 || header.channels != 1)
    throw Error(name + ": is a " + to_string(header) + "; must be an 8 bit grey PNG");
  require_decoded(decode_png(bytes, image), image, header, name);
}

void read_colour_file(const std::filesystem::path& path, ColourImage& colour) {
  decode_colour(read_image_bytes(path), path.string(), colour);
}

void decode_colour(std::string_view bytes, const std::string& name, ColourImage& colour) {
  const ImageHeader header = read_image_header(bytes, name);
  if (header.kind == ImageKind::kPpm && header.bits == 8) {
    colour.resize(header.width_px, header.height_px);
    std::memcpy(colour.pixels.data(), bytes.data() + header.pixels_at, colour.pixels.size() * sizeof(Rgb));
    return;
  }
  if (header.kind == ImageKind::kJpeg)
    require_decoded(decode_jpeg(bytes, colour), colour, header, name);
  else if (header.kind == ImageKind::kPng)
    require_decoded(decode_png(bytes, colour), colour, header, name);
  else
    throw Error(name + ": is a " + to_string(header) + "; must be a PNG, JPEG or 8 bit PPM");
}

void write_depth_file(const DepthImage& depth_m, DepthEncoding encoding, const std::filesystem::path& path) {
  Image<std::uint16_t> image(depth_m.width, depth_m.height);
  const bool is_raw = encoding == DepthEncoding::kKinectRaw;
  const float units_per_m = encoding == DepthEncoding::kTum ? 5000.0F : 1000.0F;
  const float largest = encoding == DepthEncoding::kTum ? 65535.0F : 65534.0F;  // 65535 mm means invalid
  for (int y = 0; y < depth_m.height; ++y) {
    const float* from = depth_m.row(y);
    std::uint16_t* to = image.row(y);
    for (int x = 0; x < depth_m.width; ++x) {
      const float units = std::round(from[x] * units_per_m);
      to[x] = is_raw                             ? raw_from_depth_m(from[x])
              : units > 0.0F && units <= largest ? static_cast<std::uint16_t>(units)
                                                 : std::uint16_t{0};
    }
  }
  if (!is_raw) return write_png(image, path);
  static_assert(std::endian::native == std::endian::little, "raw Kinect depth is little-endian on disk");
  std::string bytes = "P5 " + std::to_string(image.width) + " " + std::to_string(image.height) + " 65535\n";
  bytes.append(reinterpret_cast<const char*>(image.pixels.data()),
               image.pixels.size() * sizeof(std::uint16_t));
  write_bytes(path, bytes);
}

void write_colour_file(const ColourImage& colour, const std::filesystem::path& path) {
  if (path.extension() == ".ppm") {
    std::string bytes = "P6 " + std::to_string(colour.width) + " " + std::to_string(colour.height) + " 255\n";
    bytes.append(reinterpret_cast<const char*>(colour.pixels.data()), colour.pixels.size() * sizeof(Rgb));
    return write_bytes(path, bytes);
  }
  write_png(colour, path);
}

void write_mask_file(const MaskImage& mask, const std::filesystem::path& path) {
  write_png<std::uint8_t>(mask, path);
}

void require_depth(const DepthImage& depth_m, const std::string& name) {
  for (const float depth : depth_m.pixels)
    if (!(depth >= 0.0F && std::isfinite(depth)))
      throw Error(name + ": is damaged: a pixel holds " + format_fixed(static_cast<double>(depth), 6) + " m");
}

void read_exact_depth_file(const std::filesystem::path& path, DepthImage& depth_m) {
  const Image<std::uint16_t> halves = decode_16_bit(read_image_bytes(path), path.string());
  depth_m.resize(halves.width, halves.height / 2);
  for (int y = 0; y < depth_m.height; ++y)
    for (int x = 0; x < depth_m.width; ++x)
      depth_m.at(x, y) = std::bit_cast<float>(static_cast<std::uint32_t>(halves.at(x, y)) << 16 |
                                              halves.at(x, y + depth_m.height));
  require_depth(depth_m, path.string());
}

}  // namespace roomradar
