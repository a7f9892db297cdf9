// sources_replay_dump.cpp: prints a fingerprint line per frame of a source, or of its first frames; run under
// fakenect.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "app/sources/kinect/kinect_source.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/app/sources/sources_fingerprint.hpp"

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) return 2;
  long frames_left = argc == 3 ? std::atol(argv[2]) : -1;
  try {
    const std::string name = argv[1];
    const auto source = name.starts_with("kinect:") ? roomradar::open_kinect(std::atoi(name.c_str() + 7))
                                                    : roomradar::open_folder(name);
    roomradar::Frame frame;
    while (frames_left != 0) {
      const roomradar::ReadResult result = source->next(frame);
      if (result.status == roomradar::ReadStatus::kEnd) return 0;
      const bool is_frame = result.status == roomradar::ReadStatus::kFrame;
      std::puts(is_frame ? roomradar::test::fingerprint(frame).c_str()
                : result.status == roomradar::ReadStatus::kWaiting ? "waiting"
                                                                   : "skipped");
      if (is_frame) --frames_left;
    }
    return 0;
  } catch (const roomradar::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
