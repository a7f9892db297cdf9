// fibonacci_hash.hpp: multiplicative hash of an integer, for hash tables and for decorrelated indices.
#pragma once
#include <cstdint>

namespace roomradar {

/// Returns x times the odd integer nearest to 2^64 / golden ratio, modulo 2^64. Distinct numbers have distinct
/// hashes. Bit i of the hash depends on bits 0 to i of x only, so take the upper bits.
/// Source: Knuth, The Art of Computer Programming, volume 3, section 6.4.
constexpr std::uint64_t fibonacci_hash(std::uint64_t x) { return x * 0x9E37'79B9'7F4A'7C15U; }

}  // namespace roomradar
