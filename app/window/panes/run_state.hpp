// run_state.hpp: draws the state of the run and its frame time at the right end of the top bar.
#pragma once
#include "app/window/link/snapshot.hpp"
#include "app/window/link/ui_channel.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/panes/timing_pane.hpp"
#include "app/window/panes/window_layout.hpp"

namespace roomradar {

/// Draws a word for the state, such as loading, paused or tracked, at the right end of the bar. With two
/// rows, draws it at the left end of the second row.
/// @param silent_s  time since the newest frame
void draw_run_state(const Area& area, bool has_two_rows, const Snapshot& shown, const UiChannel& link,
                    double silent_s);

/// Draws the time of the last frame as a number and as a bar with marks at TimingPane::goal_ms() and
/// budget_ms().
/// @param speed  playback speed; 1: as recorded
void draw_frame_time(const Area& area, bool has_two_rows, const TimingPane& timing, double frames_per_s,
                     double speed, const look::Fonts& fonts);

}  // namespace roomradar
