// recording_list.cpp: parses names and sources, line by line.
#include "app/building/recording_list.hpp"

#include <algorithm>
#include <sstream>
#include <string_view>

#include "app/farm/manifest.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

constexpr std::uintmax_t kLargestList_bytes = 64U << 20U;

}  // namespace

std::vector<ListedRecording> read_recording_list(const std::filesystem::path& path) {
  std::istringstream lines(read_bytes(path, "a list of recordings", kLargestList_bytes));
  std::vector<ListedRecording> recordings;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string_view text = trimmed(line);
    if (text.empty() || text.front() == '#') continue;
    const std::size_t colon = text.find(':');
    ListedRecording recording{
        std::string(trimmed(text.substr(0, colon))),
        std::string(colon == std::string_view::npos ? std::string_view() : trimmed(text.substr(colon + 1)))};
    if (!is_job_name(recording.name) || recording.source.empty())
      throw Error(path.string() + ", line " + std::to_string(number) +
                  ": must be a name, a colon and a recording, such as `hall: recordings/hall`; a name has "
                  "letters, digits, - _ .");
    recordings.push_back(std::move(recording));
  }
  if (recordings.empty())
    throw Error(path.string() + ": lists no recording; write a line `NAME: RECORDING` for each");
  const auto by_name = [](const ListedRecording& a, const ListedRecording& b) { return a.name < b.name; };
  std::sort(recordings.begin(), recordings.end(), by_name);
  const auto twice = std::adjacent_find(recordings.begin(), recordings.end(),
                                        [](const auto& a, const auto& b) { return a.name == b.name; });
  if (twice != recordings.end())
    throw Error(path.string() + ": the name '" + twice->name + "' stands for two recordings");
  return recordings;
}

}  // namespace roomradar
