// roomradar_source.cpp: exported functions for reading the frames of recordings.
#include "app/c_api/roomradar_source.h"

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
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
  std::shared_ptr<InputReport> input = std::make_shared<InputReport>();
  std::string input_text;  ///< decisions as JSON
  Frame frame;  ///< whose images the caller reads
};

}  // namespace

roomradar_status roomradar_source_open(const char* path, roomradar_source** source) {
  return guarded("roomradar_source_open", nullptr, [&] {
    require_given(source, "source");
    auto state = std::make_shared<SourceState>();
    SourceOptions options;
    options.input = state->input;
    options.questions = Questions::kDepth;
    state->source = open_folder(text_of(path, "path"), options);
    *source = HandleTable<SourceState>::get().add<roomradar_source>(std::move(state));
  });
}

roomradar_status roomradar_source_close(roomradar_source* source) {
  return c_api::close<SourceState>("roomradar_source_close", source);
}

const char* roomradar_source_error(const roomradar_source* source) { return error_of<SourceState>(source); }

const char* roomradar_source_input(const roomradar_source* source) {
  const std::shared_ptr<SourceState> state = HandleTable<SourceState>::get().find(source);
  if (!state) return nullptr;
  try {
    state->input_text = to_json(state->input->decisions())
                            .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return state->input_text.c_str();
  } catch (const std::exception&) {
    return nullptr;
  }
}

roomradar_status roomradar_source_next(roomradar_source* source, roomradar_frame* frame) {
  return with<SourceState>("roomradar_source_next", source, [&](SourceState& state) {
    require_struct(frame, "frame");
    const ReadResult read = state.source->next(state.frame);
    if (read.status == ReadStatus::kEnd) throw Refusal(ROOMRADAR_END, "the recording has no more frames");
    if (read.status != ReadStatus::kFrame) throw Refusal(ROOMRADAR_SKIPPED, read.fault);
    write_frame(state.frame, *frame);
  });
}

roomradar_status roomradar_source_rewind(roomradar_source* source) {
  return with<SourceState>("roomradar_source_rewind", source, [&](SourceState& state) {
    if (!state.source->rewind()) throw Refusal(ROOMRADAR_FAILED, "the recording cannot go back");
  });
}
