// session_folder.hpp: a run as it was played, in a folder: its frames, its events, its settings, its results.
//
//   session.json   format, settings, source, map
//   events.txt     every event, as `--script` reads it
//   frames/        the source's frames, to the bit (SpooledSource)
//   meshes/        files of virtual objects
//   results.txt    a line a frame: number, fingerprint of the objects, fingerprint of the picture
#pragma once
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/run_options.hpp"
#include "app/session/script.hpp"
#include "app/session/session_fingerprint.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Throws Error if there is something in the folder already.
void require_can_become_session(const std::filesystem::path& folder);

/// Writes a session while it is played. What is written is whole lines at any moment, so that a run that was
/// killed replays to where it came.
class SessionRecorder {
 public:
  /// Makes the folder, or takes an empty one. Throws Error if it holds anything, or cannot be written.
  /// @param map  as it was loaded; its checksums tell later whether it is still the same
  /// @param are_calibrated  frames are freed of lens and depth errors
  SessionRecorder(std::filesystem::path folder, const RunCommand& command, const MapInfo& map,
                  bool are_calibrated);

  /// The source, which from now on is recorded as it is read, and can be read again.
  [[nodiscard]] std::unique_ptr<FrameSource> recorded(std::unique_ptr<FrameSource> source) const;
  /// The event, naming a copy of the mesh file where it adds an object. Before it is applied: throws Error if
  /// the file cannot be copied, and then there must be no object that the session knows nothing of.
  ScriptEvent with_mesh_kept(ScriptEvent event);
  /// An event, with its mesh kept, as it was applied before frame `run_frame`. Throws Error if the disk does
  /// not take it.
  void write(ScriptEvent event, std::int64_t run_frame);
  void write(const FrameFingerprint& fingerprint);

 private:
  std::filesystem::path folder_;
  std::ofstream events_, results_;
  int meshes_ = 0;
};

/// Whether a folder holds a recorded session.
bool is_session_folder(const std::filesystem::path& folder);
/// Whether a session's frames were freed of lens and depth errors before they were recorded. Throws Error
/// naming the file and the fault.
bool is_session_calibrated(const std::filesystem::path& folder);
/// Whether a file is the events of such a folder.
bool is_session_events(const std::filesystem::path& file);

/// The command that was recorded: source (the folder itself), map, script, and the settings that a session's
/// results depend on. Throws Error naming the file and the fault.
RunCommand read_session(const std::filesystem::path& folder);

/// The recorded frames. Throws Error if there are none.
std::unique_ptr<FrameSource> open_session_frames(const std::filesystem::path& folder);

/// Says by a sentence that the map is not as it was when the session was recorded; empty if it is.
std::string map_difference(const std::filesystem::path& folder, const MapInfo& map);

/// Compares a replay, frame by frame, with what was recorded.
class ReplayCheck {
 public:
  explicit ReplayCheck(const std::filesystem::path& folder);
  void compare(const FrameFingerprint& fingerprint);

  [[nodiscard]] std::int64_t same() const { return same_; }
  [[nodiscard]] std::int64_t different() const { return different_; }
  [[nodiscard]] std::int64_t recorded() const { return static_cast<std::int64_t>(recorded_.size()); }
  [[nodiscard]] std::int64_t first_different() const { return first_different_; }
  /// Of the run's frames, that of the last result that was recorded; -1 if there is none.
  [[nodiscard]] std::int64_t last_frame() const {
    return recorded_.empty() ? -1 : recorded_.back().run_frame;
  }

 private:
  std::vector<FrameFingerprint> recorded_;
  std::size_t next_ = 0;
  std::int64_t same_ = 0, different_ = 0, first_different_ = -1;
};

}  // namespace roomradar
