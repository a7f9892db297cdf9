// command_line.cpp: defines the commands, their arguments and their help.
#include "app/commands/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <type_traits>

#include "app/cli/manual_page.hpp"
#include "app/cli/session_folder.hpp"
#include "app/commands/commands.hpp"
#include "app/quality/presets.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/version.hpp"

namespace roomradar {
namespace {

constexpr char kSourceHelp[] =
    "source of frames: kinect:N[?depth=raw|mm|registered], sim:ROOM[?seed=N&...], or a folder with a\n"
    "recording (7-Scenes, TUM RGB-D, fakenect, or numbered color/ and depth/); kinect:N continues\n"
    "until Ctrl-C (required)";

const std::map<std::string, PoseOrigin> kPoses = {{"tracked", PoseOrigin::kTracked},
                                                  {"recorded", PoseOrigin::kRecorded}};
const std::map<std::string, SurfacePolicy> kSurfaces = {{"holes", SurfacePolicy::kHoles},
                                                        {"skirt", SurfacePolicy::kSkirt},
                                                        {"border", SurfacePolicy::kBorder},
                                                        {"map", SurfacePolicy::kMap}};
const std::map<std::string, bool> kUnknownIsSolid = {{"free", false}, {"solid", true}};
const std::map<std::string, AtEnd> kAtEnd = {
    {"end", AtEnd::kEnd}, {"stay", AtEnd::kStay}, {"loop", AtEnd::kLoop}};
const std::map<std::string, RecordingFormat> kFormats = {{"tum", RecordingFormat::kTum},
                                                         {"7scenes", RecordingFormat::kSevenScenes},
                                                         {"fakenect", RecordingFormat::kFakenect}};

void add_frames_option(CLI::App& app, std::optional<FrameRange>& frames) {
  app.add_option_function<std::string>(
         "--frames",
         [&frames](const std::string& text) {
           try {
             frames = parse_frame_range(text);
           } catch (const Error& error) {
             throw CLI::ValidationError(error.what());
           }
         },
         "use only frames A to B, inclusive, counted from 0 (default: all)")
      ->type_name("A:B");
}

void add_calibration_option(CLI::App& app, std::string& calibration) {
  app.add_option("--calibration", calibration,
                 "cameras and their errors, as written by `roomradar calibrate`\n"
                 "(default: calibration.json in SOURCE, otherwise the cameras that SOURCE describes)")
      ->type_name("FILE");
}

void add_report_option(CLI::App& app, std::string& report) {
  app.add_option("--report", report,
                 "write settings, times, memory and results as JSON (default: not written)")
      ->type_name("FILE");
}

/// Adds an option with one of several words as its value. CLI11's own transformer would list the values as
/// numbers.
template <typename Value>
void add_choice(CLI::App& app, const std::string& name, Value& value,
                const std::map<std::string, Value>& choices, const std::string& help) {
  std::string type;
  for (const auto& [word, meaning] : choices) type += (type.empty() ? "" : "|") + word;
  app.add_option_function<std::string>(
         name,
         [&value, &choices, name, type](const std::string& word) {
           const auto found = choices.find(word);
           if (found == choices.end()) throw CLI::ValidationError(name + " " + word + ": must be " + type);
           value = found->second;
         },
         help)
      ->type_name(type);
}

/// Adds one option per field of the quality. Values go to `fixed` first, and into the quality once all other
/// arguments are known.
template <typename Quality>
void add_quality_options(CLI::App& app, const Quality& defaults, FieldWords& fixed) {
  visit_fields(defaults, [&](const QualityField& field, const auto& /*value*/) {
    app.add_option_function<std::string>(
           field.option,
           [&fixed, field](const std::string& word) {
             try {
               Quality scratch;
               set_field(scratch, field.name, word);
             } catch (const Error& error) {
               throw CLI::ValidationError(std::string(field.option) + " " + word, error.what());
             }
             fixed.emplace_back(field.name, word);
           },
           field.help)
        ->type_name(field.unit);
  });
}

void add_preset_options(CLI::App& app, std::string& preset, std::string& presets) {
  app.add_option("--preset", preset,
                 "measured settings: fast, balanced or accurate; settings given by their own options take\n"
                 "precedence (default: none)")
      ->type_name("NAME");
  app.add_option("--presets", presets,
                 "presets file, as written by `roomradar trade` (default: the program's own)")
      ->type_name("FILE");
}

/// Sets the quality to the named preset's, if any, then applies the options' values.
template <typename Command>
void settle_quality(Command& command) {
  if (!command.preset.empty()) {
    const std::filesystem::path path = presets_file(command.presets);
    const Presets presets = read_presets(path);
    const Preset& preset = preset_named(presets, command.preset, path.string());
    if constexpr (std::is_same_v<decltype(command.quality), ScanQuality>)
      command.quality = preset.scan;
    else
      command.quality = preset.run;
  }
  set_fields(command.quality, command.fixed);
}

/// Range check that rejects "nan", unlike CLI11's own Range.
CLI::Validator within(double low, double high, const std::string& unit) {
  return CLI::Validator(
      [low, high, unit](const std::string& text) -> std::string {
        double value = 0.0;
        if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return {};
        char rule[80];
        std::snprintf(rule, sizeof rule, "must be within %.10g and %.10g", low, high);
        return std::string(rule) + " (" + unit + "), not " + text;
      },
      "", "within");
}

/// Arguments of all commands; CLI11 writes into these while parsing.
struct Arguments {
  PrescanCommand prescan;
  RunCommand run;
  MapInfoCommand map_info;
  MapVerifyCommand map_verify;
  MapExportCommand map_export;
  MapMergeCommand map_merge;
  MapDiffCommand map_diff;
  SimulateCommand simulate;
  RecordCommand record;
  CalibrateCommand calibrate;
  FallthroughCommand fallthrough;
  TradeCommand trade;
};

void add_prescan(CLI::App& app, PrescanCommand& command, std::function<int()>& work) {
  CLI::App* sub = app.add_subcommand("prescan", "scan a room and save it as a map");
  sub->add_option("SOURCE", command.source, kSourceHelp)->required();
  sub->add_option("--map", command.map, "folder for the map; an existing map there is replaced (required)")
      ->required()
      ->type_name("DIR");
  add_choice(*sub, "--poses", command.poses, kPoses,
             "estimate the camera poses (tracked), or use those of the recording (recorded)\n"
             "(default: tracked)");
  add_frames_option(*sub, command.frames);
  add_calibration_option(*sub, command.calibration);
  sub->add_option("--hold-out", command.hold_out,
                  "keep every Nth frame out of the map (i mod N = N/2) and score the mesh on them\n"
                  "(default: none)")
      ->check(CLI::Range(std::int64_t{2}, std::int64_t{1'000'000}))
      ->type_name("N");
  sub->add_flag("--resume", command.resume,
                "continue the interrupted scan of this map (DIR.unfinished); if there is none, extend the\n"
                "map in DIR with the frames of SOURCE (default: off)");
  sub->add_option("--checkpoint-every", command.checkpoint_every_s,
                  "seconds between checkpoints; 0: none, so the scan cannot be resumed (default: 2.5)")
      ->check(within(0.0, 86400.0, "seconds"))
      ->type_name("S");
  sub->add_option(
         "--max-memory", command.max_memory_mb,
         "stop before the process exceeds this many megabytes; the frames fused so far are saved as a\n"
         "complete map (a map being extended is not changed), and the exit status is 1\n"
         "(default: no limit)")
      ->check(within(1.0, 1e7, "megabytes"))
      ->type_name("MB");
  add_preset_options(*sub, command.preset, command.presets);
  add_quality_options(*sub, command.quality, command.fixed);
  add_report_option(*sub, command.report);
  sub->callback([&, sub] {
    if (sub->count("--presets") > 0 && sub->count("--preset") == 0)
      throw CLI::ValidationError("--presets: used only with --preset NAME, which is not given");
    settle_quality(command);
    work = [&command] { return run(command); };
  });
}

/// Takes a recorded session's settings, except those given on the command line.
void take_recorded_settings(RunCommand& command, const CLI::App& sub) {
  const RunCommand recorded = read_session(command.source);
  const auto is_given = [&](const char* name) { return sub.count(name) > 0; };
  if (is_given("--calibration"))
    throw CLI::ValidationError(
        "--calibration: not allowed for a recorded session, which is replayed with its recorded frames");
  if (is_given("--frames"))
    throw CLI::ValidationError(
        "--frames: not allowed for a recorded session, which is replayed from its first frame");
  if (is_given("--object"))
    throw CLI::ValidationError(
        "--object: a recorded session has its own objects; use --script to replace them");
  if (!is_given("--map")) command.map = recorded.map;
  if (!is_given("--poses")) command.poses = recorded.poses;
  if (!is_given("--script")) command.script = recorded.script;
  if (!is_given("--surfaces")) command.surfaces = recorded.surfaces;
  if (!is_given("--unknown")) command.unknown_is_solid = recorded.unknown_is_solid;
  command.quality = recorded.quality;
  if (!is_given("--adopt")) command.commit_after_s = recorded.commit_after_s;
  if (!is_given("--at-end")) command.at_end = recorded.at_end;
}

void add_run(CLI::App& app, RunCommand& command, std::function<int()>& work) {
  CLI::App* sub = app.add_subcommand("run", "run augmented reality in a saved map");
  sub->add_option(
         "SOURCE", command.source,
         std::string(
             "session recorded by --record-session, replayed from its first frame with its own settings\n"
             "unless given here; or ") +
             kSourceHelp)
      ->required();
  sub->add_option("--map", command.map,
                  "folder of the saved map; not modified (required unless SOURCE is a recorded session)")
      ->type_name("DIR");
  add_choice(*sub, "--poses", command.poses, kPoses,
             "localise the camera in the map (tracked), or use the recording's poses (recorded)\n"
             "(default: tracked)");
  add_frames_option(*sub, command.frames);
  add_calibration_option(*sub, command.calibration);
  sub->add_option("--object", command.object,
                  "virtual object: teapot (built in) or a mesh file (default: teapot)")
      ->type_name("MESH");
  sub->add_option("--script", command.script, "events file (default: drop the object over a surface in view)")
      ->type_name("FILE");
  add_choice(*sub, "--surfaces", command.surfaces, kSurfaces,
             "surfaces that can be touched: this frame's pixels (holes), also with skirts across depth\n"
             "discontinuities (skirt), also with the image's border pushed outwards (border), or the map\n"
             "and the dynamic foreground (map) (default: map)");
  add_choice(*sub, "--unknown", command.unknown_is_solid, kUnknownIsSolid,
             "space that the prescan has not observed: objects pass (free) or are stopped (solid; needs\n"
             "--surfaces map) (default: free)");
  sub->add_option(
         "--adopt", command.commit_after_s,
         "add objects to this run's copy of the map, or remove them, once observed unchanged for this\n"
         "many seconds; the saved map is not modified (default: only on adopt events of the script)")
      ->check(within(0.5, 86400.0, "seconds"))
      ->type_name("SECONDS");
  sub->add_option(
         "--save-map", command.save_map,
         "folder for the map with the adopted changes; an existing map there is replaced, also if it is\n"
         "that of --map (default: not saved)")
      ->type_name("DIR");
  sub->add_flag("--window", command.window,
                "open a window: pick, drop, throw and rotate objects, and watch the radar's pictures\n"
                "(default: off)");
  sub->add_option("--record-session", command.record_session,
                  "folder for frames, events and settings; `run DIR` replays them with identical results\n"
                  "(default: not recorded)")
      ->type_name("DIR");
  add_choice(*sub, "--at-end", command.at_end, kAtEnd,
             "after the last frame: stop (end), hold it (stay) or begin again (loop)\n"
             "(default: end; with --window: stay)");
  sub->add_option("--video", command.video,
                  "write the composed pictures at their original speed as .mp4, .avi or .mkv, 30 per second\n"
                  "(default: not written)")
      ->type_name("FILE");
  sub->add_option(
         "--pictures", command.pictures,
         "folder for composed pictures and masks of dynamic pixels as PNG, named by the source's frame\n"
         "number, followed by the run's if the frame is repeated (default: not written)")
      ->type_name("DIR");
  sub->add_option("--pictures-every", command.pictures_every,
                  "write pictures of every Nth frame (default: 10)")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000}))
      ->type_name("N");
  sub->add_option(
         "--budget-ms", command.budget_ms,
         "time limit per frame; if there is more work, quality is reduced where this costs the least\n"
         "accuracy, with a message (default: no limit)")
      ->check(within(1.0, 10000.0, "milliseconds"))
      ->type_name("MS");
  add_preset_options(*sub, command.preset, command.presets);
  sub->add_option("--frames-csv", command.frames_csv,
                  "write a line per frame: how much of room and depth was needed, and why\n"
                  "(default: not written)")
      ->type_name("FILE");
  add_quality_options(*sub, command.quality, command.fixed);
  add_report_option(*sub, command.report);
  sub->callback([&, sub] {
    if (command.window && sub->count("--at-end") == 0) command.at_end = AtEnd::kStay;
    if (sub->count("--object") > 0 && sub->count("--script") > 0 && !command.window)
      throw CLI::ValidationError("--object: --script says which objects to add; add it there");
    if (sub->count("--presets") > 0 && sub->count("--preset") == 0 && !command.budget_ms)
      throw CLI::ValidationError(
          "--presets: used only with --preset NAME or --budget-ms, and neither is given");
    if (sub->count("--pictures-every") > 0 && command.pictures.empty())
      throw CLI::ValidationError("--pictures-every: used only with --pictures, which is not given");
    if (is_session_folder(command.source)) take_recorded_settings(command, *sub);
    settle_quality(command);
    if (command.map.empty()) throw CLI::RequiredError("--map");
    if (command.unknown_is_solid && command.surfaces != SurfacePolicy::kMap)
      throw CLI::ValidationError(
          "--unknown solid: needs --surfaces map, because only the map knows which space was observed");
    work = [&command] { return run(command); };
  });
}

