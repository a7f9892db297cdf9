// frame_bench_reader.cpp: the part of frame_bench that reads recordings and scans rooms. A separate program,
// so frame_bench runs without the libraries that this one needs.
//
// usage: frame_bench_reader scan SOURCE [A:B] FOLDER     saves the map of the source's frames A to B
//        frame_bench_reader frames SOURCE A:B            writes them to stdout, in frame_bench_pipe.hpp's
//        format
#include <cstdio>
#include <optional>
#include <string>

#include "app/cli/open_source.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/map/map_writer.hpp"
#include "mapping/prescan.hpp"
#include "tests/bench/bench_program.hpp"
#include "tests/bench/frame_bench_pipe.hpp"

namespace roomradar {
namespace {

int run(int argc, char** argv) {
  const std::string work = argc > 1 ? argv[1] : "";
  if (work == "scan" && (argc == 4 || argc == 5)) {
    StageTimes times;
    std::optional<FrameRange> frames;
    if (argc == 5) frames = parse_frame_range(argv[3]);
    const auto source = open_source(argv[2], frames);
    save_map(argv[argc - 1], prescan(*source, {}, times).map);
    return 0;
  }
  if (work != "frames" || argc != 4) {
    std::fprintf(stderr, "usage: frame_bench_reader scan SOURCE [A:B] FOLDER | frames SOURCE A:B\n");
    return 2;
  }
  const auto source = open_source(argv[2], parse_frame_range(argv[3]));
  for (Frame frame;;) {
    const ReadStatus status = source->next(frame).status;
    if (status == ReadStatus::kEnd) return 0;
    if (status == ReadStatus::kFrame && !bench::write_frame(frame, stdout)) return 1;
  }
}

}  // namespace
}  // namespace roomradar

int main(int argc, char** argv) {
  return roomradar::test::run_or_say("frame_bench_reader", [&] { return roomradar::run(argc, argv); });
}
