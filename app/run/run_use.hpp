// run_use.hpp: run statistics: the fractions of the room's mesh and of the depth images that each frame used.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "app/run/growing_file.hpp"
#include "app/session/frame_result.hpp"

namespace roomradar {

struct VirtualObject;

/// Distribution of a fraction in 0..1 over many frames, in constant memory. Percentiles of at least 0.01 are
/// accurate to 1 % of their value, smaller ones to 0.0001.
class Shares {
 public:
  /// Adds the fraction part / whole.
  void add(std::size_t part, std::size_t whole);
  [[nodiscard]] double mean() const;
  /// Returns the value below which a fraction p (0 to 1) of the samples lies.
  [[nodiscard]] double percentile(double p) const;

 private:
  // Number of samples per bin; bins are uniform in the square root of the fraction.
  std::array<std::uint32_t, 1001> histogram_{};
  double sum_ = 0.0;
  std::size_t count_ = 0;
};

/// Sums and distributions over the localised frames of a run.
struct RunUse {
  /// Numbers of localised frames. frames_kept: an earlier rendering of the room was reused. frames_still: no
  /// pixels were meshed.
  std::size_t frames = 0, frames_kept = 0, frames_still = 0;
  /// Number of frames in which the dynamic mesh had full-resolution cells near some object.
  std::size_t frames_fine_near = 0;
  /// Number of the room's triangles in the last frame.
  std::size_t room_triangles = 0;
  /// Distributions over the frames. `drawn` and `asked` are fractions of the room's triangles (asked: tested
  /// by the radar). `meshed` is a fraction of the pixels with depth.
  Shares drawn, asked, meshed;
  /// Sums over the frames. room_asked counts room triangles tested by the radar. mesh_triangles counts
  /// triangles of the dynamic mesh.
  double room_drawn = 0.0, room_asked = 0.0, meshed_px = 0.0, mesh_triangles = 0.0;
  /// Sums over the frames of the dynamic mesh's cells by kind: flat, cut by a surface's boundary, and full
  /// resolution.
  double flat = 0.0, cut = 0.0, full = 0.0;
  /// Per object, number of frames in which the dynamic mesh had full-resolution cells near the object.
  std::map<std::string, std::size_t> frames_fine;

  /// Adds the counts of a localised frame.
  void add(const FrameUse& use, std::span<const std::unique_ptr<VirtualObject>> objects);
};

/// Returns the statistics as the value of the report's key `needed`.
nlohmann::json to_json(const RunUse& use);
/// Prints the statistics to stdout, in two lines.
void print_use(const RunUse& use);

/// Returns the reasons for a frame's counts in words, for --frames-csv. They are the camera's motion, the
/// dynamic fraction of the depth pixels, and the objects near which the mesh has full resolution.
std::string reasons_of(const FrameUse& use, std::span<const std::unique_ptr<VirtualObject>> objects);

/// Writes a CSV file with one line per localised frame.
class FrameUseFile {
 public:
  /// Does not create or change the file before the first frame is written.
  explicit FrameUseFile(std::filesystem::path path);
  /// Appends a frame. Throws Error if the file cannot be created.
  void write(std::int64_t frame, const FrameUse& use,
             std::span<const std::unique_ptr<VirtualObject>> objects);
  /// Closes the file. Throws Error if it could not be written completely.
  void close() { file_.close(); }

 private:
  GrowingFile file_;
};

}  // namespace roomradar