void add_map(CLI::App& app, Arguments& arguments, std::function<int()>& work) {
  CLI::App* sub = app.add_subcommand("map", "describe, verify, export, merge or compare saved maps");
  sub->require_subcommand(1);
  CLI::App* info = sub->add_subcommand("info", "describe a map");
  info->add_option("DIR", arguments.map_info.map, "folder of the map (required)")->required();
  info->callback([&] { work = [&arguments] { return run(arguments.map_info); }; });
  CLI::App* verify =
      sub->add_subcommand("verify", "check every file against its checksum; exit status 1 if one differs");
  verify->add_option("DIR", arguments.map_verify.map, "folder of the map (required)")->required();
  verify->callback([&] { work = [&arguments] { return run(arguments.map_verify); }; });
  CLI::App* to_file = sub->add_subcommand("export", "write the octree or the mesh for other programs");
  to_file->add_option("DIR", arguments.map_export.map, "folder of the map (required)")->required();
  to_file
      ->add_option("FILE", arguments.map_export.path,
                   "file to write, by extension: .ot .bt (octree), .ply .obj .stl .glb (mesh) (required)")
      ->required();
  to_file->add_flag("--unknown", arguments.map_export.unknown,
                    "write the border of unknown space instead of the room's mesh (default: off)");
  to_file->callback([&] { work = [&arguments] { return run(arguments.map_export); }; });
  CLI::App* merge = sub->add_subcommand(
      "merge",
      "merge two overlapping maps of one room; B is registered to A by common views and by surfaces,\n"
      "and rejected if the registration is not reliable");
  merge->add_option("A", arguments.map_merge.a, "map whose world frame is kept (required)")->required();
  merge->add_option("B", arguments.map_merge.b, "map to add; the finer resolution of both is used (required)")
      ->required();
  merge->add_option("--map", arguments.map_merge.map, "folder for the merged map (required)")
      ->required()
      ->type_name("DIR");
  merge
      ->add_option("--deviation", arguments.map_merge.deviation_m,
                   "max distance of the simplified mesh from the full mesh, metres; 0 keeps all triangles\n"
                   "(default: as for A)")
      ->check(within(0.0, 1.0, "metres"))
      ->type_name("M");
  add_report_option(*merge, arguments.map_merge.report);
  merge->callback([&] { work = [&arguments] { return run(arguments.map_merge); }; });
  CLI::App* diff = sub->add_subcommand(
      "diff", "list what appeared in B and what vanished since A, where both have data, in A's world");
  diff->add_option("A", arguments.map_diff.a, "earlier map (required)")->required();
  diff->add_option("B", arguments.map_diff.b, "later map (required)")->required();
  add_report_option(*diff, arguments.map_diff.report);
  diff->add_option("--picture", arguments.map_diff.picture,
                   "draw A, with appeared parts in green and vanished parts in red (default: not written)")
      ->type_name("FILE.png");
  diff->callback([&] { work = [&arguments] { return run(arguments.map_diff); }; });
}

