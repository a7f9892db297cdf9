// content_hashes.cpp: a folder's hash is that of the sorted list of its files and their hashes.
#include "app/farm/content_hashes.hpp"

#include <algorithm>
#include <exception>
#include <fstream>
#include <locale>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include "mapping/storage/sha256.hpp"
#include "mapping/types/system/atomic_file.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/folders.hpp"

namespace roomradar {

namespace fs = std::filesystem;

ContentHashes::ContentHashes(fs::path memory) : memory_(std::move(memory)) {
  std::ifstream file(memory_);
  for (std::string line; std::getline(file, line);) {
    std::istringstream in(line);
    in.imbue(std::locale::classic());
    Known known;
    std::string path;
    if (in >> known.sha256 >> known.size >> known.changed && in.get() == ' ' && std::getline(in, path) &&
        known.sha256.size() == 64)
      known_[path] = known;
  }
}

std::string ContentHashes::of_file(const fs::path& path) {
  const std::string name = fs::absolute(path).lexically_normal().string();
  const std::uintmax_t size = fs::file_size(path);
  const std::int64_t changed = fs::last_write_time(path).time_since_epoch().count();
  bytes_ += size;
  Known& known = known_[name];
  if (known.sha256.empty() || known.size != size || known.changed != changed) {
    known = {size, changed, sha256_of_file(path)};
    has_news_ = true;
  }
  return known.sha256;
}

std::string ContentHashes::of(const fs::path& path) {
  try {
    if (!fs::is_directory(path)) return of_file(path);
    std::vector<std::pair<std::string, fs::path>> files;
    constexpr auto kFollow = fs::directory_options::follow_directory_symlink;
    for (auto each = fs::recursive_directory_iterator(path, kFollow); each != fs::end(each); ++each) {
      if (is_hidden_file(each->path().filename().string()))
        each.disable_recursion_pending();
      else if (each->is_regular_file())
        files.emplace_back(each->path().lexically_relative(path).generic_string(), each->path());
    }
    std::sort(files.begin(), files.end());
    std::string list;
    for (const auto& [name, file] : files) list += of_file(file) + " " + name + "\n";
    return sha256_of(list);
  } catch (const fs::filesystem_error& error) {
    throw Error(path.string() + ": cannot be read: " + system_reason(error.code()));
  }
}

void ContentHashes::save() const noexcept {
  if (!has_news_) return;
  try {
    AtomicFile file(memory_);
    for (const auto& [path, known] : known_)
      if (path.find('\n') == std::string::npos)
        file.stream() << known.sha256 << ' ' << known.size << ' ' << known.changed << ' ' << path << '\n';
    file.commit();
  } catch (const std::exception&) {
  }
}

}  // namespace roomradar
