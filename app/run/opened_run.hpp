// opened_run.hpp: inputs, outputs and state of a run, opened before its first frame.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "app/cli/input_lines.hpp"
#include "app/cli/interrupt.hpp"
#include "app/cli/options/run_options.hpp"
#include "app/cli/report.hpp"
#include "app/cli/session_folder.hpp"
#include "app/run/frame_sinks.hpp"
#include "app/run/run_budget.hpp"
#include "app/run/run_results.hpp"
#include "app/session/script/script.hpp"
#include "app/session/session.hpp"
#include "app/sources/recordings/playback_source.hpp"
#include "app/window/link/play_host.hpp"
#include "mapping/map/map_folder.hpp"

namespace roomradar {

struct OpenedRun {
  explicit OpenedRun(const RunOptions& of) : options(of) {}

  const RunOptions& options;
  Report report;
  Script script;
  SavedMap map;
  bool is_live = false;
  /// True if the source is a recorded session.
  bool is_replay = false;
  /// Records events and frames; set with --record-session.
  std::optional<SessionRecorder> recorder;
  /// Last frame to process, counted from the run's first one; unset if the run ends with the source or with a
  /// quit event.
  std::optional<std::int64_t> last_frame;
  std::optional<Interrupt> interrupt;
  std::shared_ptr<InputReport> input = std::make_shared<InputReport>();
  std::optional<InputLines> input_lines;
  /// Ends at the recording's end or on Ctrl-C.
  std::unique_ptr<FrameSource> source;
  /// The part of `source` that executes camera commands such as hold and rewind. Owned by `source`.
  PlaybackSource* playback = nullptr;
  std::unique_ptr<RunBudget> budget;  ///< set with --budget-ms
  /// The AR session, with the script's objects loaded.
  std::unique_ptr<Session> session;
  /// The requested outputs, in the order in which a frame is written.
  FrameSinks sinks;
  /// Connection to the window; unset if there is no window.
  std::optional<PlayHost> host;
  RunTotals totals;
  /// True if an event ended the run.
  bool was_quit = false;
  /// Set after the last frame: the reason if every drop and placement failed; else empty.
  std::string nothing_dropped;
};

/// Opens all inputs and outputs named in the options, reads the map, and creates the session. Only checks
/// that the report can be written.
/// @param options  must outlive the result
/// @param link  connection to the window; null if there is no window
/// @throws Error if an input, an output, the map or the session cannot be opened
std::unique_ptr<OpenedRun> open_run(const RunOptions& options, UiChannel* link);

}  // namespace roomradar
