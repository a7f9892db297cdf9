// jpeg_colour.cpp: decodes through libjpeg, whose errors jump back into decode_rows().
#include "app/sources/formats/jpeg_colour.hpp"

#include <array>
#include <csetjmp>
#include <cstddef>
#include <cstdint>
#include <cstdio>  // jpeglib.h uses it

#include <jpeglib.h>

namespace roomradar {
namespace {

/// A decoder of libjpeg. It stays where it is, since libjpeg keeps pointers to it.
struct Decoder {
  jpeg_decompress_struct info{};
  jpeg_error_mgr errors{};
  std::jmp_buf on_error{};
  std::array<char, JMSG_LENGTH_MAX> fault{};

  Decoder() {
    info.err = jpeg_std_error(&errors);
    info.client_data = this;
    errors.error_exit = [](j_common_ptr common) {
      auto& decoder = *static_cast<Decoder*>(common->client_data);
      common->err->format_message(common, decoder.fault.data());
      std::longjmp(decoder.on_error, 1);
    };
    errors.output_message = [](j_common_ptr) {};  // warnings: the image is usable
  }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  ~Decoder() { jpeg_destroy_decompress(&info); }
};

/// Decodes all rows into `colour`, which has the size of the JPEG already. Returns false after an error. No
/// object with a destructor may live in this function, since errors jump over it.
bool decode_rows(Decoder& decoder, std::string_view bytes, ColourImage& colour) {
  if (setjmp(decoder.on_error) != 0) return false;
  jpeg_decompress_struct& info = decoder.info;
  jpeg_create_decompress(&info);
  jpeg_mem_src(&info, reinterpret_cast<const unsigned char*>(bytes.data()),
               static_cast<unsigned long>(bytes.size()));
  jpeg_read_header(&info, TRUE);
  if (static_cast<int>(info.image_width) != colour.width ||
      static_cast<int>(info.image_height) != colour.height)
    return false;
  info.out_color_space = JCS_RGB;
  jpeg_start_decompress(&info);
  while (info.output_scanline < info.output_height) {
    JSAMPROW row = reinterpret_cast<JSAMPROW>(colour.row(static_cast<int>(info.output_scanline)));
    jpeg_read_scanlines(&info, &row, 1);
  }
  jpeg_abort_decompress(&info);  // what follows the last row is of no use
  return true;
}

}  // namespace

std::optional<std::string> decode_jpeg(std::string_view bytes, ColourImage& colour) {
  static_assert(sizeof(Rgb) == 3);
  Decoder decoder;
  if (decode_rows(decoder, bytes, colour)) return std::nullopt;
  return decoder.fault[0] != '\0' ? std::string(decoder.fault.data())
                                  : std::string("its size differs from its header's");
}

}  // namespace roomradar
