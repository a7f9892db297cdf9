// session_fingerprint.hpp: hashes of a frame's result, to compare runs.
#pragma once
#include <cstdint>

namespace roomradar {

class Session;

/// Equal hashes in two runs indicate equal results.
struct FrameFingerprint {
  std::int64_t run_frame = 0;
  std::uint64_t objects = 0;  ///< hash of names and poses (all bits) of the objects in the room
  std::uint64_t picture = 0;  ///< hash of the picture's pixels; 0: no picture was made
};
FrameFingerprint fingerprint_of(std::int64_t run_frame, const Session& session);

}  // namespace roomradar
