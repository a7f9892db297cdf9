// recording_index_fakenect.cpp: reads INDEX.txt and pairs its images like a live device's.
#include "app/sources/recordings/recording_index_fakenect.hpp"

#include <array>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "app/sources/formats/kinect_units.hpp"
#include "app/sources/formats/parse_numbers.hpp"
#include "app/sources/formats/stamp_pairing.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

/// Such as d-1313283822.781270-3018607296.pgm: kind, the recorder's time of day, the device's stamp.
struct IndexLine {
  char kind = 0;
  std::uint32_t ticks = 0;
};

std::optional<IndexLine> parse_index_line(std::string_view line) {
  const std::size_t dot = line.rfind('.');
  const std::size_t dash = line.rfind('-', dot);
  if (line.size() < 2 || line[1] != '-' || std::string_view("dra").find(line[0]) == std::string_view::npos)
    return {};
  if (dot == std::string_view::npos || dash == std::string_view::npos ||
      line.find('/') != std::string_view::npos)
    return {};
  const std::string_view extension = line[0] == 'd' ? ".pgm" : line[0] == 'r' ? ".ppm" : ".dump";
  if (line.substr(dot) != extension) return {};
  const auto ticks = parse_whole_number(line.substr(dash + 1, dot - dash - 1));
  if (!ticks || *ticks < 0 || *ticks > UINT32_MAX) return {};
  return IndexLine{line[0], static_cast<std::uint32_t>(*ticks)};
}

/// Reads gravity from a dump of freenect_raw_tilt_state, which starts with three 16 bit counts and has 12
/// bytes. A dump that is missing or of another size changes nothing, as in fakenect's replay, so both give
/// the same frames.
void read_tilt_state(const fs::path& path, std::optional<Eigen::Vector3d>& down_camera) {
  std::array<char, 13> bytes{};
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), bytes.size());
  if (file.gcount() != 12) return;
  std::array<std::int16_t, 3> counts{};
  std::memcpy(counts.data(), bytes.data(), sizeof counts);
  down_camera = down_from_acceleration(Eigen::Vector3d(counts[0], counts[1], counts[2]) / kKinectCountsPerG);
}

}  // namespace

RecordingIndex index_fakenect(const fs::path& folder) {
  const fs::path index_file = folder / "INDEX.txt";
  std::istringstream lines(read_bytes(index_file, "a list of files", kLargestList_bytes));

  RecordingIndex index{DepthEncoding::kKinectRaw, NominalRig::kKinect, {}};
  std::vector<ListedImage> colours;
  std::string tilt_file;  // latest tilt file; read only if a depth image follows
  std::optional<Eigen::Vector3d> down_camera;
  KinectClock clock;
  StampPairing pairing(kDevicePairing);

  int line_number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++line_number;
    if (line.ends_with('\r')) line.pop_back();
    if (line.empty()) continue;
    const auto parsed = parse_index_line(line);
    if (!parsed) {
      throw Error(index_file.string() + ", line " + std::to_string(line_number) + ": '" + line.substr(0, 60) +
                  "' is not of the form d-TIME-STAMP.pgm, r-TIME-STAMP.ppm or a-TIME-STAMP.dump; is the list "
                  "cut short?");
    }
    if (parsed->kind == 'a') {
      tilt_file = line;
      continue;
    }
    const double stamp_s = clock.seconds(parsed->ticks);
    if (parsed->kind == 'r') {
      pairing.add_colour(static_cast<std::int64_t>(colours.size()), stamp_s);
      colours.push_back({stamp_s, (folder / line).string(), {}});
    } else {
      if (!tilt_file.empty()) read_tilt_state(folder / tilt_file, down_camera);
      pairing.add_depth(static_cast<std::int64_t>(index.frames.size()), stamp_s);
      index.frames.push_back(
          {.stamp_s = stamp_s, .depth_file = (folder / line).string(), .down_camera = down_camera});
    }
    pair_up(pairing, colours, index.frames);
  }
  pairing.finish();
  pair_up(pairing, colours, index.frames);
  return index;
}

}  // namespace roomradar
