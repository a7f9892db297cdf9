// rtabmap_fuzz.cpp: databases of RTAB-Map.
#include "tests/fuzz/foreign_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  roomradar::test::read_foreign(data, size, "recording.db");
  return 0;
}
