// session_folder.hpp: records a run (session) in a folder and replays it. The folder contains:
//
//   session.json   format, settings, source, map
//   events.txt     every event, in the format of `--script`
//   frames/        the source's frames, bit-exact (SpooledSource)
//   meshes/        models of virtual objects with their textures, upright and scaled
//   results.txt    one line per frame: frame number, hash of the objects, hash of the rendered image
#pragma once
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/options/run_options.hpp"
#include "app/models/model.hpp"
#include "app/session/script/script.hpp"
#include "app/session/session_fingerprint.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Throws Error if no session can be recorded in the folder, because it exists and is not empty.
void require_can_become_session(const std::filesystem::path& folder);

/// Records a session during the run. The session of a killed run can be replayed up to its last recorded
/// frame.
class SessionRecorder {
 public:
  /// Creates the folder, or uses an empty one. Throws Error if it is not empty or cannot be written.
  /// @param map  the loaded map. Its checksum is recorded, so that a replay can detect a changed map
  /// @param are_calibrated  true if lens and depth errors were removed from the frames
  SessionRecorder(std::filesystem::path folder, const RunOptions& options, const MapInfo& map,
                  bool are_calibrated);

  /// Returns a source that delivers the frames of `source` and records them. The returned source can rewind.
  [[nodiscard]] std::unique_ptr<FrameSource> recorded(std::unique_ptr<FrameSource> source) const;
  /// Writes the model of an AddObject event into the folder, and returns the event with the copy's name. Does
  /// not write the built-in teapot. Returns other events unchanged. Call before the object is added to the
  /// session. Throws Error if the model cannot be written. Callers must then not add the object, so that all
  /// objects of the run are in the recording.
  /// @param model  the model loaded for the event
  ScriptEvent with_mesh_kept(ScriptEvent event, const Model& model);
  /// Records an event that was returned by with_mesh_kept() and is executed before frame `run_frame`. Throws
  /// Error if the event cannot be written.
  void write(ScriptEvent event, std::int64_t run_frame);
  /// Records the hashes of a frame's result.
  void write(const FrameFingerprint& fingerprint);

 private:
  std::filesystem::path folder_;
  std::ofstream events_, results_;
  int meshes_ = 0;
};

/// Returns true if the folder contains a recorded session.
bool is_session_folder(const std::filesystem::path& folder);
/// Returns true if lens and depth errors were removed from a session's frames before recording. Throws Error
/// naming the file and the fault if session.json is missing or invalid.
bool is_session_calibrated(const std::filesystem::path& folder);
/// Returns true if the file is the events file of a recorded session.
bool is_session_events(const std::filesystem::path& file);

/// Reads the events file of a recorded session. Ignores an incomplete last line. Completes events of sessions
/// recorded by older versions, so that objects get the same poses as in the recorded run. Throws Error as
/// read_script() does.
Script read_session_events(const std::filesystem::path& file);

/// Returns the options of a replay. They contain the folder as source, its events file as script, the
/// recorded map, and the recorded settings that affect results. Throws Error naming the file and the fault if
/// session.json is missing or invalid.
RunOptions read_session(const std::filesystem::path& folder);

/// Opens the recorded frames. Throws Error if there are none.
std::unique_ptr<FrameSource> open_session_frames(const std::filesystem::path& folder);

/// Returns a message if the map differs from the recorded one, otherwise an empty string.
std::string map_difference(const std::filesystem::path& folder, const MapInfo& map);

/// Compares the frames of a replay with the recorded results.
class ReplayCheck {
 public:
  explicit ReplayCheck(const std::filesystem::path& folder);
  /// Compares the next frame's hashes with the recorded hashes.
  void compare(const FrameFingerprint& fingerprint);

  /// Returns the number of compared frames that are equal to the recorded ones.
  [[nodiscard]] std::int64_t same() const { return same_; }
  /// Returns the number of compared frames that differ.
  [[nodiscard]] std::int64_t different() const { return different_; }
  /// Returns the number of recorded frames.
  [[nodiscard]] std::int64_t recorded() const { return static_cast<std::int64_t>(recorded_.size()); }
  /// Returns the number of the first frame that differs; -1 if there is none.
  [[nodiscard]] std::int64_t first_different() const { return first_different_; }
  /// Returns the frame number of the last recorded result; -1 if there is none.
  [[nodiscard]] std::int64_t last_frame() const {
    return recorded_.empty() ? -1 : recorded_.back().run_frame;
  }

 private:
  std::vector<FrameFingerprint> recorded_;
  std::size_t next_ = 0;
  std::int64_t same_ = 0, different_ = 0, first_different_ = -1;
};

}  // namespace roomradar
