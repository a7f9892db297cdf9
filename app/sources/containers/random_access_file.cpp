// random_access_file.cpp: positioned reads with pread().
#include "app/sources/containers/random_access_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

RandomAccessFile::RandomAccessFile(const std::filesystem::path& path) : name_(path.string()) {
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // a pipe must not block
  if (descriptor_ < 0) throw Error(name_ + ": cannot be opened: " + system_reason(errno));
  struct stat status = {};
  if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    throw Error(name_ + ": is not a regular file");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

RandomAccessFile::~RandomAccessFile() { ::close(descriptor_); }

std::string RandomAccessFile::read(std::uint64_t offset, std::uint64_t count) const {
  if (!has(offset, count))
    throw Error(name_ + ": is cut short: " + std::to_string(count) + " bytes are expected at byte " +
                std::to_string(offset) + ", but the file ends at byte " + std::to_string(size_));
  std::string bytes(count, '\0');
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t got =
        ::pread(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw Error(name_ + ": cannot be read: " + system_reason(errno));
    if (got == 0) throw Error(name_ + ": became shorter while it was read");
    done += static_cast<std::size_t>(got);
  }
  return bytes;
}

std::string RandomAccessFile::read_up_to(std::uint64_t offset, std::uint64_t count) const {
  return offset >= size_ ? std::string{} : read(offset, std::min(count, size_ - offset));
}

bool begins_with(const std::filesystem::path& path, std::string_view bytes) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) &&
         RandomAccessFile(path).read_up_to(0, bytes.size()) == bytes;
}

}  // namespace roomradar
