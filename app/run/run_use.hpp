// run_use.hpp: how much of the room and of the depth images a run's frames needed, and why.
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

/// A share in 0..1 over many frames, in memory that does not grow; a percentile within 1 % of its value from
/// 0.01 on, within 0.0001 below.
class Shares {
 public:
  void add(std::size_t part, std::size_t whole);
  [[nodiscard]] double mean() const;
  [[nodiscard]] double percentile(double p) const;

 private:
  std::array<std::uint32_t, 1001> histogram_{};  // by square root
  double sum_ = 0.0;
  std::size_t count_ = 0;
};

/// Sums over the frames of a run.
struct RunUse {
  std::size_t frames = 0, frames_kept = 0, frames_still = 0;  ///< located; no view drawn; nothing moved
  std::size_t room_triangles = 0;                             ///< of the last frame
  Shares drawn, asked, meshed;  ///< of the room's triangles; of these; of the pixels with depth
  double room_drawn = 0.0, room_asked = 0.0, meshed_px = 0.0, mesh_triangles = 0.0;
  double flat = 0.0, cut = 0.0, full = 0.0;
  std::map<std::string, std::size_t>
      frames_fine;  ///< by object: frames with cells that are fine because of it

  void add(const FrameUse& use, std::span<const std::unique_ptr<VirtualObject>> objects);
};

/// The report's key `needed`.
nlohmann::json to_json(const RunUse& use);
/// Two lines on stdout.
void print_use(const RunUse& use);

/// Why that much, in words: "the camera moved; nothing moved", "the camera stands, the last view is kept; 3 %
/// of the depth moved; as fine as the image near pot (31 cells)".
std::string reasons_of(const FrameUse& use, std::span<const std::unique_ptr<VirtualObject>> objects);

/// A line of comma-separated values a frame that was located.
class FrameUseFile {
 public:
  /// Until the first frame the file is left as it was.
  explicit FrameUseFile(std::filesystem::path path);
  /// Throws Error if the file cannot be written.
  void write(std::int64_t frame, const FrameUse& use,
             std::span<const std::unique_ptr<VirtualObject>> objects);
  /// Throws Error if not all of it could be written.
  void close();

 private:
  void open();

  std::filesystem::path path_;
  std::ofstream file_;
};

}  // namespace roomradar
