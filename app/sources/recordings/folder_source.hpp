// folder_source.hpp: a recording on disk as a frame source.
#pragma once
#include <filesystem>
#include <memory>

#include "app/sources/formats/source_options.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Opens a recording (folder or file) and recognises its kind by its content. app/sources/README.md lists the
/// kinds. decide() chooses cameras, times, unit and poses, and reports each decision to `options.input`.
///
/// Image files are read on demand. next() skips frames whose depth cannot be read, as FrameSource describes.
/// The source can rewind and seek, and knows its number of frames.
/// @throws Error if the recording is absent, empty or of no known kind (the message lists them), if none of its
///         depth images can be read, or if the intrinsics do not match the images
std::unique_ptr<FrameSource> open_folder(const std::filesystem::path& folder,
                                         const SourceOptions& options = {});

}  // namespace roomradar
