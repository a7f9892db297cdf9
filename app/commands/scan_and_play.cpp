// scan_and_play.cpp: alternates scanning and playing, and derives the options of each part from the part
// before it.
#include "app/commands/scan_and_play.hpp"

#include <memory>
#include <optional>

#include "app/cli/options/object_options.hpp"
#include "app/commands/commands.hpp"

namespace roomradar {
namespace {

/// Returns the options of a run in the map of a scan, with the same camera.
RunOptions play_options(const PrescanOptions& options) {
  RunOptions play;
  play.source = options.source;
  play.map = options.map;
  play.calibration = options.calibration;
  play.objects = objects_of({});
  play.at_end = AtEnd::kStay;
  play.window = true;
  play.ui_scale = options.ui_scale;
  return play;
}

/// Returns the options of a scan that extends the map of a run, with the same camera.
PrescanOptions scan_options(const RunOptions& options, const std::optional<PlaceToScan>& look_at) {
  PrescanOptions scan;
  scan.source = options.source;
  scan.map = options.map;
  scan.calibration = options.calibration;
  scan.resume = true;
  scan.window = true;
  scan.look_at = look_at;
  scan.ui_scale = options.ui_scale;
  return scan;
}

/// Alternates until the user asks for neither.
/// @param scan  unset: begins with `play`
int run_in_turn(std::optional<PrescanOptions> scan, RunOptions play) {
  for (std::shared_ptr<void> window;;) {  // keeps the window open between two parts
    if (scan) {
      const ScanWindowResult scanned = scan_in_window(*scan);
      if (!scanned.wants_to_play) return scanned.status;
      window = scanned.window;
      play = play_options(*scan);
    }
    const PlayResult played = play_in_window(play);
    if (!played.window.wants_to_scan) return played.window.status;
    window = played.window.window;
    scan = scan_options(play, played.look_at);
  }
}

}  // namespace

int run(const PrescanOptions& options) { return options.window ? run_in_turn(options, {}) : scan(options); }

int run(const RunOptions& options) {
  return options.window ? run_in_turn(std::nullopt, options) : play(options);
}

}  // namespace roomradar