void add_simulate(CLI::App& app, SimulateCommand& command, std::function<int()>& work) {
  CLI::App* sub = app.add_subcommand("simulate", "record a simulated Kinect, with ground truth");
  sub->add_option("DIR", command.folder, "folder to write; must be empty or not exist (required)")
      ->required();
  sub->add_option("--room", command.room, "table, shelf, wall, random or board (default: table)")
      ->type_name("NAME");
  sub->add_option("--seed", command.seed,
                  "seed of the camera's path, the noise and the furniture of a random room (default: 1)")
      ->type_name("N");
  sub->add_option("--frames", command.frames, "number of frames (default: 300)")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000}))
      ->type_name("N");
  sub->add_option(
         "--path", command.path,
         "camera path: scan (round the room), view (looking at its focus) or swing (in front of the\n"
         "board) (default: scan)")
      ->type_name("KIND");
  sub->add_option("--moving", command.moving,
                  "moving things, separated by commas: hand, ball, person (default: none)")
      ->type_name("LIST");
  add_choice(*sub, "--format", command.format, kFormats, "format of the recording (default: tum)");
  sub->callback([&] { work = [&command] { return run(command); }; });
}

void add_record(CLI::App& app, RecordCommand& command, std::function<int()>& work) {
  CLI::App* sub = app.add_subcommand("record", "write a source's frames as a recording");
  sub->add_option("SOURCE", command.source, kSourceHelp)->required();
  sub->add_option("DIR", command.folder, "folder to write; must be empty or not exist (required)")
      ->required();
  add_frames_option(*sub, command.frames);
  add_calibration_option(*sub, command.calibration);
  add_choice(*sub, "--format", command.format, kFormats, "format of the recording (default: tum)");
  sub->callback([&] { work = [&command] { return run(command); }; });
}

