// texture_file.cpp: decodes by OpenCV, and reduces by averaging blocks of pixels.
#include "app/models/texture_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <system_error>

#include "app/models/tga_picture.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

constexpr std::uintmax_t kMaxFileBytes = 64U << 20U;

/// Rows of decoded pixels: 1 (grey), 3 (BGR) or 4 (BGRA) channels of 8 or 16 bits.
struct Decoded {
  const unsigned char* pixels = nullptr;
  int width = 0, height = 0, channels = 0;
  std::size_t row_bytes = 0;
  bool is_16_bit = false;

  /// Returns red, green, blue and alpha.
  [[nodiscard]] std::array<unsigned, 4> at(int x, int y) const {
    const auto channel = [&](int c) -> unsigned {
      const std::size_t index = static_cast<std::size_t>(x * channels + c);
      const unsigned char* row = pixels + static_cast<std::size_t>(y) * row_bytes;
      return is_16_bit ? row[2 * index + 1] : row[index];  // the high byte, as this machine is little-endian
    };
    if (channels == 1) return {channel(0), channel(0), channel(0), 255};
    return {channel(2), channel(1), channel(0), channels == 4 ? channel(3) : 255};
  }
};

/// Returns the factor by which both sides are divided.
double reduction(int width, int height, std::size_t max_pixels) {
  const double pixels = static_cast<double>(width) * height;
  return std::max({1.0, static_cast<double>(std::max(width, height)) / kMaxTextureSide_px,
                   std::sqrt(pixels / static_cast<double>(max_pixels))});
}

/// Returns the picture with sides divided by the reduction; each pixel is the mean of those that it replaces.
/// OpenCV's resize is not used: its threads do not exist in a forked child.
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

}  // namespace

Texture decode_texture(std::string_view bytes, std::size_t max_pixels) {
  const char* const fault = "cannot be decoded as PNG, JPEG, BMP, TIFF, WebP or TGA";
  if (bytes.empty()) throw Error("is empty");
  cv::Mat image;
  try {
    const cv::Mat encoded(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
    image = cv::imdecode(encoded, cv::IMREAD_UNCHANGED);
  } catch (const std::exception&) {  // also std::bad_alloc, for a picture that claims to be huge
    throw Error(fault);
  }
  const int channels = image.channels();
  if (image.empty())
    if (const std::optional<TgaPicture> tga = decode_tga(bytes))
      return texture_of_bgra(tga->bgra, tga->width, tga->height, max_pixels);
  if (image.empty() || (image.depth() != CV_8U && image.depth() != CV_16U) ||
      (channels != 1 && channels != 3 && channels != 4))
    throw Error(fault);
  return reduced({image.data, image.cols, image.rows, channels, image.step[0], image.depth() == CV_16U},
                 max_pixels);
}

Texture texture_of_bgra(std::string_view bytes, int width, int height, std::size_t max_pixels) {
  if (width <= 0 || height <= 0 ||
      bytes.size() / 4 / static_cast<std::size_t>(width) < static_cast<std::size_t>(height))
    throw Error("is cut short");
  return reduced({reinterpret_cast<const unsigned char*>(bytes.data()), width, height, 4,
                  4 * static_cast<std::size_t>(width), false},
                 max_pixels);
}

std::filesystem::path find_texture(const std::filesystem::path& model, const std::string& name) {
  const std::filesystem::path folder = model.parent_path();
  for (const std::string& spelling : {name, plain_name(name)}) {
    const std::filesystem::path path = spelling;
    for (const std::filesystem::path& candidate : {folder / path, folder / path.filename()}) {
      std::error_code unreadable;
      if (std::filesystem::is_regular_file(candidate, unreadable)) return candidate;
    }
  }
  return {};
}

Texture read_texture(const std::filesystem::path& path, std::size_t max_pixels) {
  std::error_code unreadable;
  const std::uintmax_t size = std::filesystem::file_size(path, unreadable);
  if (unreadable) throw Error("cannot be read: " + unreadable.message());
  if (size > kMaxFileBytes) throw Error("has more than 64 MB");
  return decode_texture(read_bytes(path, "a picture", kMaxFileBytes), max_pixels);
}

}  // namespace roomradar
