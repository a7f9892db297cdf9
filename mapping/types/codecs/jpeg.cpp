// jpeg.cpp: wraps libjpeg. Its errors longjmp() into the functions that call setjmp(), and would skip
// destructors there. Those functions must therefore not own objects with destructors.
#include "mapping/types/codecs/jpeg.hpp"

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstddef>
#include <cstdio>  // jpeglib.h uses it
#include <cstdlib>

#include <jpeglib.h>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr JDIMENSION kMaxJpegSide_px = 16384;
static_assert(sizeof(Rgb) == 3);

/// Handler, return point and text of libjpeg's errors.
struct JpegFaults {
  jpeg_error_mgr manager{};
  std::jmp_buf on_error{};
  std::array<char, JMSG_LENGTH_MAX> text{};
};

/// Makes errors of the decoder or encoder jump back to faults.on_error.
template <typename Codec>
void watch(Codec& codec, JpegFaults& faults) {
  codec.err = jpeg_std_error(&faults.manager);
  codec.client_data = &faults;
  faults.manager.error_exit = [](j_common_ptr common) {
    auto& own = *static_cast<JpegFaults*>(common->client_data);
    common->err->format_message(common, own.text.data());
    std::longjmp(own.on_error, 1);
  };
  faults.manager.output_message = [](j_common_ptr) {};  // warnings: the picture is usable
}

/// A decoder of libjpeg. It stays where it is, since libjpeg keeps pointers to it.
struct JpegDecoder {
  jpeg_decompress_struct info{};
  JpegFaults faults;

  JpegDecoder() { watch(info, faults); }
  JpegDecoder(const JpegDecoder&) = delete;
  JpegDecoder& operator=(const JpegDecoder&) = delete;
  ~JpegDecoder() { jpeg_destroy_decompress(&info); }
};

/// Reads the header; afterwards the size is known. Returns false after an error.
bool read_jpeg_head(JpegDecoder& decoder, std::string_view bytes) {
  if (setjmp(decoder.faults.on_error) != 0) return false;
  jpeg_create_decompress(&decoder.info);
  jpeg_mem_src(&decoder.info, reinterpret_cast<const unsigned char*>(bytes.data()),
               static_cast<unsigned long>(bytes.size()));
  jpeg_read_header(&decoder.info, TRUE);
  return true;
}

/// Converts a row of inverted CMYK, as Adobe's programs write it.
void convert_cmyk(const JSAMPLE* from, Rgb* to, JDIMENSION width) {
  const auto darker = [](int ink, int black) {
    return static_cast<std::uint8_t>(black - ((255 - ink) * black >> 8));
  };
  for (JDIMENSION x = 0; x < width; ++x, from += 4)
    to[x] = {darker(from[0], from[3]), darker(from[1], from[3]), darker(from[2], from[3])};
}

/// Decodes all rows into `colour`, which has the size of the JPEG. Returns false after an error.
bool read_jpeg_rows(JpegDecoder& decoder, ColourImage& colour) {
  if (setjmp(decoder.faults.on_error) != 0) return false;
  jpeg_decompress_struct& info = decoder.info;
  const bool is_cmyk = info.num_components == 4;
  info.out_color_space = is_cmyk ? JCS_CMYK : JCS_RGB;
  jpeg_start_decompress(&info);
  JSAMPARRAY cmyk = nullptr;  // memory of the decoder
  if (is_cmyk)
    cmyk =
        info.mem->alloc_sarray(reinterpret_cast<j_common_ptr>(&info), JPOOL_IMAGE, 4 * info.output_width, 1);
  while (info.output_scanline < info.output_height) {
    Rgb* const to = colour.row(static_cast<int>(info.output_scanline));
    JSAMPROW row = is_cmyk ? cmyk[0] : reinterpret_cast<JSAMPROW>(to);
    jpeg_read_scanlines(&info, &row, 1);
    if (is_cmyk) convert_cmyk(row, to, info.output_width);
  }
  jpeg_abort_decompress(&info);  // what follows the last row is of no use
  return true;
}

