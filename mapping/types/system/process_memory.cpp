// process_memory.cpp: memory use from /proc and sysconf, and glibc's allocator.
#include "mapping/types/system/process_memory.hpp"

#include <malloc.h>
#include <unistd.h>

#include <fstream>

namespace roomradar {

std::size_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  std::size_t all_pages = 0, resident_pages = 0;
  if (!(file >> all_pages >> resident_pages)) return 0;
  return resident_pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

std::uint64_t machine_bytes() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), page_bytes = ::sysconf(_SC_PAGESIZE);
  if (pages <= 0 || page_bytes <= 0) return 0;
  return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page_bytes);
}

void release_unused_memory() {
#ifdef __GLIBC__
  ::malloc_trim(0);
#endif
}

void mmap_large_allocations([[maybe_unused]] std::size_t least_bytes) {
#ifdef __GLIBC__
  // By default glibc raises the threshold to the size of the last freed block.
  ::mallopt(M_MMAP_THRESHOLD, static_cast<int>(least_bytes));
  // Several images of a frame. By default glibc returns every free 128 kB at the end of a heap to the system,
  // and each frame would take the pages again.
  ::mallopt(M_TRIM_THRESHOLD, 8 << 20);
#endif
}

}  // namespace roomradar
