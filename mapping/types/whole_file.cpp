// whole_file.cpp: write beside, sync, rename.
#include "mapping/types/whole_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include "mapping/types/error.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
  throw Error(path.string() + ": cannot be written: " + reason +
              "; is the disk full, is the folder there, and may you write in it?");
}

bool reaches_disk(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool synced = ::fsync(file) == 0;
  ::close(file);
  return synced;
}

}  // namespace

WholeFile::WholeFile(const fs::path& target) : target_(target) {
  std::error_code fault;
  if (fs::is_symlink(target, fault) && fs::exists(target, fault)) {
    const fs::path real = fs::canonical(target, fault);
    if (!fault) target_ = real;  // none has the pipe behind /dev/stdout
  }
  const bool is_plain = !fs::exists(target_, fault) || fs::is_regular_file(target_, fault);
  partial_ = target_;
  if (is_plain) partial_ += ".partial-" + std::to_string(::getpid());
  errno = 0;
  stream_.open(partial_, std::ios::binary | std::ios::trunc);
  if (!stream_) fail(target, std::strerror(errno));
}

WholeFile::~WholeFile() {
  if (partial_ == target_) return;
  stream_.close();
  std::error_code ignored;
  fs::remove(partial_, ignored);
}

void WholeFile::put_in_place() {
  errno = 0;
  stream_.close();
  if (!stream_) fail(target_, errno != 0 ? std::strerror(errno) : "not all of it was taken");
  if (partial_ == target_) return;
  std::error_code fault;
  if (fs::exists(target_, fault) && !reaches_disk(partial_)) fail(target_, std::strerror(errno));
  fs::rename(partial_, target_, fault);
  if (fault) fail(target_, fault.message());
  partial_ = target_;
}

}  // namespace roomradar
