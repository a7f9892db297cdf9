// foreign_input.hpp: reads a file with a recording of another program.
#pragma once
#include "app/sources/recordings/folder_source.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace roomradar::test {

/// Writes the bytes to a file of this name and reads its first frames, then the last one. Depth, unit, cameras and
/// poses are compared with each other for files of an even size.
inline void read_foreign(const std::uint8_t* data, std::size_t size, const std::string& name) {
  constexpr int kMaxFrames = 6;
  const std::filesystem::path path = file_with(as_text(data, size), name);
  read_or_refuse([&] {
    SourceOptions options;
    options.input = std::make_shared<InputReport>();
    if (size % 2 == 0) options.questions = Questions::kDepth;
    const auto source = open_folder(path, options);
    Frame frame;
    for (int i = 0; i < kMaxFrames && source->next(frame).status != ReadStatus::kEnd; ++i) {
    }
    source->seek(*source->frame_count() - 1);
    (void)source->next(frame);
  });
}

}  // namespace roomradar::test
