// fakenect_dump.cpp: reads INDEX.txt and pairs its images like a live device's.
#include "app/sources/datasets/dataset_readers.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "app/sources/datasets/numbered_files.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/kinect_units.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "app/sources/formats/parse_numbers.hpp"
#include "app/sources/formats/stamp_pairing.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

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

/// Collects the frames of INDEX.txt, line by line in the order of arrival.
class FakenectIndex {
 public:
  FakenectIndex(const fs::path& folder, RecordingFacts& facts) : folder_(folder), facts_(facts) {}

  std::vector<std::string> depth_files{}, colour_files{};

  void add(const std::string& line, const FakenectLine& parsed) {
    if (parsed.kind == 'a') {
      tilt_file_ = line;
      return;
    }
    const double stamp_s = clock_.seconds(parsed.ticks);
    if (parsed.kind == 'r') {
      pairing_.add_colour(static_cast<std::int64_t>(colour_files.size()), stamp_s);
      colour_files.push_back((folder_ / line).string());
    } else {
      if (!tilt_file_.empty()) read_tilt_state(folder_ / tilt_file_, down_camera_);
      pairing_.add_depth(static_cast<std::int64_t>(facts_.frames.size()), stamp_s);
      facts_.frames.push_back({.time = {.stamp_s = stamp_s}, .down_camera = down_camera_});
      depth_files.push_back((folder_ / line).string());
      if (down_camera_) facts_.gravity_source = "its accelerometer";
    }
    take_pairs();
  }

  /// Completes the pairs after the last line.
  void finish() {
    pairing_.finish();
    take_pairs();
  }

 private:
  const fs::path& folder_;
  RecordingFacts& facts_;
  std::string tilt_file_;  ///< the latest; read only if a depth image follows
  std::optional<Eigen::Vector3d> down_camera_;
  KinectClock clock_;
  StampPairing pairing_{kDevicePairing};

  void take_pairs() {
    while (const auto pair = pairing_.take()) {
      if (!pair->colour) continue;
      StatedFrame& frame = facts_.frames[static_cast<std::size_t>(pair->depth)];
      frame.colour = static_cast<std::size_t>(*pair->colour);
      frame.colour_after_depth_s = pair->colour_after_depth_s;
    }
  }
};

}  // namespace

std::optional<FakenectLine> parse_fakenect_line(std::string_view line) {
  const std::size_t dot = line.rfind('.');
  const std::size_t dash = line.rfind('-', dot);
  if (line.size() < 2 || line[1] != '-' || std::string_view("dra").find(line[0]) == std::string_view::npos)
    return {};
  if (dot == std::string_view::npos || dash == std::string_view::npos || dash < 2) return {};
  const std::string_view extension = line[0] == 'd' ? ".pgm" : line[0] == 'r' ? ".ppm" : ".dump";
  if (line.substr(dot) != extension) return {};
  const auto time_s = parse_number(line.substr(2, dash - 2));
  const auto ticks = parse_whole_number(line.substr(dash + 1, dot - dash - 1));
  if (!time_s || !std::isfinite(*time_s) || !ticks || *ticks < 0 || *ticks > UINT32_MAX) return {};
  return FakenectLine{line[0], static_cast<std::uint32_t>(*ticks)};
}

bool is_fakenect_dump(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / "INDEX.txt", ignored);
}

RecordingFacts index_fakenect_dump(const fs::path& folder) {
  constexpr std::uintmax_t kMaxList_bytes = std::uintmax_t{1} << 30;
  const fs::path index_file = folder / "INDEX.txt";
  std::istringstream lines(read_bytes(index_file, "a list of files", kMaxList_bytes));

  RecordingFacts facts{.name = fs::canonical(folder).string()};
  FakenectIndex index(folder, facts);
  std::int64_t bad_lines = 0;
  std::string first_bad;
  int line_number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++line_number;
    if (line.ends_with('\r')) line.pop_back();
    if (line.empty()) continue;
    const auto parsed = parse_fakenect_line(line);
    if (parsed)
      index.add(line, *parsed);
    else if (bad_lines++ == 0)
      first_bad = "line " + std::to_string(line_number) + ": '" + line.substr(0, 60) +
                  "' is not of the form d-TIME-STAMP.pgm, r-TIME-STAMP.ppm or a-TIME-STAMP.dump";
  }
  index.finish();
  if (bad_lines > 0)
    facts.notes.push_back({"images",
                           std::to_string(bad_lines) +
                               (bad_lines == 1 ? " line of INDEX.txt is left out: "
                                               : " lines of INDEX.txt are left out, the first: ") +
                               first_bad,
                           bad_lines});
  if (facts.frames.empty()) return facts;

  const std::vector<std::string>& depth_files = index.depth_files;
  const std::vector<std::string>& colour_files = index.colour_files;
  const ImageSize size = size_of_images({depth_files.begin(), depth_files.end()}, folder);
  std::optional<ImageSize> colour_size;
  if (!colour_files.empty()) colour_size = size_of_images({colour_files.begin(), colour_files.end()}, folder);
  facts.rig = nominal_rig(NominalRig::kKinect, size, colour_size);
  facts.camera_origin = Origin::kAssumed;
  facts.camera_source = nominal_name(NominalRig::kKinect);
  facts.depth_unit_m = depth_unit_m(DepthEncoding::kKinectRaw);
  facts.unit_source = "the disparity of a Kinect v1";
  facts.read_depth = [depth_files](std::size_t frame, double unit_m, DepthImage& depth_m) {
    read_depth_file(depth_files[frame], DepthEncoding::kKinectRaw, unit_m, depth_m);
  };
  facts.read_colour = [colour_files](std::size_t colour, ColourImage& image) {
    read_colour_file(colour_files[colour], image);
  };
  return facts;
}

}  // namespace roomradar
