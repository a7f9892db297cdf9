// db3_fuzz.cpp: bags of ROS 2, as databases.
#include "tests/fuzz/foreign_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  roomradar::test::read_foreign(data, size, "recording.db3");
  return 0;
}
