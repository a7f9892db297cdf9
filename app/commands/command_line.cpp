// command_line.cpp: the commands, their arguments and their help.
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
    "where frames come from: kinect:N[?depth=raw|mm|registered], sim:ROOM[?seed=N&...], or a folder with a "
    "recording\n"
    "(7-Scenes, TUM RGB-D, fakenect, or numbered color/ and depth/); kinect:N goes on until Ctrl-C";

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
         "only frames A to B, both included, counted from 0")
      ->type_name("A:B");
}

void add_calibration_option(CLI::App& app, std::string& calibration) {
  app.add_option("--calibration", calibration,
                 "the cameras and their errors, as `roomradar calibrate` writes them; without it a file\n"
                 "calibration.json in SOURCE, else what SOURCE says")
      ->type_name("FILE");
}

void add_report_option(CLI::App& app, std::string& report) {
  app.add_option("--report", report, "write settings, times, memory and results as JSON")->type_name("FILE");
}

/// Answers a word from a table; CLI11's own transformer would list the values as numbers.
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

/// One option a field of the quality. What is given goes to `fixed`, and from there into the quality once it
/// is known what else the command was given.
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
  app.add_option(
         "--preset", preset,
         "settings that were measured: fast, balanced or accurate; what is given by its own option goes\n"
         "before them")
      ->type_name("NAME");
  app.add_option("--presets", presets, "file of presets, as `roomradar trade` writes it (the program's own)")
      ->type_name("FILE");
}

/// The preset's, if one is named, and then what was given by its own option.
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

/// CLI11's own Range would let "nan" pass.
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

/// All commands' arguments; CLI11 writes into these while it parses.
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
  CLI::App* sub = app.add_subcommand("prescan", "scan a room once and save it as a map");
  sub->add_option("SOURCE", command.source, kSourceHelp)->required();
  sub->add_option("--map", command.map, "folder to save the map in; an older map there is replaced")
      ->required()
      ->type_name("DIR");
  add_choice(*sub, "--poses", command.poses, kPoses,
             "find the camera's poses (tracked), or take the recording's own");
  add_frames_option(*sub, command.frames);
  add_calibration_option(*sub, command.calibration);
  sub->add_option("--hold-out", command.hold_out,
                  "keep every Nth frame out of the map (i mod N = N/2) and score the mesh on them")
      ->check(CLI::Range(std::int64_t{2}, std::int64_t{1'000'000}))
      ->type_name("N");
  sub->add_flag("--resume", command.resume,
                "go on with the scan of this map that was cut off (DIR.unfinished), or else\n"
                "add what SOURCE shows to the map that is in DIR");
  sub->add_option("--checkpoint-every", command.checkpoint_every_s,
                  "seconds between two checkpoints (2.5); 0: none, then nothing can be resumed")
      ->check(within(0.0, 86400.0, "seconds"))
      ->type_name("S");
  sub->add_option("--max-memory", command.max_memory_mb,
                  "stop before the process takes more than so many megabytes; what was fused so far\n"
                  "is saved as a whole map (one that is added to stays as it was), and the exit status is 1")
      ->check(within(1.0, 1e7, "megabytes"))
      ->type_name("MB");
  add_preset_options(*sub, command.preset, command.presets);
  add_quality_options(*sub, command.quality, command.fixed);
  add_report_option(*sub, command.report);
  sub->callback([&, sub] {
    if (sub->count("--presets") > 0 && sub->count("--preset") == 0)
      throw CLI::ValidationError("--presets: says where --preset NAME is looked up, and none is given");
    settle_quality(command);
    work = [&command] { return run(command); };
  });
}

