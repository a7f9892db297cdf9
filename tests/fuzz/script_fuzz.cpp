// script_fuzz.cpp: user input: event files, names of simulated rooms, frame ranges.
#include "app/session/script/script.hpp"
#include "app/sim/sensor/sim_options.hpp"
#include "app/sources/formats/frame_range.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roomradar;
  const std::string_view text = test::as_text(data, size);
  test::read_or_refuse([&] { (void)parse_script(text, "script"); });
  const std::string_view argument = text.substr(0, text.find('\0'));  // arguments end at the first null
  test::read_or_refuse([&] { (void)parse_sim_spec(argument); });
  test::read_or_refuse([&] { (void)parse_frame_range(argument); });
  return 0;
}
