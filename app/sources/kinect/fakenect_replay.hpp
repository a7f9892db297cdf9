// fakenect_replay.hpp: prepares a recording for replay by fakenect, libfreenect's replay library, which does
// not check files.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "app/sources/formats/scratch_folder.hpp"

namespace roomradar {

/// Environment variable that names the recording to replay.
inline constexpr const char* kFakenectPath = "FAKENECT_PATH";
/// Returns the folder in FAKENECT_PATH if fakenect is loaded instead of libfreenect, and thus replays the
/// folder's recording in place of a device. Returns nullopt if libfreenect is loaded, even if the variable is
/// set.
std::optional<std::filesystem::path> replayed_folder();

/// Protects the process from broken files. fakenect reads past the end of a truncated image, and exits if a
/// file is missing. While a FakenectReplay exists, a recording with broken files, or with lines of INDEX.txt of
/// another form, is replayed from a temporary folder of links to the intact files.
class FakenectReplay {
 public:
  /// Throws Error if INDEX.txt cannot be read or lists no intact depth image.
  explicit FakenectReplay(const std::filesystem::path& folder);
  ~FakenectReplay();
  FakenectReplay(const FakenectReplay&) = delete;
  FakenectReplay& operator=(const FakenectReplay&) = delete;

  /// Returns the fault of each omitted depth image. Keys are indices among all depth images of the recording,
  /// from 0.
  [[nodiscard]] const std::map<std::int64_t, std::string>& broken() const { return broken_; }

 private:
  std::filesystem::path folder_;
  /// Folder of links; unset if all files are intact.
  std::optional<ScratchFolder> links_;
  std::map<std::int64_t, std::string> broken_;
};

}  // namespace roomradar
