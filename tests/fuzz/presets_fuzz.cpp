// presets_fuzz.cpp: presets files.
#include "app/quality/presets.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roomradar;
  test::read_or_refuse([&] { (void)presets_of(test::as_text(data, size), "presets"); });
  return 0;
}
