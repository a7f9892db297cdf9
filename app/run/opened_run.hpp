// opened_run.hpp: inputs, outputs and state of a run, opened before its first frame.
#pragma once
#include <memory>
#include <optional>

#include "app/cli/interrupt.hpp"
#include "app/cli/options/run_options.hpp"
#include "app/cli/report.hpp"
#include "app/cli/session_folder.hpp"
#include "app/media/video_writer.hpp"
#include "app/run/run_budget.hpp"
#include "app/run/run_results.hpp"
#include "app/session/script/script.hpp"
#include "app/session/session.hpp"
#include "app/sources/recordings/playback_source.hpp"
#include "app/window/link/play_host.hpp"
#include "mapping/map/map_folder.hpp"

namespace roomradar {

/// Options, inputs, outputs and state of a run.
struct OpenedRun {
  explicit OpenedRun(const RunOptions& of) : options(of) {}

  const RunOptions& options;
  Report report;
  Script script;
  SavedMap map;
  bool is_live = false;
  /// Set for --record-session.
  std::optional<SessionRecorder> recorder;
  /// Set if the source is a recorded session.
  std::optional<ReplayCheck> check;
  /// Last frame to process; unset if the run ends with the source or with a quit event.
  std::optional<std::int64_t> last_frame;
  std::optional<Interrupt> interrupt;
  /// Frame source; also ends on Ctrl-C.
  std::unique_ptr<FrameSource> source;
  /// The playback wrapper inside `source`.
  PlaybackSource* playback = nullptr;
  /// Set for --budget-ms.
  std::unique_ptr<RunBudget> budget;
  /// The AR session, with the script's objects loaded.
  std::unique_ptr<Session> session;
  /// Set for --video.
  std::unique_ptr<VideoWriter> video;
  /// Set for --frames-csv.
  std::optional<FrameUseFile> frames_csv;
  /// Connection to the window; unset if there is no window.
  std::optional<PlayHost> host;
  RunTotals totals;
  /// True if an event ended the run.
  bool was_quit = false;
};

/// Opens all inputs and outputs that the options name, reads the map and creates the session.
/// @param link  connection to the window; null if there is no window
/// @throws Error if any of this fails, before the first frame
std::unique_ptr<OpenedRun> open_run(const RunOptions& options, UiChannel* link);

}  // namespace roomradar
