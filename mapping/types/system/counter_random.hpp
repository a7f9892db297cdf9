// counter_random.hpp: counter-based random numbers: a pure function of seed and counter.
#pragma once
#include <cstdint>

namespace roomradar {

/// Finaliser of splitmix64. Flipping any input bit flips about half of the output bits. Source: Steele, Lea,
/// Flood, Fast Splittable Pseudorandom Number Generators, OOPSLA 2014.
inline std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}
inline std::uint64_t hash_of(std::uint64_t a, std::uint64_t b) { return mixed(mixed(a) ^ b); }
inline std::uint64_t hash_of(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  return mixed(hash_of(a, b) ^ c);
}

/// Maps a hash to a number in [0, 1).
inline double unit_interval(std::uint64_t hash) { return static_cast<double>(hash >> 11) * 0x1.0p-53; }

/// Maps a hash to an approximately standard normal number, the scaled sum of the hash's four 16-bit parts.
/// Mean 0, variance 1, magnitude at most 3.47.
inline float gaussian(std::uint64_t hash) {
  const auto part = [hash](int i) { return static_cast<float>((hash >> (16 * i)) & 0xffffU); };
  constexpr float kMean = 4.0F * 32767.5F;
  // Standard deviation of the sum: sqrt(4 / 12) * 65536.
  constexpr float kDeviation = 37837.227F;
  return (part(0) + part(1) + part(2) + part(3) - kMean) / kDeviation;
}

/// Generates a short sequence of random numbers, determined by a seed and a counter value (`position`).
class CounterRandom {
 public:
  CounterRandom(std::uint64_t seed, std::uint64_t position) : state_(hash_of(seed, position)) {}
  double uniform() { return unit_interval(state_ = mixed(state_)); }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

 private:
  std::uint64_t state_;
};

}  // namespace roomradar