void add_calibrate(CLI::App& app, CalibrateCommand& command, std::function<int()>& work) {
  CLI::App* sub = app.add_subcommand(
      "calibrate",
      "estimate both cameras, their lenses, their relative pose and the depth's errors from a\n"
      "recording of a checkerboard that is held still in 20 or more places: near, far, tilted, in\n"
      "every part of the image");
  sub->add_option("SOURCE", command.source, kSourceHelp)->required();
  sub->add_option("--out", command.calibration,
                  "file to write, for --calibration of other commands (required)")
      ->required()
      ->type_name("FILE");
  sub->add_option("--columns", command.board.columns,
                  "inner corners along the board's longer side (default: 8)")
      ->type_name("N");
  sub->add_option("--rows", command.board.rows, "inner corners along the shorter side (default: 6)")
      ->type_name("N");
  sub->add_option("--square", command.board.square_m, "side of a square, metres (default: 0.03)")
      ->type_name("M");
  add_frames_option(*sub, command.frames);
  sub->add_option("--plot", command.plot,
                  "draw the views of the board, and the errors before and after (default: not written)")
      ->type_name("FILE.png");
  add_report_option(*sub, command.report);
  sub->callback([&] { work = [&command] { return run(command); }; });
}

void add_fallthrough(CLI::App& app, FallthroughCommand& command, std::function<int()>& work) {
  CLI::App* sub = app.add_subcommand(
      "fallthrough",
      "drop and push objects behind occluders under each surface policy, and compare with simulated\n"
      "ground truth. With a SOURCE: drop a ball over each cell of a grid in its map, with the\n"
      "surfaces of one frame");
  sub->add_option("SOURCE", command.source,
                  "recording of the room of --map; its first frame is used (default: simulated rooms)");
  sub->add_option("--map", command.map, "map of SOURCE's room (required with SOURCE)")->type_name("DIR");
  sub->add_option("--reference", command.reference,
                  "map whose surface is the ground truth (default: the one of --map)")
      ->type_name("DIR");
  add_choice(*sub, "--poses", command.poses, kPoses,
             "localise the frame's camera in the map (tracked), or use the recording's pose (recorded)\n"
             "(default: tracked)");
  add_frames_option(*sub, command.frames);
  add_calibration_option(*sub, command.calibration);
  sub->add_option("--cell", command.cell_m, "edge of the grid's cells, metres (default: 0.1)")
      ->check(within(0.01, 10.0, "metres"))
      ->type_name("M");
  sub->add_option("--picture", command.picture,
                  "draw a plan of the surfaces that the balls rest on (default: not written)")
      ->type_name("FILE.png");
  sub->add_option("--scenarios", command.scenarios, "number of scenarios (default: 200)")
      ->check(CLI::Range(1, 1'000'000))
      ->type_name("N");
  sub->add_option("--seed", command.seed, "seed of the scenarios (default: 1)")->type_name("N");
  sub->add_option("--random-rooms", command.random_rooms,
                  "number of randomly furnished rooms, in addition to table, shelf and wall (default: 3)")
      ->check(CLI::Range(0, 1000))
      ->type_name("N");
  sub->add_option("--threads", command.threads,
                  "threads for scanning rooms and preparing scenarios (default: all processors)")
      ->check(CLI::Range(1, 256))
      ->type_name("N");
  sub->add_option("--maps", command.maps,
                  "folder in which the rooms' maps are stored and reused (default: not stored)")
      ->type_name("DIR");
  sub->add_option("--csv", command.csv, "write a line per scenario and policy (default: not written)")
      ->type_name("FILE");
  sub->add_option("--html", command.html,
                  "write a page with tables, plots and pictures of failures (default: not written)")
      ->type_name("FILE");
  CLI::Option* one = sub->add_option("--scenario", command.scenario,
                                     "replay only this scenario, as a video (default: run all)")
                         ->check(CLI::Range(std::int64_t{0}, std::int64_t{1'000'000}))
                         ->type_name("N");
  CLI::Option* video = sub->add_option("--video", command.video,
                                       "video of --scenario: .mp4, .avi or .mkv (required with --scenario)")
                           ->type_name("FILE");
  one->needs(video);
  video->needs(one);
  add_report_option(*sub, command.report);
  const std::vector<std::string> of_source{"--map",         "--reference", "--poses",  "--frames",
                                           "--calibration", "--cell",      "--picture"},
      of_rooms{"--scenarios", "--seed", "--random-rooms", "--threads", "--maps",
               "--csv",       "--html", "--scenario",     "--video"},
      of_many{"--scenarios", "--threads", "--csv", "--html", "--report"};
  sub->callback([&, sub, of_source, of_rooms, of_many] {
    const auto refuse = [sub](const std::vector<std::string>& names, const char* why) {
      for (const std::string& name : names)
        if (sub->count(name) > 0) throw CLI::ValidationError(name + why);
    };
    if (command.source.empty())
      refuse(of_source, ": used only with a SOURCE, which is not given");
    else
      refuse(of_rooms, ": used only for simulated rooms, not with a SOURCE");
    if (!command.source.empty() && command.map.empty()) throw CLI::RequiredError("--map");
    if (command.scenario) refuse(of_many, ": not available with --scenario");
    work = [&command] { return run(command); };
  });
}

