// frame_stream.hpp: results of each frame of a run as lines of JSON, for other programs.
//
// The lines are described by frame-stream.schema.json. The first has type "start", the last "end".
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "app/run/line_stream.hpp"
#include "app/session/session.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Version of the lines' format. Incremented if a key is removed or changes its meaning, not if a key is
/// added.
inline constexpr int kFrameStreamVersion = 1;

/// Returns the bounding boxes, in the world frame, of the mesh's connected components (by shared vertices),
/// sorted by descending number of triangles. Leaves out components with fewer triangles than `min_triangles`.
std::vector<Eigen::AlignedBox3d> component_boxes(const Mesh& mesh, std::size_t min_triangles);

/// Returns the runs of non-zero pixels, row by row from the top left, as pairs of first index and length.
std::vector<std::uint32_t> runs_of(const MaskImage& mask);

/// Writes the stream. A slow reader never delays the run, see LineStream.
class FrameStream {
 public:
  /// Opens the stream and writes its first line. Throws Error naming the file if it cannot be opened.
  /// @param path  file or named pipe; "-": standard output
  FrameStream(const std::filesystem::path& path, const std::string& source, const std::string& map);

  /// Writes a frame.
  /// @param run_frame  index of the frame in the run, from 0
  /// @param time_s     time since the run's first frame
  /// @param times      all stage times so far; stages timed since the last call are written
  void write(std::int64_t run_frame, double time_s, const Frame& frame, const FrameResult& result,
             const Session& session, const StageTimes& times);
  /// Writes the last line and closes the file. Throws Error if a regular file could not be written.
  void close();
  [[nodiscard]] const LineStream& lines() const { return lines_; }

 private:
  LineStream lines_;
  std::int64_t frames_ = 0;
  std::map<std::string, std::size_t, std::less<>> timed_;  ///< per stage: count at the last call
};

}  // namespace roomradar
