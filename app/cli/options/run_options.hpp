// run_options.hpp: options of `roomradar run` and of `start`, the window from which it begins.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/options/input_options.hpp"
#include "app/cli/options/object_options.hpp"
#include "app/quality/quality.hpp"
#include "app/sources/formats/frame_range.hpp"
#include "app/sources/recordings/playback_source.hpp"
#include "dynamic/surface/surface_policy.hpp"
#include "mapping/types/pose_origin.hpp"

namespace CLI {
class App;
}

namespace roomradar {

struct RunOptions {
  /// Source of the frames, in the form that open_source() accepts, or the folder of a recorded session.
  std::string source;
  /// Folder to read the map of a room or building from.
  std::string map;
  /// Objects that stay in the room: "keep" (those of the map's folder), "none", or a folder.
  std::string kept_objects = "keep";
  /// Origin of the camera poses: localised in the map (kTracked) or recorded.
  PoseOrigin poses = PoseOrigin::kAuto;
  /// Range of frames to process; unset: all.
  std::optional<FrameRange> frames;
  /// Calibration file; empty: see calibration_for().
  std::string calibration;
  /// What the user states about the recording.
  InputOptions input;
  /// Objects as given on the command line.
  ObjectOptions given_objects;
  /// Objects of a run without a script, from given_objects.
  std::vector<ObjectOption> objects;
  /// Events file; empty: the objects are dropped by drop_objects().
  std::string script;
  /// Surfaces that objects can touch.
  SurfacePolicy surfaces = SurfacePolicy::kMap;
  /// True: objects cannot enter space that the scan has not observed. Applies to SurfacePolicy::kMap only.
  bool unknown_is_solid = true;
  /// Quality: that of the preset or the recorded session, with the fields in `fixed` replaced.
  RunQuality quality;
  /// Settings given as options. They take precedence over preset, script and budget.
  FieldWords fixed;
  /// Name of the preset; empty: none.
  std::string preset;
  /// Presets file; empty: see presets_file().
  std::string presets;
  /// Time limit per frame; unset: none.
  std::optional<double> budget_ms;
  /// Time without motion after which a change of the room is committed to the map. Unset: only script events
  /// commit changes.
  std::optional<double> commit_after_s;
  /// Memory target of a run in a building, MB, which may be exceeded; 0: none.
  double max_memory_mb = 0.0;
  /// Behaviour after the source's last frame.
  AtEnd at_end = AtEnd::kEnd;
  /// True: shows a window in which users can move objects and change settings.
  bool window = false;
  /// Scale of the window's text and panes; unset: that of the monitor.
  std::optional<double> ui_scale;
  /// Folder in which frames, events and settings are recorded; empty: not recorded.
  std::string record_session;
  /// Folder to which the map is saved at the end of the run; empty: not saved.
  std::string save_map;
  /// Video file to write; empty: not written.
  std::string video;
  /// Folder for composed images as PNG; empty: not written.
  std::string pictures;
  /// N: every Nth frame is written to `pictures`.
  std::int64_t pictures_stride = 10;
  /// CSV file with the FrameUse of each frame and its reasons; empty: not written.
  std::string frames_csv;
  /// File for the pose of each localised frame; empty: not written.
  std::string trajectory;
  /// File, named pipe or "-" (standard output) for the results of each frame; empty: not written.
  std::string stream;
  /// True: the summary includes RunUse.
  bool verbose = false;
  /// JSON file to write; empty: not written.
  std::string report;
};

/// Adds the options with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, RunOptions& options);

/// Returns the options of a recorded session; nullopt if the source is not a session.
using ReadRecordedOptions = std::function<std::optional<RunOptions>(const std::string& source)>;

/// Checks combinations of options and sets `quality`. Call after parsing. If the source is a recorded
/// session, options that are not on the command line are taken from the session. Throws CLI::ParseError for
/// wrong usage, and Error if the preset or the session cannot be read.
void complete_options(const CLI::App& command, RunOptions& options, const ReadRecordedOptions& read_recorded);

struct StartOptions {
  /// Maps, recordings or other sources that are listed first; the last one is chosen.
  std::vector<std::string> names;
  /// Scale of the window's text and panes; unset: the remembered one, or the monitor's.
  std::optional<double> ui_scale;
};

/// Adds the options with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, StartOptions& options);

}  // namespace roomradar
