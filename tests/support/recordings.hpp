// recordings.hpp: locates the real recordings, which are not part of the repository.
#pragma once
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace roomradar::test {

/// Returns the folder of a recording: $ROOMRADAR_DATA/NAME, else ../shared/data/NAME beside the project;
/// nullopt if it is absent.
inline std::optional<std::filesystem::path> recording(const std::string& name) {
  const char* chosen = std::getenv("ROOMRADAR_DATA");
  const std::filesystem::path folder = std::filesystem::path(chosen ? chosen : ROOMRADAR_DATA_DEFAULT) / name;
  if (!std::filesystem::is_directory(folder)) return std::nullopt;
  return folder;
}

}  // namespace roomradar::test

/// Declares `variable` (a path), or skips the running test with a message if the recording is absent.
#define ROOMRADAR_RECORDING_OR_SKIP(variable, name)                                               \
  const auto variable##_found = ::roomradar::test::recording(name);                               \
  if (!variable##_found)                                                                          \
    GTEST_SKIP() << "recording '" << (name) << "' is not here; set ROOMRADAR_DATA to its folder"; \
  const std::filesystem::path& variable = *variable##_found
