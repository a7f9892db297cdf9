// file_io.cpp: checks a file's kind and size before reading it.
#include "mapping/types/system/file_io.hpp"

#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>

#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

namespace fs = std::filesystem;

std::string read_bytes(const fs::path& path, std::string_view what, std::uintmax_t max_bytes) {
  std::error_code fault;
  const fs::file_status status = fs::status(path, fault);
  if (status.type() == fs::file_type::not_found)
    throw Error(path.string() + ": is missing; expected " + std::string(what));
  if (!fs::status_known(status)) throw Error(path.string() + ": cannot be read: " + system_reason(fault));
  if (!fs::is_regular_file(status))
    throw Error(path.string() + ": is not a regular file; expected " + std::string(what));
  const std::uintmax_t size = fs::file_size(path, fault);
  if (fault) throw Error(path.string() + ": cannot be read: " + system_reason(fault));
  if (size > max_bytes)
    throw Error(path.string() + ": has " + std::to_string(size) + " bytes, too many for " +
                std::string(what));
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(path.string() + ": cannot be opened; do you have permission to read it?");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (!file.read(bytes.data(), static_cast<std::streamsize>(size)))
    throw Error(path.string() + ": cannot be read to its end");
  return bytes;
}

void write_parts(const fs::path& path, std::initializer_list<std::string_view> parts) {
  errno = 0;
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  const bool was_opened = file.is_open();
  for (const std::string_view part : parts)
    file.write(part.data(), static_cast<std::streamsize>(part.size()));
  file.close();
  if (file) return;
  const int why = errno;
  std::error_code ignored;
  if (was_opened && fs::is_regular_file(path, ignored)) fs::remove(path, ignored);
  if (const std::string known = why_not_writable(path); known.empty() && why != 0)
    throw Error(path.string() + ": cannot be written: " + system_reason(why));
  require_written(file, path);
}

std::string why_not_writable(const fs::path& path) {
  constexpr std::uintmax_t kLeastFree_bytes = 1U << 20U;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code fault;
  if (!fs::exists(folder, fault)) return "the folder " + folder.string() + " does not exist; make it first";
  if (!fs::is_directory(folder, fault)) return folder.string() + " is not a folder";
  if (fs::is_directory(path, fault)) return "a folder has that name";
  const fs::space_info space = fs::space(folder, fault);
  if (!fault && space.capacity == 0)
    return "the system makes no files in " + folder.string() + "; choose another folder";
  if (!fault && space.available < kLeastFree_bytes)
    return "the disk is full; make room or choose another folder";
  const fs::path& opened = fs::exists(path, fault) ? path : folder;
  if (::access(opened.c_str(), W_OK) != 0)
    return "you may not write " + std::string(opened == path ? "it" : "in its folder") + " (" +
           system_reason(errno) + ")";
  return {};
}

void require_written(const std::ios& stream, const fs::path& path) {
  if (stream) return;
  const std::string why = why_not_writable(path);
  throw Error(
      path.string() + ": cannot be written: " +
      (why.empty() ? "the system refused it; was the disk full for a moment, or a size limit met?" : why));
}

}  // namespace roomradar
