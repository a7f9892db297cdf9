// prescan_options.hpp: options of `roomradar prescan`.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/objects/unknown_support.hpp"
#include "app/quality/quality.hpp"
#include "app/cli/options/input_options.hpp"
#include "app/sources/formats/frame_range.hpp"
#include "mapping/fusion_selection.hpp"
#include "mapping/odometry/up_direction.hpp"
#include "mapping/types/pose_origin.hpp"

namespace CLI {
class App;
}

namespace roomradar {

/// Signals of the scan window when tracking is lost.
struct LostSignal {
  bool flashes = true;  ///< a red border flashes round the image
  bool rings = false;   ///< the terminal's bell rings once
  friend bool operator==(const LostSignal&, const LostSignal&) = default;
};

struct PrescanOptions {
  /// The command line as given, with the program's name. Empty: the program begins this scan by itself.
  std::vector<std::string> line;
  /// Source of the frames, in the form that open_source() accepts.
  std::string source;
  /// Map folder to write.
  std::string map;
  /// Quality: that of the preset, with the fields in `fixed` replaced.
  ScanQuality quality;
  /// Settings given as options. They take precedence over the preset.
  FieldWords fixed;
  /// Name of the preset; empty: none.
  std::string preset;
  /// Presets file; empty: see presets_file().
  std::string presets;
  /// Origin of the camera poses: estimated or recorded.
  PoseOrigin poses = PoseOrigin::kAuto;
  /// Range of frames to use; unset: all.
  std::optional<FrameRange> frames;
  /// Calibration file; empty: see calibration_for().
  std::string calibration;
  /// What the user states about the recording.
  InputOptions input;
  /// Up direction of the map; unset: estimated from gravity or, without gravity, from level surfaces.
  std::optional<GivenUp> up;
  /// N > 0: every Nth frame is not fused into the map, but used to evaluate it.
  std::int64_t hold_out = 0;
  /// Max number of fused frames; 0: no limit.
  std::int64_t max_fused = kMaxFusedFrames;
  /// True: bakes a texture of the surface.
  bool texture = true;
  /// True: continues an interrupted scan, or extends an existing map.
  bool resume = false;
  /// True: replaces an existing map, which stays as an earlier revision.
  bool replace = false;
  /// Time between checkpoints; 0: no checkpoints.
  double checkpoint_every_s = 2.5;
  /// Max memory of the process, 10^6 bytes; 0: unlimited.
  double max_memory_mb = 0.0;
  /// True: opens a window that shows the scan.
  bool window = false;
  LostSignal lost_signal;
  /// Place that the window asks the user to scan first, in the world frame of the extended map. Set by the
  /// program, not by an option.
  std::optional<PlaceToScan> look_at;
  /// Scale of the window's text and panes; unset: the monitor's.
  std::optional<double> ui_scale;
  /// File for the camera's poses; empty: written only to the map.
  std::string trajectory;
  /// JSON file to write; empty: not written.
  std::string report;
};

/// Adds the options with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, PrescanOptions& options);

/// Checks combinations of options and sets `quality`. Call after parsing. Throws CLI::ParseError for wrong
/// usage, and Error if the preset cannot be read.
void complete_options(const CLI::App& command, PrescanOptions& options);

}  // namespace roomradar