void add_trade(CLI::App& app, TradeCommand& command, std::function<int()>& work) {
  CLI::App* sub = app.add_subcommand(
      "trade",
      "measure time against accuracy: random settings of prescan and run, then greedy combinations of\n"
      "the best single changes, in simulated rooms with ground truth and in recordings; each setting is\n"
      "measured between two measurements of the default");
  sub->add_option(
      "SOURCE", command.recordings,
      "folders with recordings that have poses, in addition to the simulated rooms (default: none)");
  sub->add_option("--rooms", command.rooms,
                  "simulated rooms, separated by commas (default: table,random?seed=2)")
      ->allow_extra_args(false)  // the next argument is a recording
      ->delimiter(',')
      ->type_name("LIST");
  sub->add_option("--only", command.only, "measure only this command (default: both)")
      ->check(CLI::IsMember({"prescan", "run"}));
  sub->add_option("--settings", command.settings,
                  "number of settings per command, in addition to the default (default: 30)")
      ->check(CLI::Range(1, 10'000))
      ->type_name("N");
  sub->add_option("--repeats", command.repeats, "measurements per setting and scene (default: 2)")
      ->check(CLI::Range(1, 1000))
      ->type_name("N");
  sub->add_option("--objects", command.objects,
                  "virtual objects in a run, except in settings that change their number (default: 1)")
      ->check(CLI::IsMember({1, 5, 20}))
      ->type_name("N");
  sub->add_option("--seed", command.seed, "seed of the settings and of their order (default: 1)")
      ->type_name("N");
  sub->add_option("--time", command.time,
                  "compare settings by wall-clock time (wall) or, on a busy machine, by the CPU time of all\n"
                  "threads (cpu) (default: wall)")
      ->check(CLI::IsMember({"wall", "cpu"}));
  sub->add_flag("--quick", command.quick,
                "use few frames of small images: a functional test, not a basis for choices (default: off)");
  sub->add_flag("--table1", command.table1,
                "only compare the published radar's three rows with this machine (default: off)");
  sub->add_option("--csv", command.csv,
                  "write a line per measurement as it is made, and a line per setting at the end\n"
                  "(default: not written)")
      ->type_name("FILE");
  sub->add_option("--html", command.html,
                  "write a page with plots of the fronts, and tables (default: not written)")
      ->type_name("FILE");
  sub->add_option("--presets", command.presets,
                  "write fast, balanced, accurate and the front, for --preset and --budget-ms\n"
                  "(default: not written)")
      ->type_name("FILE");
  add_report_option(*sub, command.report);
  sub->callback([&, sub] {
    if (sub->count("--presets") > 0 && sub->count("--only") > 0)
      throw CLI::ValidationError("--presets: need measurements of both prescan and run; leave out --only");
    if (sub->count("--objects") > 0 && command.only == "prescan")
      throw CLI::ValidationError("--objects: used only for run, which --only leaves out");
    if (command.table1) {
      if ((sub->count("--rooms") > 0 && command.rooms.size() > 1) || !command.recordings.empty())
        throw CLI::ValidationError("--table1: needs exactly one simulated room; give it with --rooms");
      for (const char* name : {"--only", "--settings", "--repeats", "--objects", "--seed", "--time", "--csv",
                               "--html", "--presets"})
        if (sub->count(name) > 0)
          throw CLI::ValidationError(std::string(name) + ": used only for a sweep, not with --table1");
    }
    work = [&command] { return run(command); };
  });
}

/// Rejects numbers that CLI11 would misread: 010 as 8, and -1 for a seed as 18446744073709551615.
void refuse_other_bases(CLI::App& app) {
  const auto fault_of = [](const std::string& text) -> std::string {
    const bool is_plain = std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (is_plain && (text.size() == 1 || !text.starts_with('0'))) return {};
    return "must be a whole number without leading zeros, not " + text;
  };
  for (CLI::Option* option : app.get_options())
    if (option->get_type_name() == "N") option->check(fault_of);
  for (CLI::App* sub : app.get_subcommands({})) refuse_other_bases(*sub);
}

}  // namespace

ParsedCommand parse_command_line(int argc, const char* const* argv) {
  // Shared: `work` needs the commands after this function returns.
  const auto arguments = std::make_shared<Arguments>();
  std::function<int()> work;
  CLI::App app(
      "roomradar: prescan a room once with a Kinect, then run augmented reality in the saved map.\n"
      "Exit status: 0 done, 1 the work failed (stderr says what and what to do), 2 wrong usage.",
      "roomradar");
  app.set_version_flag("--version", kVersion);
  app.require_subcommand(1);
  app.get_formatter()->column_width(32);
  add_prescan(app, arguments->prescan, work);
  add_run(app, arguments->run, work);
  add_map(app, *arguments, work);
  add_record(app, arguments->record, work);
  add_calibrate(app, arguments->calibrate, work);
  CLI::App* doctor = app.add_subcommand(
      "doctor", "check this set-up and say how to repair it; exit status 1 if something must be repaired");
  doctor->callback([&] { work = [] { return run(DoctorCommand{}); }; });
  add_simulate(app, arguments->simulate, work);
  add_fallthrough(app, arguments->fallthrough, work);
  add_trade(app, arguments->trade, work);
  app.add_flag_callback("--manual",
                        [&app] {
                          std::fputs(manual_page(app).c_str(), stdout);
                          throw CLI::Success();
                        })
      ->group("");
  refuse_other_bases(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool is_help = app.exit(error) == 0;
    return {{}, is_help ? 0 : 2};
  }
  return {[arguments, work] { return work(); }, 0};
}

}  // namespace roomradar
