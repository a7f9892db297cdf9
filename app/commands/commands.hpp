// commands.hpp: what each roomradar command is given; one function each, in a file of its name.
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
  FieldWords fixed;     ///< what of it was asked for by name; no preset changes that
  std::string preset;   ///< name; empty: none
  std::string presets;  ///< file; empty: the program's own
  PoseOrigin poses = PoseOrigin::kTracked;
  std::optional<FrameRange> frames;
  std::string calibration;          ///< file of the cameras and their errors; empty: what the source says
  std::int64_t hold_out = 0;        ///< N > 0: every Nth frame judges the map instead of making it
  bool resume = false;              ///< go on with a scan that was cut off, or with a map that is there
  double checkpoint_every_s = 2.5;  ///< 0: none
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
  bool unknown = false;  ///< the surface round what the scan has not seen, in the place of the mesh
};

struct MapMergeCommand {
  std::string a;
  std::string b;
  std::string map;
  std::optional<double> deviation_m;  ///< of the surface of both; a's if not given
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
  std::string moving;  ///< hand,ball,person
  RecordingFormat format = RecordingFormat::kTum;
};

struct RecordCommand {
  std::string source;
  std::string folder;
  std::optional<FrameRange> frames;
  std::string calibration;  ///< file of the cameras and their errors; empty: what the source says
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
  std::string source;     ///< of a recorded room; empty: simulated ones
  std::string map;        ///< of that room
  std::string reference;  ///< map whose surface is taken as the truth; empty: `map` itself
  PoseOrigin poses = PoseOrigin::kTracked;
  std::optional<FrameRange> frames;
  std::string calibration;
  double cell_m = 0.1;
  std::string picture;  ///< plan of the room

  int scenarios = 200;
  std::uint64_t seed = 1;
  int random_rooms = 3;
  int threads = 0;                       ///< 0: as many as there are processors
  std::optional<std::int64_t> scenario;  ///< only this one, as a video
  std::string video;
  std::string maps;  ///< folder that keeps the rooms' maps from run to run
  std::string csv;
  std::string html;
  std::string report;
};

struct TradeCommand {
  std::vector<std::string> recordings;                          ///< folders with poses, beside the rooms
  std::vector<std::string> rooms = {"table", "random?seed=2"};  ///< as `sim:` has them
  std::string only;                                             ///< prescan or run; empty: both
  std::size_t settings = 30;                                    ///< of each, beside the default
  int repeats = 2;
  std::uint64_t seed = 1;
  std::string time = "wall";  ///< what settings are compared by: wall or cpu
  int objects = 1;            ///< virtual ones that a run has, where their number is not what is turned
  bool quick = false;
  bool table1 = false;  ///< the published radar's table beside ours, and nothing else
  std::string csv;
  std::string html;
  std::string presets;
  std::string report;
};

/// Each does the whole work of its command, prints results on stdout and progress on stderr, and throws Error
/// where the work fails. The return value is the exit status: 0, or 1 where the work was done and its answer
/// is bad news.
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
