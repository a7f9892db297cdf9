// prescan_options.cpp: option names, help texts and checks of `roomradar prescan`.
#include "app/cli/options/prescan_options.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>

#include "app/cli/options/input_options.hpp"
#include "app/cli/options/option_checks.hpp"
#include "app/cli/options/quality_options.hpp"
#include "app/cli/options/shared_options.hpp"

namespace roomradar {
namespace {

GivenUp parse_up(const std::string& text) {
  if (text == "camera") return {};
  std::array<double, 3> up{};
  int used = 0;
  const bool is_vector = std::sscanf(text.c_str(), "%lf,%lf,%lf%n", up.data(), &up[1], &up[2], &used) == 3 &&
                         static_cast<std::size_t>(used) == text.size();
  const Eigen::Vector3d direction(up[0], up[1], up[2]);
  if (!is_vector || !direction.allFinite() || !(direction.norm() > 1e-6))
    throw CLI::ValidationError("--up " + text + ": must be camera, or a direction X,Y,Z such as 0,-1,0");
  return {direction.normalized()};
}

/// The window, and what it does when the camera is lost.
void add_window_options(CLI::App& command, PrescanOptions& options) {
  command.add_flag("--window", options.window,
                   "open a window: watch the model grow, see what is known and what is wrong; pause, finish\n"
                   "(default: off)");
  add_choice<LostSignal>(
      command, "--lost-signal", options.lost_signal,
      {{"none", {false, false}}, {"flash", {true, false}}, {"bell", {false, true}}, {"both", {true, true}}},
      "what the window does when the camera is lost: the picture's frame flashes, the terminal's\n"
      "bell rings, or both");
}

/// What becomes part of the map.
void add_map_options(CLI::App& command, PrescanOptions& options) {
  command
      .add_option_function<std::string>(
          "--up", [&options](const std::string& text) { options.up = parse_up(text); },
          "up direction, also where the source measures gravity: X,Y,Z in the first camera's axes\n"
          "(x right, y down, z forward; with --poses recorded: the recording's), or camera: the cameras'\n"
          "mean upright (default: gravity, otherwise level surfaces)")
      ->type_name("X,Y,Z|camera");
  command
      .add_option(
          "--max-fused", options.max_fused,
          with_default(
              "fuse at most N frames, so that the map is ready sooner; of a longer scan, frames whose view\n"
              "hardly differs from the last fused one's are left out; 0: no limit",
              options.max_fused))
      ->check(whole_within(0, 1'000'000'000))
      ->type_name("N");
  command
      .add_option("--hold-out", options.hold_out,
                  "keep every Nth frame out of the map (i mod N = N/2) and score the mesh on them\n"
                  "(default: none)")
      ->check(whole_within(2, 1'000'000))
      ->type_name("N");
  add_choice<bool>(
      command, "--texture", options.texture, {{"on", true}, {"off", false}},
      "bake a texture of the room's surface from the best frames; takes some seconds and 0.2 GB, and\n"
      "is left out where --max-memory has no room for it");
}

/// How a scan ends early and is continued.
void add_interruption_options(CLI::App& command, PrescanOptions& options) {
  command.add_flag(
      "--resume", options.resume,
      "continue the interrupted scan of this map (DIR.unfinished); if there is none, extend the\n"
      "map in DIR with the frames of SOURCE (default: off)");
  command.add_flag("--replace", options.replace,
                   "replace the map in DIR by this scan; the present one stays as an earlier revision, see\n"
                   "`roomradar map log` (default: off: an existing map is not replaced)");
  command
      .add_option(
          "--checkpoint-every", options.checkpoint_every_s,
          with_default(
              "seconds between checkpoints, 24 times as long while frames are fused; 0: none, so the scan "
              "cannot be resumed",
              options.checkpoint_every_s))
      ->check(within(0.0, 86400.0, "seconds"))
      ->type_name("S");
  command
      .add_option(
          "--max-memory", options.max_memory_mb,
          "stop before the process exceeds this many megabytes; the frames fused so far are saved as a\n"
          "complete map (a map being extended is not changed), and the exit status is 1\n"
          "(default: no limit)")
      ->check(within(1.0, 1e7, "megabytes"))
      ->type_name("MB");
}

}  // namespace

// The order of the calls is that of the help.
void add_options(CLI::App& command, PrescanOptions& options) {
  add_source_argument(command, options.source);
  command
      .add_option("--map", options.map, "folder for the map; an existing map there is replaced (required)")
      ->required()
      ->type_name("DIR");
  add_window_options(command, options);
  add_poses_option(
      command, options.poses,
      "estimate the camera poses, with those of the recording, if any, as a prior on the motion that\n"
      "depth verifies (auto) or without them (tracked), or use those of the recording (recorded)");
  add_frames_option(command, options.frames);
  add_calibration_option(command, options.calibration);
  add_input_options(command, options.input);
  add_map_options(command, options);
  add_interruption_options(command, options);
  add_ui_scale_option(command, options.ui_scale);
  add_preset_options(command, options.preset, options.presets);
  add_scan_quality_options(command, options.fixed);
  command
      .add_option("--trajectory", options.trajectory,
                  "also write the camera's poses in the map, in TUM's form, to this file\n"
                  "(default: only to trajectory.txt in the map)")
      ->type_name("FILE");
  add_report_option(command, options.report);
}

void complete_options(const CLI::App& command, PrescanOptions& options) {
  if (command.count("--presets") > 0 && command.count("--preset") == 0)
    throw CLI::ValidationError("--presets: used only with --preset NAME, which is not given");
  if (command.count("--lost-signal") > 0 && !options.window)
    throw CLI::ValidationError("--lost-signal: a signal of --window, which is not given");
  if (options.lost_signal.rings && isatty(STDERR_FILENO) == 0)
    throw CLI::ValidationError(
        "--lost-signal: the bell is that of the terminal, but stderr is not one; use flash");
  complete_quality(options.quality, options.preset, options.presets, options.fixed);
}

}  // namespace roomradar
