// fakenect_replay.hpp: prepares a recording for replay by fakenect, which does not check its files.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace roomradar {

inline constexpr const char* kFakenectPath = "FAKENECT_PATH";
/// Returns the folder named by FAKENECT_PATH if fakenect's library is loaded instead of libfreenect: fakenect
/// replays that recording in place of a device. Returns nothing otherwise, even if the variable is set.
std::optional<std::filesystem::path> replayed_folder();

/// fakenect reads past the end of a truncated image and ends the process if a file is missing. During this
/// object's life a recording with such images is replayed from a folder of links to the intact ones.
class FakenectReplay {
 public:
  /// Throws Error if INDEX.txt cannot be read or lists no intact depth image.
  explicit FakenectReplay(const std::filesystem::path& folder);
  ~FakenectReplay();
  FakenectReplay(const FakenectReplay&) = delete;
  FakenectReplay& operator=(const FakenectReplay&) = delete;

  /// Faults of the depth images left out, by index among all depth images, from 0.
  [[nodiscard]] const std::map<std::int64_t, std::string>& broken() const { return broken_; }

 private:
  std::filesystem::path folder_;
  std::filesystem::path links_;  ///< empty if all files are intact
  std::map<std::int64_t, std::string> broken_;
};

}  // namespace roomradar
