// recording_list.cpp: names and sources, line by line.
#include "app/building/recording_list.hpp"

#include <algorithm>
#include <sstream>

#include "app/farm/manifest.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

constexpr std::uintmax_t kLargestList_bytes = 64U << 20U;
constexpr const char* kBlanks = " \t\r";

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  return first == std::string::npos ? std::string()
                                    : text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

}  // namespace

std::vector<ListedRecording> read_recording_list(const std::filesystem::path& path) {
  std::istringstream lines(read_bytes(path, "a list of recordings", kLargestList_bytes));
  std::vector<ListedRecording> recordings;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    line = trimmed(line);
    if (line.empty() || line.front() == '#') continue;
    const std::size_t colon = line.find(':');
    ListedRecording recording{trimmed(line.substr(0, colon)),
                              colon == std::string::npos ? std::string() : trimmed(line.substr(colon + 1))};
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
