// roomradar_source.cpp: exported functions for reading the frames of recordings.
#include "app/c_api/roomradar_source.h"

#include <memory>
#include <utility>

#include "app/c_api/conversions.hpp"
#include "app/c_api/handles.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "mapping/types/frame_source.hpp"

using namespace roomradar;
using namespace roomradar::c_api;

namespace {

struct SourceState : Handled {
  static constexpr const char* kKind = "source";
  std::unique_ptr<FrameSource> source;
  Frame frame;  ///< whose images the caller reads
};

}  // namespace

roomradar_status roomradar_source_open(const char* path, roomradar_source** source) {
  return guarded("roomradar_source_open", nullptr, [&] {
    require_given(source, "source");
    auto state = std::make_shared<SourceState>();
    state->source = open_folder(text_of(path, "path"));
    *source = HandleTable<SourceState>::get().add<roomradar_source>(std::move(state));
  });
}

roomradar_status roomradar_source_close(roomradar_source* source) {
  return c_api::close<SourceState>("roomradar_source_close", source);
}

const char* roomradar_source_error(const roomradar_source* source) { return error_of<SourceState>(source); }

roomradar_status roomradar_source_next(roomradar_source* source, roomradar_frame* frame) {
  return with<SourceState>("roomradar_source_next", source, [&](SourceState& state) {
    require_struct(frame, "frame");
    const ReadResult read = state.source->next(state.frame);
    if (read.status == ReadStatus::kEnd) throw Refusal(ROOMRADAR_END, "the recording has no more frames");
    if (read.status == ReadStatus::kSkipped) throw Refusal(ROOMRADAR_SKIPPED, read.fault);
    write_frame(state.frame, *frame);
  });
}

roomradar_status roomradar_source_rewind(roomradar_source* source) {
  return with<SourceState>("roomradar_source_rewind", source, [&](SourceState& state) {
    if (!state.source->rewind()) throw Refusal(ROOMRADAR_FAILED, "the recording cannot go back");
  });
}
