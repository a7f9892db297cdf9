// fakenect_replay.hpp: a recording made fit to be replayed by fakenect, which trusts its files.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace roomradar {

inline constexpr const char* kFakenectPath = "FAKENECT_PATH";
/// What is in FAKENECT_PATH, where fakenect's library is loaded in libfreenect's place: it replays a
/// recording instead of a device. The variable alone does nothing.
std::optional<std::filesystem::path> replayed_folder();

/// fakenect reads beyond the end of an image that is cut short, and ends the process where a file is missing.
/// While one lives, a recording with such images is replayed from a folder of links to the sound ones.
class FakenectReplay {
 public:
  /// Throws Error if INDEX.txt cannot be read or names no sound depth image.
  explicit FakenectReplay(const std::filesystem::path& folder);
  ~FakenectReplay();
  FakenectReplay(const FakenectReplay&) = delete;
  FakenectReplay& operator=(const FakenectReplay&) = delete;

  /// What is wrong with depth images that are left out, by their place among all depth images, from 0.
  [[nodiscard]] const std::map<std::int64_t, std::string>& broken() const { return broken_; }

 private:
  std::filesystem::path folder_;
  std::filesystem::path links_;  ///< empty: all is sound
  std::map<std::int64_t, std::string> broken_;
};

}  // namespace roomradar
