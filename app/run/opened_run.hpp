// opened_run.hpp: everything that a run keeps open from its first frame to its last.
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

struct OpenedRun {
  explicit OpenedRun(const RunOptions& of) : options(of) {}

  const RunOptions& options;
  Report report;
  Script script;
  SavedMap map;
  bool is_live = false;
  std::optional<SessionRecorder> recorder;  ///< for --record-session
  std::optional<ReplayCheck> check;         ///< set if the source is a recorded session
  std::optional<std::int64_t> last_frame;   ///< none: until the source ends or a quit event
  std::optional<Interrupt> interrupt;
  std::unique_ptr<FrameSource> source;     ///< also ends on Ctrl-C
  PlaybackSource* playback = nullptr;      ///< part of source
  std::unique_ptr<RunBudget> budget;       ///< for --budget-ms
  std::unique_ptr<Session> session;        ///< with the script's objects loaded
  std::unique_ptr<VideoWriter> video;      ///< for --video
  std::optional<FrameUseFile> frames_csv;  ///< for --frames-csv
  std::optional<PlayHost> host;            ///< for the window
  RunTotals totals;
  bool was_quit = false;  ///< ended by an event
};

/// Opens everything that the command names, reads the map and creates the session. Throws Error if any of
/// this fails, before the first frame.
/// @param link  to the window; null: no window
std::unique_ptr<OpenedRun> open_run(const RunOptions& options, UiChannel* link);

}  // namespace roomradar
