// subfolders.cpp: lists folders without throwing.
#include "app/start/subfolders.hpp"

#include <algorithm>

#include "mapping/types/system/folders.hpp"

namespace roomradar {

namespace {

namespace fs = std::filesystem;

/// Returns the first entries, without hidden ones and litter, for which `is_wanted` is true.
template <typename IsWanted>
std::vector<fs::path> wanted_entries(const fs::path& folder, const IsWanted& is_wanted) {
  constexpr std::size_t kMaxEntries = 300;
  std::error_code fault;
  std::vector<fs::path> paths;
  for (fs::directory_iterator each(folder, fault), end; !fault && each != end && paths.size() < kMaxEntries;
       each.increment(fault)) {
    if (is_wanted(*each) && !is_hidden_file(each->path().filename().string()))
      paths.push_back(each->path().lexically_normal());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace

std::vector<fs::path> subfolders(const fs::path& folder) {
  return wanted_entries(folder, [](const fs::directory_entry& entry) {
    std::error_code ignored;
    return entry.is_directory(ignored);
  });
}

std::vector<fs::path> files_in_folder(const fs::path& folder) {
  return wanted_entries(folder, [](const fs::directory_entry& entry) {
    std::error_code ignored;
    return entry.is_regular_file(ignored);
  });
}

}  // namespace roomradar
