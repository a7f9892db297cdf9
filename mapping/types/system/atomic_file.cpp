// atomic_file.cpp: writes a partial file, syncs, renames.
#include "mapping/types/system/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <locale>
#include <string>
#include <system_error>

#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
  const std::string why = why_not_writable(path);
  throw Error(path.string() + ": cannot be written: " + (why.empty() ? reason : why));
}

bool reaches_disk(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool synced = ::fsync(file) == 0;
  ::close(file);
  return synced;
}

/// Returns STDOUT_FILENO or STDERR_FILENO if that stream is redirected to the file, else -1.
int stream_of_process(const fs::path& path) {
  struct stat file {
  }, stream{};
  if (::stat(path.c_str(), &file) != 0) return -1;
  for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO})
    if (::fstat(descriptor, &stream) == 0 && stream.st_dev == file.st_dev && stream.st_ino == file.st_ino)
      return descriptor;
  return -1;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& target) : target_(target) {
  std::error_code fault;
  if (fs::is_symlink(target, fault) && fs::exists(target, fault)) {
    const fs::path real = fs::canonical(target, fault);
    if (!fault) target_ = real;  // canonical() fails for the pipe behind /dev/stdout
  }
  const bool is_plain = !fs::exists(target_, fault) || fs::is_regular_file(target_, fault);
  if (is_plain) stream_of_process_ = stream_of_process(target_);
  const bool goes_on = stream_of_process_ >= 0;
  partial_ = target_;
  if (is_plain && !goes_on) partial_ += ".partial-" + std::to_string(::getpid());
  if (goes_on) std::fflush(nullptr);
  errno = 0;
  stream_.imbue(std::locale::classic());  // not that of the host program: numbers are written to it
  stream_.open(partial_, std::ios::binary | (goes_on ? std::ios::app : std::ios::trunc));
  if (!stream_) fail(target, system_reason(errno));
}

AtomicFile::~AtomicFile() {
  if (partial_ == target_) return;
  stream_.close();
  std::error_code ignored;
  fs::remove(partial_, ignored);
}

void AtomicFile::commit() {
  if (stream_) errno = 0;  // else a write has failed, and set it
  stream_.close();
  if (!stream_) fail(target_, errno != 0 ? system_reason(errno) : "not all of it was taken");
  if (stream_of_process_ >= 0)
    ::lseek(stream_of_process_, 0, SEEK_END);  // stdout keeps a separate file
                                               // offset
  if (partial_ == target_) return;
  std::error_code fault;
  if (fs::exists(target_, fault) && !reaches_disk(partial_)) fail(target_, system_reason(errno));
  fs::rename(partial_, target_, fault);
  if (fault) fail(target_, system_reason(fault));
  partial_ = target_;
}

}  // namespace roomradar
