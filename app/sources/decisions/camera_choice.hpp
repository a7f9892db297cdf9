// camera_choice.hpp: chooses the cameras of a recording, and the unit of its depth.
#pragma once
#include <filesystem>

#include "app/sources/datasets/recording_facts.hpp"
#include "app/sources/formats/input_report.hpp"
#include "app/sources/formats/source_options.hpp"

namespace roomradar {

/// Replaces the cameras of `facts` by those that `options`, or a file in the folder, state, see decide().
/// Reports cameras that are assumed.
/// @throws Error if a file is invalid, or cameras do not fit the images. The message has both sizes
void choose_cameras(RecordingFacts& facts, const std::filesystem::path& folder, const SourceOptions& options,
                    InputReport& report);

/// What camera.json states besides cameras.
struct StatedInput {
  std::optional<double> depth_unit_m{};
  std::optional<PoseConvention> pose_convention{};
};

/// Returns what options.camera_file, else camera.json in the folder, states. Throws Error naming an invalid
/// field.
StatedInput read_stated_input(const std::filesystem::path& folder, const SourceOptions& options);

}  // namespace roomradar
