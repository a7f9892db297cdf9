// spool_fuzz.cpp: the frame list of an interrupted live scan.
#include "app/sources/recordings/spooled_source.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roomradar;
  const std::filesystem::path folder = test::fuzz_folder() / "spool";
  std::filesystem::create_directories(folder);
  test::write_bytes(folder / "list.bin", test::as_text(data, size));
  test::read_or_refuse([&] {
    if (!SpooledSource::has_end(folder)) return;
    const auto source = SpooledSource::kept(nullptr, folder);
    Frame frame;
    for (int i = 0; i < 4 && source->next(frame).status != ReadStatus::kEnd; ++i) {
    }
  });
  return 0;
}
