// growing_file.hpp: a text file to which lines are appended during a run.
#pragma once
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace roomradar {

class GrowingFile {
 public:
  /// The file is not created or changed before the first line is appended.
  /// @param head  header, written before the first line; must include its end of line
  GrowingFile(std::filesystem::path path, std::string head);
  /// Appends a line, which must include its end of line. Throws Error if the file cannot be created.
  void append(std::string_view line);
  /// Closes the file. Throws Error if it could not be written completely.
  void close();

 private:
  std::filesystem::path path_;
  std::string head_;
  std::ofstream file_;
};

}  // namespace roomradar
