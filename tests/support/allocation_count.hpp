// allocation_count.hpp: counts heap allocations. Include in one file per executable only.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace roomradar::test {

inline std::atomic<std::size_t> allocations{0};

/// Returns null if memory is exhausted.
inline void* counted_or_null(std::size_t size, std::size_t alignment) noexcept {
  ++allocations;
  const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
  return std::aligned_alloc(alignment, rounded == 0 ? alignment : rounded);
}

inline void* counted_allocation(std::size_t size, std::size_t alignment) {
  if (void* memory = counted_or_null(size, alignment)) return memory;
  throw std::bad_alloc();
}

/// Not inlined: if gcc inlines delete but not new, it warns of mismatched allocation functions.
[[gnu::noinline]] inline void give_back(void* memory) noexcept { std::free(memory); }

}  // namespace roomradar::test

void* operator new(std::size_t size) {
  return roomradar::test::counted_allocation(size, alignof(std::max_align_t));
}
void* operator new[](std::size_t size) {
  return roomradar::test::counted_allocation(size, alignof(std::max_align_t));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return roomradar::test::counted_allocation(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return roomradar::test::counted_allocation(size, static_cast<std::size_t>(alignment));
}
// The nothrow versions too: memory from a sanitizer's own operator new would be freed by the wrong delete.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return roomradar::test::counted_or_null(size, alignof(std::max_align_t));
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return roomradar::test::counted_or_null(size, alignof(std::max_align_t));
}
void* operator new(std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return roomradar::test::counted_or_null(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return roomradar::test::counted_or_null(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { roomradar::test::give_back(memory); }
void operator delete[](void* memory) noexcept { roomradar::test::give_back(memory); }
void operator delete(void* memory, std::size_t) noexcept { roomradar::test::give_back(memory); }
void operator delete[](void* memory, std::size_t) noexcept { roomradar::test::give_back(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { roomradar::test::give_back(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { roomradar::test::give_back(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  roomradar::test::give_back(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  roomradar::test::give_back(memory);
}
