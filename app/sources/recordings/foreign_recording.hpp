// foreign_recording.hpp: recognises recordings of other programs and devices, and opens them.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/sources/datasets/indexed_source.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Returns the kind of the recording at `path`, a file or folder, such as "Record3D export". Recognises the
/// kind by the content. A folder with one file of these kinds counts as that file. Returns an empty string
/// for kinds that index_foreign() does not read.
[[nodiscard]] std::string foreign_kind(const std::filesystem::path& path);

/// Lists the frames of a recording of another program. Returns nullopt if foreign_kind() is empty. If a
/// folder contains one such file and a camera.json, camera.json replaces the recording's cameras and lenses.
/// @throws Error naming the file if the recording is damaged or lacks depth images or cameras
std::optional<IndexedRecording> index_foreign(const std::filesystem::path& path);

}  // namespace roomradar
