// locate_fuzz.cpp: bodies of requests to locate a camera.
#include "app/serve/locate_request.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roomradar;
  test::read_or_refuse([&] { (void)parse_locate_request(test::as_text(data, size)); });
  return 0;
}
