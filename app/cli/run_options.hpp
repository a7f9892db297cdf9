// run_options.hpp: the options of `roomradar run`.
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
  std::string calibration;        ///< file of the cameras and their errors; empty: what the source says
  std::string object = "teapot";  ///< built in, or a mesh file
  std::string script;             ///< events file; empty: the object is dropped over a level surface in view
  SurfacePolicy surfaces = SurfacePolicy::kMap;
  bool unknown_is_solid = false;  ///< kMap only: objects do not enter what the scan has not seen
  RunQuality quality;
  FieldWords fixed;     ///< what of it was asked for by name; no preset, script or budget changes that
  std::string preset;   ///< name; empty: none
  std::string presets;  ///< file; empty: the program's own
  std::optional<double> budget_ms;       ///< of a frame
  std::optional<double> commit_after_s;  ///< none: only what the script asks for, if it does
  AtEnd at_end = AtEnd::kEnd;            ///< what follows the source's last frame
  bool window = false;
  std::string record_session;  ///< folder for frames, events and settings; empty: none
  std::string save_map;        ///< folder for the map as it is at the end; empty: it is not saved
  std::string video;
  std::string pictures;  ///< folder for composed frames as PNG
  std::int64_t pictures_every = 10;
  std::string frames_csv;  ///< file with a line a frame: how much of room and depth it needed, and why
  std::string report;
};

}  // namespace roomradar
