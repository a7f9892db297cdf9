// picture_fuzz.cpp: pictures of textures, and the codecs for PNG and JPEG.
#include "app/models/texture_file.hpp"
#include "mapping/types/codecs/jpeg.hpp"
#include "mapping/types/codecs/png.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roomradar;
  const std::string_view bytes = test::as_text(data, size);
  static ColourImage colour;
  static Image<std::uint8_t> grey8;
  static Image<std::uint16_t> grey16;
  (void)decode_png(bytes, colour);
  (void)decode_png(bytes, grey8);
  (void)decode_png(bytes, grey16);
  (void)decode_jpeg(bytes, colour);
  test::read_or_refuse([&] { (void)decode_texture(bytes, 1U << 20U); });
  return 0;
}
