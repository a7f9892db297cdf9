// frame_range.hpp: selection of a range of frames of a recording.
#pragma once
#include <cstdint>
#include <memory>
#include <string_view>

#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Frames first to last of a recording, both included, counted from 0.
struct FrameRange {
  std::int64_t first = 0;
  std::int64_t last = 0;
};

/// Parses "A:B", two integers with 0 <= A <= B. Otherwise throws Error that quotes `text` and gives an
/// example.
FrameRange parse_frame_range(std::string_view text);

/// Returns a source that delivers only frames first to last of `source`, with their original index and stamp.
/// Unreadable frames count too. Also works for sources of unknown length, since nothing is read ahead.
/// @throws Error with the number of frames if the range exceeds the recording: immediately if the length is
///         known, otherwise from next() at the premature end. Also throws unless 0 <= first <= last.
std::unique_ptr<FrameSource> limit_frames(std::unique_ptr<FrameSource> source, std::int64_t first,
                                          std::int64_t last);

}  // namespace roomradar
