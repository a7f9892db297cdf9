// texture_file.cpp: decodes by libpng, libjpeg, libwebp and stb_image, and reduces by averaging blocks of
// pixels.
#include "app/models/texture_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <system_error>

#include <stb_image.h>
#include <webp/decode.h>

#include "mapping/mesh/model_folder.hpp"
#include "mapping/types/codecs/jpeg.hpp"
#include "mapping/types/codecs/png.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

constexpr std::uintmax_t kMaxFileBytes = 64U << 20U;
constexpr int kMaxFileSide_px = 16384;

/// Decoded pixels: 3 or 4 bytes each, rows from the top.
struct Decoded {
  const unsigned char* pixels = nullptr;
  int width = 0, height = 0, channels = 0;
  bool is_blue_first = false;

  /// Returns red, green, blue and alpha.
  [[nodiscard]] std::array<unsigned, 4> at(int x, int y) const {
    const auto index =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    const unsigned char* const pixel = pixels + index * static_cast<std::size_t>(channels);
    return {pixel[is_blue_first ? 2 : 0], pixel[1], pixel[is_blue_first ? 0 : 2],
            channels == 4 ? pixel[3] : 255U};
  }
};

/// Returns the factor by which both sides are divided.
double reduction(int width, int height, std::size_t max_pixels) {
  const double pixels = static_cast<double>(width) * height;
  return std::max({1.0, static_cast<double>(std::max(width, height)) / kMaxTextureSide_px,
                   std::sqrt(pixels / static_cast<double>(max_pixels))});
}

/// Returns the picture with sides divided by the reduction; each pixel is the mean of those that it replaces.
Texture reduced(const Decoded& decoded, std::size_t max_pixels) {
  const double factor = reduction(decoded.width, decoded.height, max_pixels);
  const int width = std::max(1, static_cast<int>(decoded.width / factor));
  const int height = std::max(1, static_cast<int>(decoded.height / factor));
  Texture texture;
  texture.colour.resize(width, height);
  if (decoded.channels == 4) texture.opacity.resize(width, height);
  const auto first = [](int i, int all, int parts) {
    return static_cast<int>(static_cast<std::int64_t>(i) * all / parts);
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      std::array<std::uint64_t, 4> sum{};
      std::uint64_t count = 0;
      for (int v = first(y, decoded.height, height); v < first(y + 1, decoded.height, height); ++v)
        for (int u = first(x, decoded.width, width); u < first(x + 1, decoded.width, width); ++u, ++count) {
          const std::array<unsigned, 4> pixel = decoded.at(u, v);
          for (std::size_t c = 0; c < 4; ++c) sum[c] += pixel[c];
        }
      const auto mean = [&](std::size_t c) {
        return static_cast<std::uint8_t>((sum[c] + count / 2) / count);
      };
      texture.colour.at(x, y) = {mean(0), mean(1), mean(2)};
      if (!texture.opacity.empty()) texture.opacity.at(x, y) = mean(3);
    }
  const bool is_opaque = std::all_of(texture.opacity.pixels.begin(), texture.opacity.pixels.end(),
                                     [](std::uint8_t opacity) { return opacity == 255; });
  if (is_opaque) texture.opacity = {};
  return texture;
}

