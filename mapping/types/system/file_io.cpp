// file_io.cpp: checks a file's kind and size before reading it.
#include "mapping/types/system/file_io.hpp"

#include <fstream>
#include <system_error>

#include "mapping/types/system/error.hpp"

namespace roomradar {

namespace fs = std::filesystem;

std::string read_bytes(const fs::path& path, std::string_view what, std::uintmax_t max_bytes) {
  std::error_code fault;
  const fs::file_status status = fs::status(path, fault);
  if (status.type() == fs::file_type::not_found)
    throw Error(path.string() + ": is missing; wanted " + std::string(what));
  if (!fs::status_known(status)) throw Error(path.string() + ": cannot be read: " + fault.message());
  if (!fs::is_regular_file(status))
    throw Error(path.string() + ": is no plain file; wanted " + std::string(what));
  const std::uintmax_t size = fs::file_size(path, fault);
  if (fault) throw Error(path.string() + ": cannot be read: " + fault.message());
  if (size > max_bytes)
    throw Error(path.string() + ": has " + std::to_string(size) + " bytes, too many for " +
                std::string(what));
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(path.string() + ": cannot be opened; may you read it?");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (!file.read(bytes.data(), static_cast<std::streamsize>(size)))
    throw Error(path.string() + ": cannot be read to its end");
  return bytes;
}

void write_bytes(const fs::path& path, std::string_view bytes) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  const bool was_opened = file.is_open();
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  std::error_code ignored;
  if (was_opened && !file && fs::is_regular_file(path, ignored)) fs::remove(path, ignored);
  require_written(file, path);
}

void require_written(const std::ios& stream, const fs::path& path) {
  if (!stream)
    throw Error(path.string() +
                ": cannot be written; is the disk full, is the folder there, and may you write in it?");
}

}  // namespace roomradar