/// A recorded session brings its own settings; what is given on the command line goes before them.
void take_recorded_settings(RunCommand& command, const CLI::App& sub) {
  const RunCommand recorded = read_session(command.source);
  const auto is_given = [&](const char* name) { return sub.count(name) > 0; };
  if (is_given("--calibration"))
    throw CLI::ValidationError("--calibration: a recorded session is played with the frames that it has");
  if (is_given("--frames"))
    throw CLI::ValidationError(
        "--frames: a recorded session is played from its first frame, which its events count from");
  if (is_given("--object"))
    throw CLI::ValidationError("--object: a recorded session has its own objects; --script gives it others");
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
  CLI::App* sub = app.add_subcommand("run", "augmented reality in a saved map");
  sub->add_option("SOURCE", command.source,
                  std::string(kSourceHelp) +
                      ",\nor a session that was recorded by --record-session: it is played again from its\n"
                      "first frame on, with its own settings where none are given")
      ->required();
  sub->add_option("--map", command.map, "the saved map; it is only read")->type_name("DIR");
  add_choice(*sub, "--poses", command.poses, kPoses,
             "find the camera in the map (tracked), or take the recording's own poses");
  add_frames_option(*sub, command.frames);
  add_calibration_option(*sub, command.calibration);
  sub->add_option("--object", command.object, "virtual object: teapot (built in), or a mesh file")
      ->type_name("MESH");
  sub->add_option("--script", command.script,
                  "events file; without it the object is dropped over a surface in view")
      ->type_name("FILE");
  add_choice(*sub, "--surfaces", command.surfaces, kSurfaces,
             "what can be touched: this frame's pixels, the same with skirts across depth edges,\n"
             "with the image's border pushed out as well, or the map and what moved (map)");
  add_choice(*sub, "--unknown", command.unknown_is_solid, kUnknownIsSolid,
             "space that the prescan has not seen lets objects through (free) or stops them (solid;\n"
             "with --surfaces map)");
  sub->add_option("--adopt", command.commit_after_s,
                  "what came and stayed, or was gone, for so many seconds while it was seen becomes part of\n"
                  "the room (of this run's own; the saved map stays as it is)")
      ->check(within(0.5, 86400.0, "seconds"))
      ->type_name("SECONDS");
  sub->add_option(
         "--save-map", command.save_map,
         "folder to save the room with what was adopted in, as a map; an older map there is replaced,\n"
         "so give --map's own folder to change that")
      ->type_name("DIR");
  sub->add_flag("--window", command.window,
                "play in a window: pick, drop, throw, turn; watch what the radar sees");
  sub->add_option("--record-session", command.record_session,
                  "folder for frames, events and settings; `run DIR` plays them again, the same to the bit")
      ->type_name("DIR");
  add_choice(*sub, "--at-end", command.at_end, kAtEnd,
             "after the last frame: end (without a window), stay there (with one), or begin again");
  sub->add_option(
         "--video", command.video,
         "write the composed pictures as .mp4, .avi or .mkv, 30 a second, as fast as they were taken")
      ->type_name("FILE");
  sub->add_option("--pictures", command.pictures,
                  "write composed pictures and masks of what moved as PNG into this folder, named by the\n"
                  "source's frame, and the run's where that comes again")
      ->type_name("DIR");
  sub->add_option("--pictures-every", command.pictures_every, "one picture every N frames (10)")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000}))
      ->type_name("N");
  sub->add_option(
         "--budget-ms", command.budget_ms,
         "hold the time of a frame: where more is to do than fits, what costs least accuracy is given\n"
         "up, and it is said what")
      ->check(within(1.0, 10000.0, "milliseconds"))
      ->type_name("MS");
  add_preset_options(*sub, command.preset, command.presets);
  sub->add_option("--frames-csv", command.frames_csv,
                  "write one line a frame: how much of room and depth was needed, and why")
      ->type_name("FILE");
  add_quality_options(*sub, command.quality, command.fixed);
  add_report_option(*sub, command.report);
  sub->callback([&, sub] {
    if (command.window && sub->count("--at-end") == 0) command.at_end = AtEnd::kStay;
    if (sub->count("--object") > 0 && sub->count("--script") > 0 && !command.window)
      throw CLI::ValidationError("--object: --script says which objects there are; add it there");
    if (sub->count("--presets") > 0 && sub->count("--preset") == 0 && !command.budget_ms)
      throw CLI::ValidationError(
          "--presets: says where --preset NAME and what --budget-ms gives up are looked up, and neither is "
          "given");
    if (sub->count("--pictures-every") > 0 && command.pictures.empty())
      throw CLI::ValidationError("--pictures-every: --pictures says into which folder, and is not given");
    if (is_session_folder(command.source)) take_recorded_settings(command, *sub);
    settle_quality(command);
    if (command.map.empty()) throw CLI::RequiredError("--map");
    if (command.unknown_is_solid && command.surfaces != SurfacePolicy::kMap)
      throw CLI::ValidationError(
          "--unknown solid: only the map knows what was seen; it needs --surfaces map");
    work = [&command] { return run(command); };
  });
}

