// frame_range.hpp: the part of a recording that the user asked for.
#pragma once
#include <cstdint>
#include <memory>
#include <string_view>

#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Frames first..last of a recording, both of them included, counted from 0.
struct FrameRange {
  std::int64_t first = 0;
  std::int64_t last = 0;
};

/// Reads "A:B", two whole numbers with 0 <= A <= B. Throws Error that quotes `text` and gives an example
/// otherwise.
FrameRange parse_frame_range(std::string_view text);

/// Delivers only frames first..last of `source`, which keep their index and stamp; frames that cannot be read
/// are part of the count. Works on sources of unknown length too: nothing is read ahead.
/// @throws Error that says how many frames there are if the range leaves the recording: here where the length
/// is known, from next() once the end comes too early where it is not. Also if not 0 <= first <= last.
std::unique_ptr<FrameSource> limit_frames(std::unique_ptr<FrameSource> source, std::int64_t first,
                                          std::int64_t last);

}  // namespace roomradar
