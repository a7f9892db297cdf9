// run_use.hpp: statistics of how much of the room and of the depth images a run's frames needed, with
// reasons.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "app/session/frame_use.hpp"

namespace roomradar {

struct VirtualObject;

/// Distribution of a fraction in 0..1 over many frames, in constant memory. Percentiles are accurate to 1 %
/// of their value from 0.01 up, and to 0.0001 below.
class Shares {
 public:
  void add(std::size_t part, std::size_t whole);
  [[nodiscard]] double mean() const;
  [[nodiscard]] double percentile(double p) const;

 private:
  std::array<std::uint32_t, 1001> histogram_{};  // bins are uniform in the square root
  double sum_ = 0.0;
  std::size_t count_ = 0;
};

/// Sums over the frames of a run.
struct RunUse {
  /// Localised frames; of these, frames with views_drawn = 0 and frames with meshed_px = 0.
  std::size_t frames = 0, frames_kept = 0, frames_still = 0;
  std::size_t room_triangles = 0;  ///< in the last frame
  /// Fractions of the room's triangles (drawn, asked), and of the pixels with depth (meshed).
  Shares drawn, asked, meshed;
  double room_drawn = 0.0, room_asked = 0.0, meshed_px = 0.0, mesh_triangles = 0.0;
  double flat = 0.0, cut = 0.0, full = 0.0;
  std::map<std::string, std::size_t> frames_fine;  ///< per object: frames with full-resolution cells near it

  void add(const FrameUse& use, std::span<const std::unique_ptr<VirtualObject>> objects);
};

/// Returns the report's key `needed`.
nlohmann::json to_json(const RunUse& use);
/// Prints two lines to stdout.
void print_use(const RunUse& use);

/// Returns the reasons in words, as in --frames-csv: whether the camera moved, the fraction of depth that
/// moved, and the objects near which the mesh has full resolution.
std::string reasons_of(const FrameUse& use, std::span<const std::unique_ptr<VirtualObject>> objects);

/// Writes a CSV file with a line per localised frame.
class FrameUseFile {
 public:
  /// The file is not touched before the first frame.
  explicit FrameUseFile(std::filesystem::path path);
  /// Throws Error if the file cannot be written.
  void write(std::int64_t frame, const FrameUse& use,
             std::span<const std::unique_ptr<VirtualObject>> objects);
  /// Throws Error if the file could not be written completely.
  void close();

 private:
  void open();

  std::filesystem::path path_;
  std::ofstream file_;
};

}  // namespace roomradar