/// Returns the name with slashes, without "file://" and with "%20" and the like decoded.
std::string plain_name(std::string name) {
  if (name.starts_with("file://")) name.erase(0, 7);
  std::string plain;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto is_hex = [&](std::size_t at) {
      return at < name.size() && std::isxdigit(static_cast<unsigned char>(name[at])) != 0;
    };
    if (name[i] == '%' && is_hex(i + 1) && is_hex(i + 2)) {
      plain += static_cast<char>(std::stoi(name.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      plain += name[i] == '\\' ? '/' : name[i];
    }
  }
  return plain;
}

Texture texture_of_png(std::string_view bytes, std::size_t max_pixels) {
  Image<Rgba> image;
  if (const auto fault = decode_png(bytes, image)) throw Error("cannot be decoded as PNG: " + *fault);
  return reduced({&image.pixels.front().r, image.width, image.height, 4}, max_pixels);
}

Texture texture_of_jpeg(std::string_view bytes, std::size_t max_pixels) {
  ColourImage image;
  if (const auto fault = decode_jpeg(bytes, image)) throw Error("cannot be decoded as JPEG: " + *fault);
  return reduced({&image.pixels.front().r, image.width, image.height, 3}, max_pixels);
}

/// TGA has no mark at its beginning: a colour map or none, and one of the kinds that stb_image decodes.
bool is_tga(std::string_view bytes) {
  constexpr std::string_view kKinds("\1\2\3\x9\xa\xb");
  return bytes.size() > 18 && (bytes[1] == 0 || bytes[1] == 1) && kKinds.find(bytes[2]) != kKinds.npos;
}

Texture texture_of_bmp_or_tga(std::string_view bytes, std::size_t max_pixels) {
  int width = 0, height = 0, channels = 0;
  const auto* const data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const auto size = static_cast<int>(bytes.size());
  if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0 || std::min(width, height) < 1 ||
      std::max(width, height) > kMaxFileSide_px)
    throw Error("cannot be decoded as BMP or TGA of 1..16384 px per side");
  // A run of at most 128 pixels takes two bytes or more; without runs, a byte holds at most 8 pixels.
  if (static_cast<double>(width) * height > 64.0 * size) throw Error("is cut short");
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
      stbi_load_from_memory(data, size, &width, &height, &channels, 4), &stbi_image_free);
  if (pixels == nullptr)
    throw Error("cannot be decoded as BMP or TGA: " + std::string(stbi_failure_reason()));
  return reduced({pixels.get(), width, height, 4}, max_pixels);
}

Texture texture_of_webp(std::string_view bytes, std::size_t max_pixels) {
  const auto* const data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(data, bytes.size(), &features) != VP8_STATUS_OK)
    throw Error("cannot be decoded as WebP: its header is damaged or cut short");
  if (features.has_animation != 0) throw Error("cannot be decoded: it is an animated WebP");
  int width = 0, height = 0;
  const std::unique_ptr<std::uint8_t, decltype(&WebPFree)> pixels(
      WebPDecodeRGBA(data, bytes.size(), &width, &height), &WebPFree);
  if (pixels == nullptr) throw Error("cannot be decoded as WebP: it is damaged or cut short");
  return reduced({pixels.get(), width, height, 4}, max_pixels);
}

}  // namespace

Texture decode_texture(std::string_view bytes, std::size_t max_pixels) {
  if (bytes.empty()) throw Error("has no bytes");
  try {
    if (bytes.starts_with("\x89PNG")) return texture_of_png(bytes, max_pixels);
    if (bytes.starts_with("\xff\xd8")) return texture_of_jpeg(bytes, max_pixels);
    if (bytes.starts_with("RIFF") && bytes.substr(0, 12).ends_with("WEBP"))
      return texture_of_webp(bytes, max_pixels);
    if (bytes.starts_with("BM") || is_tga(bytes)) return texture_of_bmp_or_tga(bytes, max_pixels);
  } catch (const std::bad_alloc&) {  // of a picture that claims to be huge
    throw Error("cannot be decoded: it is too large");
  }
  throw Error("cannot be decoded: it is neither PNG, JPEG, WebP, BMP nor TGA");
}

Texture texture_of_bgra(std::string_view bytes, int width, int height, std::size_t max_pixels) {
  if (width <= 0 || height <= 0 ||
      bytes.size() / 4 / static_cast<std::size_t>(width) < static_cast<std::size_t>(height))
    throw Error("is cut short");
  return reduced({reinterpret_cast<const unsigned char*>(bytes.data()), width, height, 4, true}, max_pixels);
}

NamedFile find_texture(const std::filesystem::path& model, const std::string& name) {
  constexpr std::string_view kMissing = "is missing";
  std::string fault;
  for (const std::string& spelling : {name, plain_name(name)}) {
    const std::filesystem::path path = spelling;
    for (const std::filesystem::path& candidate : {path, path.filename()}) {
      NamedFile found = file_in_folder_of(model, candidate);
      if (found.fault.empty()) return found;
      if (fault.empty() || fault == kMissing) fault = std::move(found.fault);
    }
  }
  return {{}, fault};
}

Texture read_texture(const std::filesystem::path& path, std::size_t max_pixels) {
  std::error_code unreadable;
  const std::uintmax_t size = std::filesystem::file_size(path, unreadable);
  if (unreadable) throw Error("cannot be read: " + unreadable.message());
  if (size > kMaxFileBytes) throw Error("has more than 64 MB");
  return decode_texture(read_bytes(path, "a picture", kMaxFileBytes), max_pixels);
}

}  // namespace roomradar
