// recording_fuzz.cpp: folders with recordings of every kind, with their lists and images. Depth, unit, cameras and
// poses are compared with each other for texts of an even length.
#include "app/sources/kinect/fakenect_replay.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roomradar;
  constexpr int kMostFrames = 8;
  const std::filesystem::path folder = test::folder_with(test::as_text(data, size));
  test::read_or_refuse([&] {
    SourceOptions options;
    options.input = std::make_shared<InputReport>();
    if (size % 2 == 0) options.questions = Questions::kDepth;
    const auto source = open_folder(folder, options);
    Frame frame;
    for (int i = 0; i < kMostFrames && source->next(frame).status != ReadStatus::kEnd; ++i) {
    }
  });
  if (std::filesystem::exists(folder / "INDEX.txt"))
    test::read_or_refuse([&] { const FakenectReplay replay(folder); });
  return 0;
}
