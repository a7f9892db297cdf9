// session_folder.hpp: records a run in a folder and replays it: frames, events, settings and results.
//
//   session.json   format, settings, source, map
//   events.txt     every event, in the format of `--script`
//   frames/        the source's frames, bit by bit (SpooledSource)
//   meshes/        files of virtual objects
//   results.txt    a line per frame: number, fingerprint of the objects, fingerprint of the picture
#pragma once
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/options/run_options.hpp"
#include "app/session/script/script.hpp"
#include "app/session/session_fingerprint.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Throws Error if the folder exists and is not empty.
void require_can_become_session(const std::filesystem::path& folder);

/// Writes a session during the run. Files contain only whole lines at any time, so a killed run can be
/// replayed up to its last frame.
class SessionRecorder {
 public:
  /// Creates the folder, or uses an empty one. Throws Error if it is not empty or cannot be written.
  /// @param map  as loaded; its checksums show later whether the map has changed
  /// @param are_calibrated  lens and depth errors of the frames are corrected
  SessionRecorder(std::filesystem::path folder, const RunOptions& options, const MapInfo& map,
                  bool are_calibrated);

  /// Wraps a source so its frames are recorded as they are read and can be read again.
  [[nodiscard]] std::unique_ptr<FrameSource> recorded(std::unique_ptr<FrameSource> source) const;
  /// Copies the mesh file of a kAdd event to the folder and returns the event with the copy's name. Call
  /// before applying the event: if the copy fails, this throws Error, and the object must not be added
  /// without being recorded.
  ScriptEvent with_mesh_kept(ScriptEvent event);
  /// Records an event returned by with_mesh_kept() and applied before frame `run_frame`. Throws Error if the
  /// event cannot be written.
  void write(ScriptEvent event, std::int64_t run_frame);
  void write(const FrameFingerprint& fingerprint);

 private:
  std::filesystem::path folder_;
  std::ofstream events_, results_;
  int meshes_ = 0;
};

/// Returns true if a folder holds a recorded session.
bool is_session_folder(const std::filesystem::path& folder);
/// Returns true if a session's frames had their lens and depth errors corrected before recording. Throws
/// Error naming the file and the fault.
bool is_session_calibrated(const std::filesystem::path& folder);
/// Returns true if a file is the events file of a recorded session.
bool is_session_events(const std::filesystem::path& file);

/// Returns the recorded command: source (the folder itself), map, script, and the settings that affect
/// results. Throws Error naming the file and the fault.
RunOptions read_session(const std::filesystem::path& folder);

/// Opens the recorded frames. Throws Error if there are none.
std::unique_ptr<FrameSource> open_session_frames(const std::filesystem::path& folder);

/// Returns a sentence saying that the map has changed since the recording; empty if it has not.
std::string map_difference(const std::filesystem::path& folder, const MapInfo& map);

/// Compares the frames of a replay with the recorded results.
class ReplayCheck {
 public:
  explicit ReplayCheck(const std::filesystem::path& folder);
  void compare(const FrameFingerprint& fingerprint);

  [[nodiscard]] std::int64_t same() const { return same_; }
  [[nodiscard]] std::int64_t different() const { return different_; }
  [[nodiscard]] std::int64_t recorded() const { return static_cast<std::int64_t>(recorded_.size()); }
  [[nodiscard]] std::int64_t first_different() const { return first_different_; }
  /// Returns the run's frame number of the last recorded result; -1 if there is none.
  [[nodiscard]] std::int64_t last_frame() const {
    return recorded_.empty() ? -1 : recorded_.back().run_frame;
  }

 private:
  std::vector<FrameFingerprint> recorded_;
  std::size_t next_ = 0;
  std::int64_t same_ = 0, different_ = 0, first_different_ = -1;
};

}  // namespace roomradar
