// run_options.hpp: options of `roomradar run`.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

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
  std::string source;                       ///< as for open_source(), or the folder of a recorded session
  std::string map;                          ///< folder to read
  PoseOrigin poses = PoseOrigin::kTracked;  ///< kTracked: localised in the map
  std::optional<FrameRange> frames;         ///< unset: all
  std::string calibration;        ///< file with the cameras and their errors; empty: as the source says
  std::string object = "teapot";  ///< built-in name or mesh file
  std::string script;             ///< events file; empty: drop the object over a level surface in view
  SurfacePolicy surfaces = SurfacePolicy::kMap;  ///< surfaces that objects can touch
  bool unknown_is_solid = true;     ///< kMap only: objects cannot enter space that the scan has not observed
  RunQuality quality;               ///< the preset's or the session's, with the fields of `fixed`
  FieldWords fixed;                 ///< settings given as options; no preset, script or budget changes them
  std::string preset;               ///< name; empty: none
  std::string presets;              ///< file; empty: the program's own
  std::optional<double> budget_ms;  ///< time limit per frame; unset: none
  std::optional<double> commit_after_s;  ///< unset: changes are committed only by events of the script
  AtEnd at_end = AtEnd::kEnd;            ///< behaviour after the source's last frame
  bool window = false;                   ///< show a window, in which the user can act
  std::string record_session;            ///< folder for frames, events and settings; empty: not recorded
  std::string save_map;                  ///< folder for the map at the end of the run; empty: not saved
  std::string video;                     ///< file to write; empty: not written
  std::string pictures;                  ///< folder for composed frames as PNG; empty: not written
  std::int64_t pictures_stride = 10;     ///< N: only every Nth frame is written to `pictures`
  /// File with a line per frame: use of room and depth, with reasons; empty: not written.
  std::string frames_csv;
  std::string report;  ///< JSON file to write; empty: not written
};

/// Adds the options with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, RunOptions& options);

/// Returns the options of a recorded session, or nothing if the source is no session.
using ReadRecordedOptions = std::function<std::optional<RunOptions>(const std::string& source)>;

/// Checks the options against each other and sets the quality; call after parsing. Options that are not on
/// the command line are taken from the recorded session, if the source is one. Throws CLI::ParseError for
/// wrong usage, and Error if the preset or the session cannot be read.
void complete_options(const CLI::App& command, RunOptions& options, const ReadRecordedOptions& read_recorded);

}  // namespace roomradar
