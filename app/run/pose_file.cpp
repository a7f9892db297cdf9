// pose_file.cpp: opens the file with its first pose.
#include "app/run/pose_file.hpp"

#include <utility>

#include "mapping/types/system/file_io.hpp"

namespace roomradar {

PoseFile::PoseFile(std::filesystem::path path) : path_(std::move(path)) {}

void PoseFile::write(const TimedPose& pose) {
  if (!file_.is_open()) {
    file_.open(path_, std::ios::trunc);
    file_ << kTrajectoryHeader;
    require_written(file_.flush(), path_);
  }
  file_ << trajectory_line(pose);
}

void PoseFile::close() {
  if (!file_.is_open()) return;
  file_.close();
  require_written(file_, path_);
}

}  // namespace roomradar
