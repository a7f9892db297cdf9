// model_folder.hpp: files that a model file names: found only within the model's own folder.
#pragma once
#include <filesystem>
#include <string>

namespace roomradar {

/// A file that a model names.
struct NamedFile {
  std::filesystem::path path;  ///< empty if the file cannot or must not be read
  std::string fault;  ///< why, as the end of a sentence, such as "is missing"; empty if `path` is set
};

/// Looks up a file that a model names, relative to the model's folder. Links are followed. A file outside of
/// the model's folder, a folder, a pipe and a device are faults, and are not opened.
NamedFile file_in_folder_of(const std::filesystem::path& model, const std::filesystem::path& name);

}  // namespace roomradar
