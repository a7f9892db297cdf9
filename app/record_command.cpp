// record_command.cpp: roomradar record: a source's frames as a folder that can be read again.
#include <cstdio>
#include <memory>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/open_source.hpp"
#include "app/progress.hpp"
#include "mapping/types/error.hpp"

namespace roomradar {

int run(const RecordCommand& command) {
  SourceOptions options;
  options.keep_all = true;
  const Interrupt interrupt;
  const std::unique_ptr<FrameSource> source =
      ended_by_interrupt(open_source(command.source, command.frames, command.calibration, options));
  RecordingWriter writer(command.folder, command.format);
  std::int64_t skipped = 0;
  {
    Progress progress("recording", source->frame_count());
    Frame frame;
    for (;;) {
      const ReadResult read = source->next(frame);
      if (read.status == ReadStatus::kEnd) break;
      if (read.waiting) continue;
      if (read.status == ReadStatus::kSkipped) {
        ++skipped;
        progress.step("skipped: " + read.fault);
        continue;
      }
      writer.write(frame);
      progress.step();
    }
  }
  writer.close();
  if (writer.frames_written() == 0) throw Error(command.source + ": there is not one readable frame");
  std::printf("%s: %lld frames written as %s, %lld skipped\n", command.folder.c_str(),
              static_cast<long long>(writer.frames_written()), std::string(to_string(command.format)).c_str(),
              static_cast<long long>(skipped));
  return 0;
}

}  // namespace roomradar
