// text_lists.hpp: text files with an entry per line: names, rows of numbers, poses.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/sources/datasets/recording_facts.hpp"

namespace roomradar {

/// Calls use(line, where) for each line that is neither empty nor a comment; `where` names file and line. Reads
/// UTF-8 with and without a byte order mark, UTF-16 of plain characters, and all three kinds of line ends.
/// Throws Error if the file cannot be read.
void for_each_line(const std::filesystem::path& path,
                   const std::function<void(std::string_view line, const std::string& where)>& use);

/// Lines that were left out of a list.
struct BadLines {
  std::size_t count = 0;
  std::string first;  ///< the first one's fault
  void add(const std::string& fault);
  /// Notes the lines of the file `name`, if there are any.
  void report(const char* topic, const std::string& name, RecordingFacts& facts) const;
};

/// Returns the rows of numbers of a file; empty if there is no such file. All rows have as many numbers as the
/// first, which is one of `counts`; other lines are noted in the facts. Rows with a number that is not finite
/// mean that nothing was measured, and are left out.
std::vector<std::vector<double>> read_rows(const std::filesystem::path& file, const char* topic,
                                           std::vector<std::size_t> counts, RecordingFacts& facts);

/// A line of a list of poses.
struct ListedPose {
  double stamp = kNoStamp;  ///< first number of the line, if it has one
  std::optional<Eigen::Isometry3d> T_world_camera;  ///< unset: the numbers are no rigid transform
};

struct ListedPoses {
  std::vector<ListedPose> poses{};
  bool are_stamped = false;  ///< false: one pose per depth image, in their order
};

/// Reads poses, one per line: translation and quaternion (x y z w), or the rows of a 3 x 4 or 4 x 4 matrix, with
/// or without a stamp before them. Notes a form other than that of TUM RGB-D. Returns no poses if there is no
/// such file, or if the lines have no stamps and there are not as many as depth images, which is noted.
ListedPoses read_pose_list(const std::filesystem::path& file, std::ptrdiff_t depth_images, RecordingFacts& facts);

}  // namespace roomradar
