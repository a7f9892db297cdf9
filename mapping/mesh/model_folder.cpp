// model_folder.cpp: resolves links, and compares the result with the folder.
#include "mapping/mesh/model_folder.hpp"

#include <algorithm>
#include <system_error>

namespace roomradar {
namespace {

bool is_within(const std::filesystem::path& folder, const std::filesystem::path& path) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace

NamedFile file_in_folder_of(const std::filesystem::path& model, const std::filesystem::path& name) {
  namespace fs = std::filesystem;
  // The text may hold a byte 0, where the system would end it.
  if (name.empty() || name.native().find('\0') != std::string::npos) return {{}, "is missing"};
  std::error_code fault;
  const fs::path folder = fs::canonical(model.has_parent_path() ? model.parent_path() : fs::path("."), fault);
  if (fault) return {{}, "is missing"};
  const fs::path path = fs::weakly_canonical(folder / name, fault);
  if (fault) return {{}, "is missing"};
  if (!is_within(folder, path)) return {{}, "lies outside of the model's folder and is not read"};
  const fs::file_status status = fs::status(path, fault);
  if (!fs::exists(status)) return {{}, "is missing"};
  if (!fs::is_regular_file(status)) return {{}, "is not a plain file and is not read"};
  return {path, {}};
}

}  // namespace roomradar
