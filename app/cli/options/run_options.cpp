// run_options.cpp: option names, help texts and checks of `roomradar run`.
#include "app/cli/options/run_options.hpp"

#include <CLI/CLI.hpp>

#include "app/cli/options/option_checks.hpp"
#include "app/cli/options/quality_options.hpp"
#include "app/cli/options/shared_options.hpp"

namespace roomradar {
namespace {

void add_input_options(CLI::App& command, RunOptions& options) {
  add_source_argument(
      command, options.source,
      ",\nor the folder of a recorded session, replayed with its own settings unless given here");
  command
      .add_option("--map", options.map,
                  "folder of the saved map of a room, or of a building, of which only the tiles round the\n"
                  "camera are loaded; not modified (required unless SOURCE is a recorded session)")
      ->type_name("DIR");
  add_poses_option(
      command, options.poses,
      "localise the camera in the map, with the recording's poses, if any, as a prior on its motion\n"
      "(auto) or without them (tracked), or use the recording's poses (recorded)");
  add_frames_option(command, options.frames);
  add_calibration_option(command, options.calibration);
  add_input_options(command, options.input);
}

void add_world_options(CLI::App& command, RunOptions& options) {
  add_object_options(command, options.given_objects);
  command
      .add_option("--script", options.script, "events file (default: drop the objects over surfaces in view)")
      ->type_name("FILE");
  command
      .add_option(
          "--objects", options.kept_objects,
          "objects that stay in the room from run to run: those of the map (keep), of another folder, or\n"
          "none, which leaves the map's as they are; not in buildings and replays (default: keep)")
      ->type_name("keep|none|DIR");
  add_choice(command, "--surfaces", options.surfaces,
             {{"holes", SurfacePolicy::kHoles},
              {"skirt", SurfacePolicy::kSkirt},
              {"border", SurfacePolicy::kBorder},
              {"map", SurfacePolicy::kMap}},
             "surfaces that can be touched: this frame's pixels (holes), also with skirts across depth\n"
             "discontinuities (skirt), also with the image's border pushed outwards (border), or the map\n"
             "and the dynamic foreground (map)");
  add_choice(command, "--unknown", options.unknown_is_solid, {{"free", false}, {"solid", true}},
             "space that the prescan has not observed: objects are stopped (solid; needs --surfaces map) or\n"
             "fall through it (free; for tests of falling through) (default: solid with --surfaces map)");
  command
      .add_option(
          "--commit-changes", options.commit_after_s,
          "add objects to this run's copy of the map, or remove them, once observed unchanged for this\n"
          "many seconds; the saved map is not modified (default: only on commit events of the script)")
      ->check(within(0.5, 86400.0, "seconds"))
      ->type_name("SECONDS");
  command
      .add_option(
          "--save-map", options.save_map,
          "folder for the map with the committed changes; an existing map there is replaced, also if it is\n"
          "that of --map (default: not saved)")
      ->type_name("DIR");
}

void add_playback_options(CLI::App& command, RunOptions& options) {
  command.add_flag("--window", options.window,
                   "open a window: pick, drop, throw and rotate objects, and watch the radar's pictures\n"
                   "(default: off)");
  add_ui_scale_option(command, options.ui_scale);
  command
      .add_option("--record-session", options.record_session,
                  "folder for frames, events and settings; `run DIR` replays them with identical results\n"
                  "(default: not recorded)")
      ->type_name("DIR");
  add_choice(command, "--at-end", options.at_end,
             {{"end", AtEnd::kEnd}, {"stay", AtEnd::kStay}, {"loop", AtEnd::kLoop}},
             "after the last frame: stop (end), hold it (stay) or begin again (loop)\n"
             "(default: end; with --window: stay)");
}

void add_picture_options(CLI::App& command, RunOptions& options) {
  command
      .add_option("--video", options.video,
                  "write the composed pictures at their original speed as .mp4, .avi or .mkv, 30 per second\n"
                  "(default: not written)")
      ->type_name("FILE");
  command
      .add_option(
          "--pictures", options.pictures,
          "folder for composed pictures and masks of dynamic pixels as PNG, named by the source's frame\n"
          "number, followed by the run's if the frame is repeated (default: not written)")
      ->type_name("DIR");
  command
      .add_option("--pictures-stride", options.pictures_stride,
                  with_default("write pictures of every Nth frame", options.pictures_stride))
      ->check(whole_within(1, 1'000'000))
      ->type_name("N");
  command
      .add_option("--trajectory", options.trajectory,
                  "write the camera's pose in the map for each localised frame, in TUM's form\n"
                  "(default: not written)")
      ->type_name("FILE");
  command
      .add_option("--stream", options.stream,
                  "write a line of JSON per frame: camera, objects, contacts, dynamic surfaces, times;\n"
                  "a file, a named pipe, or - for standard output. A slow reader loses lines, and never\n"
                  "delays the run (default: not written)")
      ->type_name("FILE");
}

/// Adds the options that trade accuracy for time, and those that measure both.
void add_effort_options(CLI::App& command, RunOptions& options) {
  command
      .add_option(
          "--budget-ms", options.budget_ms,
          "time limit per frame; if there is more work, quality is reduced where this costs the least\n"
          "accuracy, with a message (default: no limit)")
      ->check(within(1.0, 10000.0, "milliseconds"))
      ->type_name("MS");
  command
      .add_option("--max-memory", options.max_memory_mb,
                  "in a building: load fewer tiles, and fewer keyframes for finding the camera, so that the\n"
                  "process stays below this many megabytes (default: no limit)")
      ->check(within(1.0, 1e7, "megabytes"))
      ->type_name("MB");
  add_preset_options(command, options.preset, options.presets);
  command
      .add_option("--frames-csv", options.frames_csv,
                  "write a line per frame: how much of room and depth was needed, and why\n"
                  "(default: not written)")
      ->type_name("FILE");
  add_run_quality_options(command, options.fixed);
  command.add_flag(
      "--verbose", options.verbose,
      "also say how much of the room and of the depth was drawn, tested and meshed (default: off)");
  add_report_option(command, options.report);
}

void require_consistent(const CLI::App& command, const RunOptions& options) {
  if (command.count("--object") > 0 && command.count("--script") > 0 && !options.window)
    throw CLI::ValidationError("--object: --script says which objects to add; add it there");
  for (const char* name : {"--object-size", "--object-up"})
    if (command.count(name) > 0 && command.count("--script") > 0 && !options.window)
      throw CLI::ValidationError(
          std::string(name) + ": --script says how objects are added; write 'add NAME MESH size M up AXIS'");
  if (command.count("--presets") > 0 && command.count("--preset") == 0 && !options.budget_ms)
    throw CLI::ValidationError(
        "--presets: used only with --preset NAME or --budget-ms, and neither is given");
  if (command.count("--pictures-stride") > 0 && options.pictures.empty())
    throw CLI::ValidationError("--pictures-stride: used only with --pictures, which is not given");
}

/// Takes a recorded session's settings, except those given on the command line.
void take_recorded_settings(const CLI::App& command, const RunOptions& recorded, RunOptions& options) {
  const auto is_given = [&](const char* name) { return command.count(name) > 0; };
  if (is_given("--calibration"))
    throw CLI::ValidationError(
        "--calibration: not allowed for a recorded session, which is replayed with its recorded frames");
  if (is_given("--frames"))
    throw CLI::ValidationError(
        "--frames: not allowed for a recorded session, which is replayed from its first frame");
  for (const char* name : {"--object", "--object-size", "--object-up"})
    if (is_given(name))
      throw CLI::ValidationError(std::string(name) +
                                 ": a recorded session has its own objects; use --script to replace them");
  if (!is_given("--map")) options.map = recorded.map;
  if (!is_given("--poses")) options.poses = recorded.poses;
  if (!is_given("--script")) options.script = recorded.script;
  if (!is_given("--surfaces")) options.surfaces = recorded.surfaces;
  if (!is_given("--unknown")) options.unknown_is_solid = recorded.unknown_is_solid;
  options.quality = recorded.quality;
  if (!is_given("--commit-changes")) options.commit_after_s = recorded.commit_after_s;
  if (!is_given("--at-end")) options.at_end = recorded.at_end;
}

}  // namespace

void add_options(CLI::App& command, RunOptions& options) {
  add_input_options(command, options);
  add_world_options(command, options);
  add_playback_options(command, options);
  add_picture_options(command, options);
  add_effort_options(command, options);
}

void complete_options(const CLI::App& command, RunOptions& options,
                      const ReadRecordedOptions& read_recorded) {
  if (options.window && command.count("--at-end") == 0) options.at_end = AtEnd::kStay;
  options.objects = objects_of(options.given_objects);
  require_consistent(command, options);
  if (const auto recorded = read_recorded(options.source))
    take_recorded_settings(command, *recorded, options);
  complete_quality(options.quality, options.preset, options.presets, options.fixed);
  if (options.map.empty())
    throw CLI::ValidationError("--map is missing: folder of a saved map; `roomradar prescan` makes one");
  if (command.count("--unknown") == 0 && options.surfaces != SurfacePolicy::kMap)
    options.unknown_is_solid = false;
  if (options.unknown_is_solid && options.surfaces != SurfacePolicy::kMap)
    throw CLI::ValidationError(
        "--unknown solid: needs --surfaces map, because only the map knows which space was observed");
}

void add_options(CLI::App& command, StartOptions& options) {
  command.add_option(
      "NAME", options.names,
      "saved map, recording or other source to choose in the window; may be repeated (default: none)");
  add_ui_scale_option(command, options.ui_scale);
}

}  // namespace roomradar
