// subfolders.cpp: lists folders without throwing.
#include "app/start/subfolders.hpp"

#include <algorithm>

namespace roomradar {

std::vector<std::filesystem::path> subfolders(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  constexpr std::size_t kMaxFolders = 300;
  std::error_code fault;
  std::vector<fs::path> folders;
  for (fs::directory_iterator each(folder, fault), end; !fault && each != end && folders.size() < kMaxFolders;
       each.increment(fault)) {
    std::error_code ignored;
    if (each->is_directory(ignored) && !each->path().filename().string().starts_with('.'))
      folders.push_back(each->path().lexically_normal());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

}  // namespace roomradar
