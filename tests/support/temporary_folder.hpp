// temporary_folder.hpp: a new folder for one test, removed with its contents; what desktops leave in folders,
// as on a stick that went through a Mac, KDE and Windows.
#pragma once
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace roomradar::test {

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "roomradar-test-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder can be made");
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Adds litter to a folder and those below: a resource fork "._FILE" beside each file, and files of desktops.
inline void add_litter(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  const std::string fork("\0\x05\x16\x07\0\x02\0\0Mac OS X        ", 24);
  std::vector<fs::path> folders = {folder}, files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    (entry.is_directory() ? folders : files).push_back(entry.path());
  for (const fs::path& file : files)
    std::ofstream(file.parent_path() / ("._" + file.filename().string()), std::ios::binary) << fork;
  for (const fs::path& each : folders) {
    for (const char* name : {".DS_Store", ".directory", "Thumbs.db", "desktop.ini"})
      std::ofstream(each / name, std::ios::binary) << fork;
    fs::create_directories(each / "__MACOSX");
    std::ofstream(each / "__MACOSX" / "._x", std::ios::binary) << fork;
  }
}

}  // namespace roomradar::test
