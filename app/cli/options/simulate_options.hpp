// simulate_options.hpp: options of `roomradar simulate`.
#pragma once
#include <cstdint>
#include <string>

#include "app/sources/recordings/recording_writer.hpp"

namespace CLI {
class App;
}

namespace roomradar {

struct SimulateOptions {
  std::string folder;          ///< folder to write
  std::string room = "table";  ///< name, as in `sim:`
  std::uint64_t seed = 1;      ///< seed of the path, the noise and a random room's furniture
  std::int64_t frames = 300;   ///< number of frames
  std::string path = "scan";   ///< camera path: scan, view or swing
  std::string moving;          ///< such as "hand,ball,person"; empty: nothing moves
  RecordingFormat format = RecordingFormat::kTum;  ///< format of the folder's files
};

/// Adds the options with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, SimulateOptions& options);

}  // namespace roomradar
