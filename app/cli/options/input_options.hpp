// input_options.hpp: options that state what a recording does not, or state it instead of the recording.
#pragma once
#include <optional>
#include <string>

#include "app/sources/formats/source_options.hpp"

namespace CLI {
class App;
}

namespace roomradar {

struct InputOptions {
  /// Length of a unit of the stored depth, m; unset: as the recording states.
  std::optional<double> depth_unit_m;
  /// camera.json or camera-intrinsics.txt; empty: as the recording states.
  std::string camera;
  /// Convention of the recorded poses; unset: recognised.
  std::optional<PoseConvention> poses_convention;
  StampChoice stamps = StampChoice::kAuto;
  /// Topic of a ROS recording with depth images; empty: chosen.
  std::string depth_topic;
};

/// Adds --depth-unit, --camera, --poses-convention, --stamps and --depth-topic.
/// @param options  receives the values; must outlive the parsing
void add_input_options(CLI::App& command, InputOptions& options);

/// Returns source options with these values.
SourceOptions source_options_of(const InputOptions& options);

/// Returns the word of --stamps.
std::string to_string(StampChoice choice);
/// Returns the options as words of a command line, each with a leading blank; empty: none was given.
std::string words_of(const InputOptions& options);

}  // namespace roomradar
