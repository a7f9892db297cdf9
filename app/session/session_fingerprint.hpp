// session_fingerprint.hpp: hashes of a frame's result, to compare runs.
#pragma once
#include <cstdint>

namespace roomradar {

class Session;

/// Hashes of a frame's result; equal hashes in two runs show that the runs agree.
struct FrameFingerprint {
  std::int64_t run_frame = 0;
  std::uint64_t objects = 0;  ///< names and poses of the objects in the room, bit by bit
  std::uint64_t picture = 0;  ///< 0: no picture was made
};
FrameFingerprint fingerprint_of(std::int64_t run_frame, const Session& session);

}  // namespace roomradar
