// command_to_resume.cpp: the line as given, or that of a scan begun by the program itself.
#include "app/scan/command_to_resume.hpp"

#include <algorithm>
#include <vector>

#include "app/cli/shell_line.hpp"

namespace roomradar {

std::string command_to_resume(const PrescanOptions& options) {
  std::vector<std::string> words = options.line;
  if (words.empty()) {
    words = {"roomradar", "prescan", options.source, "--map", options.map};
    if (!options.calibration.empty()) words.insert(words.end(), {"--calibration", options.calibration});
    if (options.window) words.emplace_back("--window");
  }
  if (std::find(words.begin(), words.end(), "--resume") == words.end()) words.emplace_back("--resume");
  return shell_line(words);
}

}  // namespace roomradar