void add_map(CLI::App& app, Arguments& arguments, std::function<int()>& work) {
  CLI::App* sub =
      app.add_subcommand("map", "look at a saved map, check it, export it, join two, compare two");
  sub->require_subcommand(1);
  CLI::App* info = sub->add_subcommand("info", "what is in the map");
  info->add_option("DIR", arguments.map_info.map, "the map")->required();
  info->callback([&] { work = [&arguments] { return run(arguments.map_info); }; });
  CLI::App* verify =
      sub->add_subcommand("verify", "check every file against its checksum; exit status 1 if one is off");
  verify->add_option("DIR", arguments.map_verify.map, "the map")->required();
  verify->callback([&] { work = [&arguments] { return run(arguments.map_verify); }; });
  CLI::App* to_file = sub->add_subcommand("export", "write octree or mesh for other programs");
  to_file->add_option("DIR", arguments.map_export.map, "the map")->required();
  to_file
      ->add_option("FILE", arguments.map_export.path,
                   "by extension: .ot .bt (octree), .ply .obj .stl .glb (mesh)")
      ->required();
  to_file->add_flag("--unknown", arguments.map_export.unknown,
                    "the surface round space that the scan has not seen, in the place of the room's mesh");
  to_file->callback([&] { work = [&arguments] { return run(arguments.map_export); }; });
  CLI::App* merge = sub->add_subcommand(
      "merge",
      "join two maps of one room, each having seen a part of it; B is placed in A by views that both have\n"
      "and by their surfaces, and refused where that is not certain");
  merge->add_option("A", arguments.map_merge.a, "its world becomes that of both")->required();
  merge->add_option("B", arguments.map_merge.b, "is added; the finer resolution of the two is taken")
      ->required();
  merge->add_option("--map", arguments.map_merge.map, "folder to save the map of both in")
      ->required()
      ->type_name("DIR");
  merge
      ->add_option("--deviation", arguments.map_merge.deviation_m,
                   "how far its mesh with large triangles may lie from that with all, metres; 0 keeps all\n"
                   "(as A was made)")
      ->check(within(0.0, 1.0, "metres"))
      ->type_name("M");
  add_report_option(*merge, arguments.map_merge.report);
  merge->callback([&] { work = [&arguments] { return run(arguments.map_merge); }; });
  CLI::App* diff = sub->add_subcommand(
      "diff", "what appeared in B and what vanished since A, where both know; in A's world");
  diff->add_option("A", arguments.map_diff.a, "the map before")->required();
  diff->add_option("B", arguments.map_diff.b, "the map after")->required();
  add_report_option(*diff, arguments.map_diff.report);
  diff->add_option("--picture", arguments.map_diff.picture, "draw A, what appeared green, what vanished red")
      ->type_name("FILE.png");
  diff->callback([&] { work = [&arguments] { return run(arguments.map_diff); }; });
}

void add_simulate(CLI::App& app, SimulateCommand& command, std::function<int()>& work) {
  CLI::App* sub = app.add_subcommand("simulate", "record a simulated Kinect, with ground truth beside it");
  sub->add_option("DIR", command.folder, "folder to write; must be empty or not there")->required();
  sub->add_option("--room", command.room, "table, shelf, wall, random or board (table)")->type_name("NAME");
  sub->add_option("--seed", command.seed, "of the camera's path, the noise, and what is in a random room (1)")
      ->type_name("N");
  sub->add_option("--frames", command.frames, "how many (300)")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000}))
      ->type_name("N");
  sub->add_option("--path", command.path,
                  "scan (round the room), view (looks at its focus) or swing (before the board)")
      ->type_name("KIND");
  sub->add_option("--moving", command.moving, "what moves: hand, ball, person; several with commas")
      ->type_name("LIST");
  add_choice(*sub, "--format", command.format, kFormats, "of the recording (tum)");
  sub->callback([&] { work = [&command] { return run(command); }; });
}

