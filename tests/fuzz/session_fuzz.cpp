// session_fuzz.cpp: folders of recorded sessions: settings, events, frames, results.
#include "app/cli/session_folder.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roomradar;
  const std::filesystem::path folder = test::folder_with(test::as_text(data, size));
  test::read_or_refuse([&] {
    if (!is_session_folder(folder)) return;
    const RunOptions options = read_session(folder);
    (void)read_script(options.script);
  });
  test::read_or_refuse([&] { (void)map_difference(folder, MapInfo{}); });
  test::read_or_refuse([&] {
    const auto source = open_session_frames(folder);
    Frame frame;
    for (int i = 0; i < 4 && source->next(frame).status != ReadStatus::kEnd; ++i) {
    }
  });
  test::read_or_refuse([&] {
    ReplayCheck check(folder);
    check.compare({0, 1, 2});
    check.compare({1, 3, 0});
  });
  return 0;
}
