// rvl_fuzz.cpp: depth in RVL: columns, rows and the stream.
#include <cstdlib>

#include "app/sources/containers/rvl_depth.hpp"
#include "tests/app/sources/containers/written_rvl.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roomradar;
  constexpr int kMaxPixels = 1 << 16;  // larger images take longer, not other ways
  const std::string bytes(test::as_text(data, size));
  static Image<std::uint16_t> image, again;
  test::read_or_refuse([&] {
    const RvlSize read = read_rvl_size(bytes, "rvl");
    if (static_cast<std::int64_t>(read.width_px) * read.height_px > kMaxPixels) return;
    decode_rvl(bytes, {}, "rvl", image);
    decode_rvl(test::written_rvl(image), read, "written rvl", again);
    if (again.pixels != image.pixels) std::abort();
  });
  return 0;
}