void add_record(CLI::App& app, RecordCommand& command, std::function<int()>& work) {
  CLI::App* sub = app.add_subcommand("record", "write a source's frames as a recording");
  sub->add_option("SOURCE", command.source, kSourceHelp)->required();
  sub->add_option("DIR", command.folder, "folder to write; must be empty or not there")->required();
  add_frames_option(*sub, command.frames);
  add_calibration_option(*sub, command.calibration);
  add_choice(*sub, "--format", command.format, kFormats, "of the recording (tum)");
  sub->callback([&] { work = [&command] { return run(command); }; });
}

void add_calibrate(CLI::App& app, CalibrateCommand& command, std::function<int()>& work) {
  CLI::App* sub = app.add_subcommand(
      "calibrate",
      "find both cameras, their lenses, where they stand to each other, and the depth's errors, from\n"
      "a recording of a checkerboard that is held still in 20 or more places: near, far, tilted, in\n"
      "every part of the image");
  sub->add_option("SOURCE", command.source, kSourceHelp)->required();
  sub->add_option("--out", command.calibration, "file to write, for --calibration of other commands")
      ->required()
      ->type_name("FILE");
  sub->add_option("--columns", command.board.columns, "inner corners along the board's longer side (8)")
      ->type_name("N");
  sub->add_option("--rows", command.board.rows, "inner corners along the other (6)")->type_name("N");
  sub->add_option("--square", command.board.square_m, "side of a square, metres (0.03)")->type_name("M");
  add_frames_option(*sub, command.frames);
  sub->add_option("--plot", command.plot, "draw what was seen, and the errors before and after")
      ->type_name("FILE.png");
  add_report_option(*sub, command.report);
  sub->callback([&] { work = [&command] { return run(command); }; });
}

void add_fallthrough(CLI::App& app, FallthroughCommand& command, std::function<int()>& work) {
  CLI::App* sub = app.add_subcommand(
      "fallthrough",
      "drop and push objects behind occluders under each surface policy; simulated truth judges.\n"
      "With a SOURCE: drop a ball over each cell of a grid in its map, with one frame's surfaces");
  sub->add_option("SOURCE", command.source, "a recording of the room of --map; its first frame is taken");
  sub->add_option("--map", command.map, "of SOURCE's room")->type_name("DIR");
  sub->add_option("--reference", command.reference,
                  "another map of the recording, whose surface is taken as the truth; else it is --map's own")
      ->type_name("DIR");
  add_choice(*sub, "--poses", command.poses, kPoses,
             "find the frame's camera in the map (tracked), or take the recording's own pose");
  add_frames_option(*sub, command.frames);
  add_calibration_option(*sub, command.calibration);
  sub->add_option("--cell", command.cell_m, "edge of the grid's cells, metres (0.1)")
      ->check(within(0.01, 10.0, "metres"))
      ->type_name("M");
  sub->add_option("--picture", command.picture, "plan: what the ball rests on in each cell")
      ->type_name("FILE.png");
  sub->add_option("--scenarios", command.scenarios, "how many (200)")
      ->check(CLI::Range(1, 1'000'000))
      ->type_name("N");
  sub->add_option("--seed", command.seed, "of the scenarios (1)")->type_name("N");
  sub->add_option("--random-rooms", command.random_rooms,
                  "rooms with drawn furniture beside table, shelf and wall (3)")
      ->check(CLI::Range(0, 1000))
      ->type_name("N");
  sub->add_option("--threads", command.threads, "to scan rooms and make scenarios with (all processors)")
      ->check(CLI::Range(1, 256))
      ->type_name("N");
  sub->add_option("--maps", command.maps,
                  "keep the rooms' maps in this folder, and take them from there if they are in it")
      ->type_name("DIR");
  sub->add_option("--csv", command.csv, "write one line a scenario and policy")->type_name("FILE");
  sub->add_option("--html", command.html, "write one page with tables, plots and pictures of failures")
      ->type_name("FILE");
  CLI::Option* one = sub->add_option("--scenario", command.scenario, "replay only this one, as a video")
                         ->check(CLI::Range(std::int64_t{0}, std::int64_t{1'000'000}))
                         ->type_name("N");
  CLI::Option* video =
      sub->add_option("--video", command.video, "of --scenario: .mp4, .avi or .mkv")->type_name("FILE");
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
      refuse(of_source, ": is about a SOURCE, and none is given");
    else
      refuse(of_rooms, ": is about simulated rooms, and not about a SOURCE");
    if (!command.source.empty() && command.map.empty()) throw CLI::RequiredError("--map");
    if (command.scenario) refuse(of_many, ": is not made of one --scenario alone");
    work = [&command] { return run(command); };
  });
}