/// An encoder of libjpeg. It stays where it is.
struct JpegEncoder {
  jpeg_compress_struct info{};
  JpegFaults faults;
  unsigned char* bytes = nullptr;
  unsigned long size = 0;

  JpegEncoder() { watch(info, faults); }
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;
  ~JpegEncoder() {
    jpeg_destroy_compress(&info);
    std::free(bytes);
  }
};

bool write_jpeg_rows(JpegEncoder& encoder, const ColourImage& picture, int quality) {
  if (setjmp(encoder.faults.on_error) != 0) return false;
  jpeg_compress_struct& info = encoder.info;
  jpeg_create_compress(&info);
  jpeg_mem_dest(&info, &encoder.bytes, &encoder.size);
  info.image_width = static_cast<JDIMENSION>(picture.width);
  info.image_height = static_cast<JDIMENSION>(picture.height);
  info.input_components = 3;
  info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, quality, TRUE);
  info.optimize_coding = TRUE;
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    // libjpeg only reads the row.
    JSAMPROW row =
        reinterpret_cast<JSAMPROW>(const_cast<Rgb*>(picture.row(static_cast<int>(info.next_scanline))));
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  return true;
}

}  // namespace

std::vector<std::uint8_t> jpeg_of(const ColourImage& picture, int quality) {
  const std::string fault = "a picture of " + std::to_string(picture.width) + " x " +
                            std::to_string(picture.height) + " pixels cannot be written as JPEG";
  if (picture.empty()) throw Error(fault);
  JpegEncoder encoder;
  if (!write_jpeg_rows(encoder, picture, quality)) throw Error(fault + ": " + encoder.faults.text.data());
  return {encoder.bytes, encoder.bytes + encoder.size};
}

std::optional<std::string> decode_jpeg(std::string_view bytes, ColourImage& picture) {
  JpegDecoder decoder;
  if (!read_jpeg_head(decoder, bytes)) return decoder.faults.text.data();
  const JDIMENSION width = decoder.info.image_width, height = decoder.info.image_height;
  if (std::max(width, height) > kMaxJpegSide_px) return "it has more than 16384 px per side";
  if (picture.width != static_cast<int>(width) || picture.height != static_cast<int>(height))
    picture.resize(static_cast<int>(width), static_cast<int>(height));
  if (!read_jpeg_rows(decoder, picture)) return decoder.faults.text.data();
  return std::nullopt;
}

void require_jpeg(std::span<const std::uint8_t> jpeg, int width_px, int height_px, const std::string& where) {
  const auto byte = [&](std::size_t i) { return i < jpeg.size() ? jpeg[i] : 0; };
  const auto word = [&](std::size_t i) { return 256 * byte(i) + byte(i + 1); };
  const std::size_t size = jpeg.size();
  if (size < 4 || word(0) != 0xffd8) throw Error(where + ": is not a JPEG picture");
  if (word(size - 2) != 0xffd9) throw Error(where + ": is cut short; a JPEG picture ends otherwise");
  // Segments: a marker, then the length of the rest. Start of frame: precision, height, width.
  for (std::size_t at = 2; at + 9 < size && byte(at) == 0xff;
       at += 2 + static_cast<std::size_t>(word(at + 2))) {
    const int marker = byte(at + 1);
    const bool is_frame =
        marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (!is_frame) continue;
    const int height = word(at + 5), width = word(at + 7);
    if (width != width_px || height != height_px)
      throw Error(where + ": has " + std::to_string(width) + " x " + std::to_string(height) +
                  " pixels, and " + std::to_string(width_px) + " x " + std::to_string(height_px) +
                  " belong to the map");
    return;
  }
  throw Error(where + ": is a damaged JPEG picture without a size");
}

ColourImage picture_of_jpeg(std::span<const std::uint8_t> jpeg, int width_px, int height_px,
                            const std::string& where) {
  require_jpeg(jpeg, width_px, height_px, where);
  ColourImage picture;
  if (decode_jpeg({reinterpret_cast<const char*>(jpeg.data()), jpeg.size()}, picture) ||
      picture.width != width_px || picture.height != height_px)
    throw Error(where + ": cannot be decoded; is it damaged?");
  return picture;
}

}  // namespace roomradar
