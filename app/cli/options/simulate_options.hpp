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
  /// Folder to write.
  std::string folder;
  /// Name of the room, see make_room().
  std::string room = "table";
  /// Seed of the camera path, the noise and a random room's furniture.
  std::uint64_t seed = 1;
  /// Number of frames.
  std::int64_t frames = 300;
  /// Name of the camera path: scan, view or swing.
  std::string path = "scan";
  /// Moving objects, such as "hand,ball,person"; empty: none.
  std::string moving;
  /// Format of the recording.
  RecordingFormat format = RecordingFormat::kTum;
};

/// Adds the options with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, SimulateOptions& options);

}  // namespace roomradar
