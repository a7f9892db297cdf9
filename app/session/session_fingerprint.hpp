// session_fingerprint.hpp: what a frame of a session came to, in so few bytes that each frame's can be kept.
#pragma once
#include <cstdint>

namespace roomradar {

class Session;

/// What a frame came to.
struct FrameFingerprint {
  std::int64_t run_frame = 0;
  std::uint64_t objects = 0;  ///< names and poses, to the last bit, of those in the room
  std::uint64_t picture = 0;  ///< 0: none was made
};
FrameFingerprint fingerprint_of(std::int64_t run_frame, const Session& session);

}  // namespace roomradar
