// oni_fuzz.cpp: recordings of OpenNI.
#include "tests/fuzz/foreign_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  roomradar::test::read_foreign(data, size, "recording.oni");
  return 0;
}
