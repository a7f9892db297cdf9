// frame_sinks.hpp: the outputs that a run writes per frame: video, pictures, CSV, trajectory, stream, results
// of a recorded session, comparison with a recorded session.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "app/cli/options/run_options.hpp"
#include "app/cli/session_folder.hpp"
#include "app/session/session.hpp"
#include "mapping/types/system/stage_times.hpp"

namespace roomradar {

/// A processed frame of a run, with the session's state after the frame.
struct RunFrame {
  std::int64_t run_frame = 0;  ///< index of the frame in the run, from 0
  double time_s = 0.0;         ///< time since the run's first frame
  const Frame& frame;
  const FrameResult& result;
  const Session& session;
  StageTimes& times;
};

enum class RunEnd {
  kNormal,          ///< also the end of an interrupted or failed run
  kNothingDropped,  ///< no object that the run was to drop or place was ever in the room
};

/// An output that gets every processed frame of a run.
class FrameSink {
 public:
  FrameSink() = default;
  FrameSink(const FrameSink&) = delete;
  FrameSink& operator=(const FrameSink&) = delete;
  virtual ~FrameSink() = default;

  /// Writes what the output contains of a frame. Throws Error if the frame cannot be written.
  virtual void write(const RunFrame& frame) = 0;
  /// Completes the output. Called once after the last frame, also if the run has failed. May print a message.
  /// Throws Error if the output is incomplete.
  virtual void finish(RunEnd /*end*/) {}
  /// Adds the output's entries to the results of a report. Called after finish(). May print a message.
  virtual void report(nlohmann::json& /*results*/) const {}
};

using FrameSinks = std::vector<std::unique_ptr<FrameSink>>;

// Each function opens an output, and returns null if the output was not requested. Throws Error if the output
// cannot be opened.

/// Hashes of each frame's result. Writes the hashes to `recorder`, and compares them with those of `check`.
/// @param recorder  null: the run is not recorded; otherwise must outlive the sink
/// @param check     nullopt: the run is no replay
std::unique_ptr<FrameSink> fingerprint_sink(SessionRecorder* recorder, std::optional<ReplayCheck> check);
/// --video. The file is created with the first picture. Deleted if nothing was dropped.
std::unique_ptr<FrameSink> video_sink(const RunOptions& options);
/// --frames-csv: the parts of map and depth that each localised frame used. The file is created with the
/// first localised frame.
std::unique_ptr<FrameSink> frame_use_sink(const RunOptions& options);
/// --trajectory: poses of the localised frames. The file is created with the first localised frame.
std::unique_ptr<FrameSink> trajectory_sink(const RunOptions& options);
/// --stream. The first line is written at once.
std::unique_ptr<FrameSink> stream_sink(const RunOptions& options);
/// --pictures: every n-th picture as a file. The folder is created at once.
std::unique_ptr<FrameSink> picture_sink(const RunOptions& options);
/// Objects that stay in the room: written every 2 s and at the end. Null, with a message, if the folder
/// cannot be written.
/// @param folder   empty: objects are not kept
/// @param session  must outlive the sink
std::unique_ptr<FrameSink> kept_objects_sink(const std::filesystem::path& folder, const Session& session);

}  // namespace roomradar
