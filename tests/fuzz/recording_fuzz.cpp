// recording_fuzz.cpp: folders with recordings of every kind, with their lists and images.
#include "app/sources/kinect/fakenect_replay.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roomradar;
  constexpr int kMostFrames = 8;
  const std::filesystem::path folder = test::folder_with(test::as_text(data, size));
  test::read_or_refuse([&] {
    const auto source = open_folder(folder);
    Frame frame;
    for (int i = 0; i < kMostFrames && source->next(frame).status != ReadStatus::kEnd; ++i) {
    }
  });
  if (std::filesystem::exists(folder / "INDEX.txt"))
    test::read_or_refuse([&] { const FakenectReplay replay(folder); });
  return 0;
}
