// image_fuzz.cpp: depth and colour images, kinds told apart by the first byte.
#include "app/sources/formats/image_file.hpp"
#include "app/sources/recordings/frame_images.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roomradar;
  if (size == 0) return 0;
  const std::filesystem::path path = test::file_with(test::as_text(data + 1, size - 1), "image");
  static DepthImage depth_m;
  static ColourImage colour;
  static Frame frame;
  test::read_or_refuse([&] {
    switch (data[0]) {
      case 'm':
        read_depth_file(path, DepthEncoding::kMillimetres, depth_m);
        break;
      case 't':
        read_depth_file(path, DepthEncoding::kTum, depth_m);
        break;
      case 'r':
        read_depth_file(path, DepthEncoding::kKinectRaw, depth_m);
        break;
      case 'e':
        read_exact_depth_file(path, depth_m);
        break;
      case 'f':
        read_frame_images(path, frame);
        break;
      default:
        read_colour_file(path, colour);
    }
  });
  return 0;
}
