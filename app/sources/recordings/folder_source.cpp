// folder_source.cpp: facts, then decisions, then frames.
#include "app/sources/recordings/folder_source.hpp"

#include "app/sources/decisions/decide.hpp"
#include "app/sources/decisions/recording_source.hpp"
#include "app/sources/recordings/recording_kinds.hpp"

namespace roomradar {

std::unique_ptr<FrameSource> open_folder(const std::filesystem::path& folder, const SourceOptions& options) {
  return recording_source(decide(read_facts(folder, options.depth_topic), folder, options));
}

}  // namespace roomradar
