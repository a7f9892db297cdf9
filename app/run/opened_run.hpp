// opened_run.hpp: all that a run has open from its first frame to its last.
#pragma once
#include <memory>
#include <optional>

#include "app/cli/interrupt.hpp"
#include "app/cli/report.hpp"
#include "app/cli/run_options.hpp"
#include "app/cli/session_folder.hpp"
#include "app/media/video_writer.hpp"
#include "app/run/run_budget.hpp"
#include "app/run/run_results.hpp"
#include "app/session/script.hpp"
#include "app/session/session.hpp"
#include "app/sources/recordings/playback_source.hpp"
#include "app/window/link/play_host.hpp"
#include "mapping/map/map_folder.hpp"

namespace roomradar {

struct OpenedRun {
  explicit OpenedRun(const RunCommand& of) : command(of) {}

  const RunCommand& command;
  Report report;
  Script script;
  SavedMap map;
  bool is_live = false;
  std::optional<SessionRecorder> recorder;  ///< --record-session
  std::optional<ReplayCheck> check;         ///< the source is a session that was recorded
  std::optional<std::int64_t> last_frame;   ///< none: to the end of the source, or until an event says quit
  std::optional<Interrupt> interrupt;
  std::unique_ptr<FrameSource> source;     ///< ends by Ctrl-C too
  PlaybackSource* playback = nullptr;      ///< within it
  std::unique_ptr<RunBudget> budget;       ///< --budget-ms
  std::unique_ptr<Session> session;        ///< with the script's objects loaded
  std::unique_ptr<VideoWriter> video;      ///< --video
  std::optional<FrameUseFile> frames_csv;  ///< --frames-csv
  std::optional<PlayHost> host;            ///< the window's
  RunTotals totals;
  bool was_quit = false;  ///< by an event, before the source's end
};

/// Opens what the command names, reads the map, makes the session. Throws Error where one of them cannot be,
/// before anything of it is played.
/// @param link  to the window; null: there is none
std::unique_ptr<OpenedRun> open_run(const RunCommand& command, UiChannel* link);

}  // namespace roomradar
