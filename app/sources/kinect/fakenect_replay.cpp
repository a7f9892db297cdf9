// fakenect_replay.cpp: checks file sizes, and makes a folder of links to the intact files.
#include "app/sources/kinect/fakenect_replay.hpp"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <system_error>
#include <vector>

#include "app/sources/datasets/dataset_readers.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kDepthBytes = std::uintmax_t{640} * 480 * 2,
                         kColourBytes = std::uintmax_t{640} * 480 * 3;
constexpr std::streamsize kLongestHeader = 256;

/// Returns an empty string if fakenect can read an image from the file: a first line, then the pixels.
std::string fault_of(const fs::path& file, std::uintmax_t pixel_bytes) {
  std::error_code missing;
  const std::uintmax_t bytes = fs::file_size(file, missing);
  if (missing) return "cannot be read: " + system_reason(missing);
  if (pixel_bytes == 0) return bytes > 0 ? "" : "is empty";
  std::string head(kLongestHeader, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), kLongestHeader);
  const std::size_t line = head.find('\n');
  if (line == std::string::npos) return "has no header";
  if (bytes < line + 1 + pixel_bytes)
    return "is cut short: " + std::to_string(bytes) + " bytes of " + std::to_string(line + 1 + pixel_bytes);
  return {};
}

/// Creates a folder with links to these files of `folder`, and their INDEX.txt.
ScratchFolder folder_of_links(const fs::path& folder, const std::vector<std::string>& files) {
  ScratchFolder scratch;
  const fs::path& links = scratch.path();
  std::string index;
  for (const std::string& file : files) {
    std::error_code failed;
    fs::create_symlink(fs::absolute(folder / file), links / file, failed);
    if (failed && failed != std::errc::file_exists)  // a list may name a file twice
      throw Error((links / file).string() + ": cannot be made; is the disk full?");
    index += file + '\n';
  }
  if (fs::exists(folder / "camera.json"))  // also tells if the frames were calibrated already
    fs::create_symlink(fs::absolute(folder / "camera.json"), links / "camera.json");
  write_bytes(links / "INDEX.txt", index);
  return scratch;
}

}  // namespace

FakenectReplay::FakenectReplay(const fs::path& folder) : folder_(folder) {
  constexpr std::uintmax_t kMaxList_bytes = std::uintmax_t{1} << 30;
  std::istringstream list(read_bytes(folder / "INDEX.txt", "a list of files", kMaxList_bytes));
  std::vector<std::string> sound;
  bool all_sound = true;
  std::int64_t depth_images = 0;
  for (std::string line; std::getline(list, line);) {
    if (line.ends_with('\r')) line.pop_back(), all_sound = false;
    if (line.empty()) {
      all_sound = false;  // fakenect takes an empty line as the end
      continue;
    }
    const auto parsed = parse_fakenect_line(line);
    if (!parsed) {
      all_sound = false;  // fakenect opens any name, and waits for any time
      continue;
    }
    const bool is_depth = parsed->kind == 'd';
    const std::string fault = fault_of(folder / line, is_depth             ? kDepthBytes
                                                      : parsed->kind == 'r' ? kColourBytes
                                                                            : 0);
    if (fault.empty()) sound.push_back(line);
    all_sound = all_sound && fault.empty();
    if (is_depth && !fault.empty())
      broken_[depth_images] = "cannot be used: " + (folder / line).string() + " " + fault;
    depth_images += is_depth ? 1 : 0;
  }
  if (static_cast<std::int64_t>(broken_.size()) == depth_images)
    throw Error(folder.string() + ": contains no complete depth image");
  if (all_sound) return;

  links_ = folder_of_links(folder, sound);
  setenv(kFakenectPath, links_->path().c_str(), 1);
}

FakenectReplay::~FakenectReplay() {
  if (links_) setenv(kFakenectPath, folder_.c_str(), 1);
}

}  // namespace roomradar
