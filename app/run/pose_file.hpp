// pose_file.hpp: a trajectory file that grows with the run.
#pragma once
#include <filesystem>
#include <fstream>

#include "mapping/types/trajectory.hpp"

namespace roomradar {

/// Writes poses to a file in the form of write_trajectory(), one by one.
class PoseFile {
 public:
  /// The file is not created or changed before the first pose is written.
  explicit PoseFile(std::filesystem::path path);
  /// Appends a pose. Throws Error if the file cannot be created.
  void write(const TimedPose& pose);
  /// Closes the file. Throws Error if it could not be written completely.
  void close();

 private:
  std::filesystem::path path_;
  std::ofstream file_;
};

}  // namespace roomradar
