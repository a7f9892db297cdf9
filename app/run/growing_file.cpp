// growing_file.cpp: opens the file with its first line.
#include "app/run/growing_file.hpp"

#include <utility>

#include "mapping/types/system/file_io.hpp"

namespace roomradar {

GrowingFile::GrowingFile(std::filesystem::path path, std::string head)
    : path_(std::move(path)), head_(std::move(head)) {}

void GrowingFile::append(std::string_view line) {
  if (!file_.is_open()) {
    file_.open(path_, std::ios::trunc);
    file_ << head_;
    require_written(file_.flush(), path_);
  }
  file_ << line;
}

void GrowingFile::close() {
  if (!file_.is_open()) return;
  file_.close();
  require_written(file_, path_);
}

}  // namespace roomradar