void add_trade(CLI::App& app, TradeCommand& command, std::function<int()>& work) {
  CLI::App* sub = app.add_subcommand(
      "trade",
      "measure what accuracy costs: settings of prescan and run, drawn at random, then the turns that gave\n"
      "most for least on top of each other, in simulated rooms with known truth and in recordings, each\n"
      "between two measurements of the default");
  sub->add_option("SOURCE", command.recordings,
                  "folders with recordings that have poses, beside the simulated rooms");
  sub->add_option("--rooms", command.rooms, "simulated rooms, with commas between them (table,random?seed=2)")
      ->allow_extra_args(false)  // what follows is a recording
      ->delimiter(',')
      ->type_name("LIST");
  sub->add_option("--only", command.only, "of prescan and run")->check(CLI::IsMember({"prescan", "run"}));
  sub->add_option("--settings", command.settings, "how many of each are tried beside the default (30)")
      ->check(CLI::Range(1, 10'000))
      ->type_name("N");
  sub->add_option("--repeats", command.repeats, "how often each is measured in each scene (2)")
      ->check(CLI::Range(1, 1000))
      ->type_name("N");
  sub->add_option("--objects", command.objects,
                  "how many virtual objects a run has, where their number is not what is turned (1)")
      ->check(CLI::IsMember({1, 5, 20}))
      ->type_name("N");
  sub->add_option("--seed", command.seed, "of what is drawn, and of its order (1)")->type_name("N");
  sub->add_option(
         "--time", command.time,
         "settings are compared by the time that passes (wall), or on a machine that has other work\n"
         "by what all threads compute (cpu)")
      ->check(CLI::IsMember({"wall", "cpu"}));
  sub->add_flag("--quick", command.quick, "few frames of small images: to look at, not to choose by");
  sub->add_flag("--table1", command.table1,
                "only the published radar's three rows beside those of this machine");
  sub->add_option("--csv", command.csv,
                  "write one line a measurement as soon as it is made, and one a setting at the end")
      ->type_name("FILE");
  sub->add_option("--html", command.html, "write one page with the fronts as plots, and tables")
      ->type_name("FILE");
  sub->add_option("--presets", command.presets,
                  "write fast, balanced, accurate and the front, for --preset and --budget-ms")
      ->type_name("FILE");
  add_report_option(*sub, command.report);
  sub->callback([&, sub] {
    if (sub->count("--presets") > 0 && sub->count("--only") > 0)
      throw CLI::ValidationError("--presets: are of prescan and run, and --only leaves out one of them");
    if (sub->count("--objects") > 0 && command.only == "prescan")
      throw CLI::ValidationError("--objects: are of run, and --only leaves it out");
    if (command.table1) {
      if ((sub->count("--rooms") > 0 && command.rooms.size() > 1) || !command.recordings.empty())
        throw CLI::ValidationError("--table1: is of one simulated room; name one by --rooms");
      for (const char* name : {"--only", "--settings", "--repeats", "--objects", "--seed", "--time", "--csv",
                               "--html", "--presets"})
        if (sub->count(name) > 0)
          throw CLI::ValidationError(std::string(name) + ": is of a sweep, and --table1 makes none");
    }
    work = [&command] { return run(command); };
  });
}

/// CLI11 would read 010 as 8, and for a seed -1 as 18446744073709551615.
void refuse_other_bases(CLI::App& app) {
  const auto fault_of = [](const std::string& text) -> std::string {
    const bool is_plain = std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (is_plain && (text.size() == 1 || !text.starts_with('0'))) return {};
    return "must be a whole number without a zero before it, not " + text;
  };
  for (CLI::Option* option : app.get_options())
    if (option->get_type_name() == "N") option->check(fault_of);
  for (CLI::App* sub : app.get_subcommands({})) refuse_other_bases(*sub);
}

}  // namespace

ParsedCommand parse_command_line(int argc, const char* const* argv) {
  // The commands outlive this function inside `work`.
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
      "doctor", "say what of this set-up works, and what to do about the rest; exit status 1 if it is ill");
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
