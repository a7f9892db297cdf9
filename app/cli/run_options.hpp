// run_options.hpp: options of `roomradar run`.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "app/quality/quality.hpp"
#include "app/sources/formats/frame_range.hpp"
#include "app/sources/recordings/playback_source.hpp"
#include "dynamic/surface/surface_policy.hpp"
#include "mapping/types/pose_origin.hpp"

namespace roomradar {

struct RunCommand {
  std::string source;
  std::string map;
  PoseOrigin poses = PoseOrigin::kTracked;
  std::optional<FrameRange> frames;
  std::string calibration;        ///< file with the cameras and their errors; empty: as the source says
  std::string object = "teapot";  ///< built-in name or mesh file
  std::string script;             ///< events file; empty: drop the object over a level surface in view
  SurfacePolicy surfaces = SurfacePolicy::kMap;
  bool unknown_is_solid = false;  ///< kMap only: objects cannot enter space that the scan has not observed
  RunQuality quality;
  FieldWords fixed;                 ///< settings given as options; no preset, script or budget changes them
  std::string preset;               ///< name; empty: none
  std::string presets;              ///< file; empty: the program's own
  std::optional<double> budget_ms;  ///< time limit per frame
  std::optional<double> commit_after_s;  ///< none: changes are adopted only by events of the script
  AtEnd at_end = AtEnd::kEnd;            ///< behaviour after the source's last frame
  bool window = false;
  std::string record_session;  ///< folder for frames, events and settings; empty: not recorded
  std::string save_map;        ///< folder for the map at the end of the run; empty: not saved
  std::string video;
  std::string pictures;  ///< folder for composed frames as PNG
  std::int64_t pictures_every = 10;
  std::string frames_csv;  ///< file with a line per frame: use of room and depth, with reasons
  std::string report;
};

}  // namespace roomradar
