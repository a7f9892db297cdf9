// commands.hpp: arguments of each roomradar command, and its function; each command has its own file.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/calibration/board_views.hpp"
#include "app/cli/run_options.hpp"
#include "app/quality/quality.hpp"
#include "app/sources/formats/frame_range.hpp"
#include "app/sources/recordings/recording_writer.hpp"
#include "mapping/types/pose_origin.hpp"

namespace roomradar {

struct PrescanCommand {
  std::string source;
  std::string map;
  ScanQuality quality;
  FieldWords fixed;     ///< settings given as options; no preset changes them
  std::string preset;   ///< name; empty: none
  std::string presets;  ///< file; empty: the program's own
  PoseOrigin poses = PoseOrigin::kTracked;
  std::optional<FrameRange> frames;
  std::string calibration;          ///< file with the cameras and their errors; empty: as the source says
  std::int64_t hold_out = 0;        ///< N > 0: every Nth frame scores the map instead of being fused
  bool resume = false;              ///< continue an interrupted scan, or extend an existing map
  double checkpoint_every_s = 2.5;  ///< 0: no checkpoints
  double max_memory_mb = 0.0;       ///< of the process, 10^6 bytes; 0: no cap
  std::string report;
};

struct MapInfoCommand {
  std::string map;
};
struct MapVerifyCommand {
  std::string map;
};
struct MapExportCommand {
  std::string map;
  std::string path;
  bool unknown = false;  ///< export the border of unknown space instead of the mesh
};

struct MapMergeCommand {
  std::string a;
  std::string b;
  std::string map;
  std::optional<double> deviation_m;  ///< of the merged surface; none: as in map a
  std::string report;
};
struct MapDiffCommand {
  std::string a;
  std::string b;
  std::string report;
  std::string picture;
};

struct SimulateCommand {
  std::string folder;
  std::string room = "table";
  std::uint64_t seed = 1;
  std::int64_t frames = 300;
  std::string path = "scan";
  std::string moving;  ///< such as "hand,ball,person"
  RecordingFormat format = RecordingFormat::kTum;
};

struct RecordCommand {
  std::string source;
  std::string folder;
  std::optional<FrameRange> frames;
  std::string calibration;  ///< file with the cameras and their errors; empty: as the source says
  RecordingFormat format = RecordingFormat::kTum;
};

struct CalibrateCommand {
  std::string source;
  std::string calibration;  ///< file to write
  Board board;
  std::optional<FrameRange> frames;
  std::string plot;
  std::string report;
};

struct DoctorCommand {};

struct FallthroughCommand {
  std::string source;     ///< of a recorded room; empty: simulated rooms
  std::string map;        ///< of that room
  std::string reference;  ///< map whose surface is the ground truth; empty: `map` itself
  PoseOrigin poses = PoseOrigin::kTracked;
  std::optional<FrameRange> frames;
  std::string calibration;
  double cell_m = 0.1;
  std::string picture;  ///< plan of the room

  int scenarios = 200;
  std::uint64_t seed = 1;
  int random_rooms = 3;
  int threads = 0;                       ///< 0: one per processor
  std::optional<std::int64_t> scenario;  ///< only this scenario, as a video
  std::string video;
  std::string maps;  ///< folder in which the rooms' maps are stored and reused
  std::string csv;
  std::string html;
  std::string report;
};

struct TradeCommand {
  std::vector<std::string> recordings;  ///< folders with poses, in addition to the rooms
  std::vector<std::string> rooms = {"table", "random?seed=2"};  ///< in the form of `sim:`
  std::string only;                                             ///< prescan or run; empty: both
  std::size_t settings = 30;                                    ///< per work, in addition to the default
  int repeats = 2;
  std::uint64_t seed = 1;
  std::string time = "wall";  ///< time by which settings are compared: wall or cpu
  int objects = 1;            ///< default number of virtual objects in a run
  bool quick = false;
  bool table1 = false;  ///< only compare with the published radar's table
  std::string csv;
  std::string html;
  std::string presets;
  std::string report;
};

/// Each executes its command, prints results to stdout and progress to stderr, and throws Error if the work
/// fails. Returns the exit status: 0, or 1 if the work was done but its result is negative.
int run(const PrescanCommand& command);
int run(const RunCommand& command);
int run(const MapInfoCommand& command);
int run(const MapVerifyCommand& command);
int run(const MapExportCommand& command);
int run(const MapMergeCommand& command);
int run(const MapDiffCommand& command);
int run(const SimulateCommand& command);
int run(const RecordCommand& command);
int run(const CalibrateCommand& command);
int run(const DoctorCommand& command);
int run(const FallthroughCommand& command);
int run(const TradeCommand& command);

}  // namespace roomradar
