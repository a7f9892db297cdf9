// record_command.cpp: roomradar record: writes a source's frames as a recording.
#include "app/commands/commands.hpp"

#include <cstdio>
#include <memory>
#include <string>

#include "app/cli/input_lines.hpp"
#include "app/cli/interrupt.hpp"
#include "app/cli/open_source.hpp"
#include "app/cli/progress.hpp"
#include "app/run/dropped_frames.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// Copies the source's next frame to the recording. If this fails, the error says how many frames were saved.
ReadResult take_over(FrameSource& source, RecordingWriter& writer, const std::string& folder, Frame& frame) {
  try {
    const ReadResult result = source.next(frame);
    if (result.status == ReadStatus::kFrame) writer.write(frame);
    return result;
  } catch (const Error& error) {
    if (writer.frames_written() == 0) throw;
    throw Error(std::string(error.what()) + ". The " + std::to_string(writer.frames_written()) +
                " frames before that are complete, in " + folder);
  }
}

}  // namespace

int run(const RecordOptions& options) {
  require_contents_outside_maps(options.folder);
  SourceOptions source_options = source_options_of(options.input);
  source_options.input = std::make_shared<InputReport>();
  source_options.keep_all = true;
  const Interrupt interrupt;
  const std::unique_ptr<FrameSource> source =
      ended_by_interrupt(open_source(options.source, options.frames, options.calibration, source_options));
  const bool is_live = !source->rewind();
  InputLines lines(*source_options.input, source->name());
  lines.say();
  RecordingWriter writer(options.folder, options.format,
                         gives_calibrated_frames(options.source, options.calibration));
  std::int64_t skipped = 0;
  DroppedFrames dropped;
  {
    Progress progress("recording", source->frame_count());
    Frame frame;
    for (;;) {
      const ReadResult result = take_over(*source, writer, options.folder, frame);
      if (result.status == ReadStatus::kEnd) break;
      if (result.status == ReadStatus::kWaiting) continue;
      if (result.status == ReadStatus::kSkipped) {
        ++skipped;
        progress.step("skipped: " + result.fault);
        continue;
      }
      dropped.see(frame.index, writer.frames_written() + skipped);
      progress.step();
    }
  }
  writer.close();
  lines.say();
  if (writer.frames_written() == 0) throw Error(options.source + ": there is no readable frame");
  std::printf("%s: %lld frames written as %s, %lld skipped\n", options.folder.c_str(),
              static_cast<long long>(writer.frames_written()), std::string(to_string(options.format)).c_str(),
              static_cast<long long>(skipped));
  if (is_live && dropped.count > 0)  // dropped while the disk was too slow
    std::printf("%lld frames of the device were dropped; is the disk fast enough?\n",
                static_cast<long long>(dropped.count));
  return 0;
}

}  // namespace roomradar
