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

/// Parses "A:B", two integers with 0 <= A <= B. Throws Error, with `text` and an example, for any other text.
/// @param of  plural name of the things counted, for the error message
FrameRange parse_frame_range(std::string_view text, std::string_view of = "frames");

/// Returns a source that delivers only the frames `first` to `last` of `source`, with their original indices
/// and stamps. Unreadable frames are counted, too. Does not read ahead, so sources of unknown length are
/// accepted.
/// A source of unknown length, such as a device, may end within the range; then the range ends there.
/// @throws Error unless 0 <= first <= last, or if the range exceeds the recording. If the source's length is
///         unknown and it ends before the range begins, next() throws that error.
std::unique_ptr<FrameSource> limit_frames(std::unique_ptr<FrameSource> source, std::int64_t first,
                                          std::int64_t last);

}  // namespace roomradar
