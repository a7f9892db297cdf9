// simd8f.hpp: SIMD vector of eight floats (e.g. of eight sibling voxels), in an AVX2 and a portable version.
// Both versions give bit-identical results, since neither uses fused multiply-add. Maps are therefore
// bit-identical on every machine. Source files that use the versions must be compiled with -ffp-contract=off.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#if defined(__AVX2__)
#include <immintrin.h>
#endif

namespace roomradar {

/// Portable mask of eight lanes. Compilers vectorise the loops. Comparisons with NaN are false.
struct PortableMask8 {
  std::array<bool, 8> v;
  static PortableMask8 of_bits(unsigned bits) {
    PortableMask8 m;
    for (unsigned i = 0; i < 8; ++i) m.v[i] = (bits >> i & 1U) != 0;
    return m;
  }
  [[nodiscard]] unsigned bits() const {
    unsigned bits = 0;
    for (unsigned i = 0; i < 8; ++i) bits |= static_cast<unsigned>(v[i]) << i;
    return bits;
  }
};

struct PortableFloat8 {
  using Mask = PortableMask8;
  alignas(32) std::array<float, 8> v;

  PortableFloat8() = default;
  PortableFloat8(float all) { v.fill(all); }
  template <typename Number>
  static PortableFloat8 load(const std::array<Number, 8>& from) {
    PortableFloat8 out;
    for (unsigned i = 0; i < 8; ++i) out.v[i] = static_cast<float>(from[i]);
    return out;
  }
  static PortableFloat8 load(const float* eight) {
    PortableFloat8 out;
    std::copy_n(eight, 8, out.v.begin());
    return out;
  }
  void store(std::array<float, 8>& to) const { to = v; }
  /// Stores the values rounded towards zero. Values must be within the range of int.
  void store_truncated(std::array<int, 8>& to) const {
    for (unsigned i = 0; i < 8; ++i) to[i] = static_cast<int>(v[i]);
  }
  /// Stores the values rounded to the nearest integer, halves upwards, and clamped to the 16-bit range.
  template <typename Int16>
  void store_rounded(std::array<Int16, 8>& to) const {
    for (unsigned i = 0; i < 8; ++i) {
      const float within =
          std::clamp(std::floor(v[i] + 0.5F), static_cast<float>(std::numeric_limits<Int16>::min()),
                     static_cast<float>(std::numeric_limits<Int16>::max()));
      to[i] = static_cast<Int16>(within);
    }
  }
  /// Returns base[index] for each lane, or 0 where the mask is false. Indices are integers below 2^24.
  static PortableFloat8 gather(const float* base, const PortableFloat8& index, const Mask& mask) {
    PortableFloat8 out;
    for (unsigned i = 0; i < 8; ++i) out.v[i] = mask.v[i] ? base[static_cast<int>(index.v[i])] : 0.0F;
    return out;
  }
  /// Reads N = 4 or 8 floats of each row, and returns these N columns.
  template <std::size_t N>
  static std::array<PortableFloat8, N> columns(const std::array<const float*, 8>& rows) {
    std::array<PortableFloat8, N> out;
    for (std::size_t column = 0; column < N; ++column)
      for (std::size_t row = 0; row < 8; ++row) out[column].v[row] = rows[row][column];
    return out;
  }
};

namespace plain {
template <typename Op>
PortableFloat8 each(const PortableFloat8& a, const PortableFloat8& b, const Op& op) {
  PortableFloat8 out;
  for (unsigned i = 0; i < 8; ++i) out.v[i] = op(a.v[i], b.v[i]);
  return out;
}
template <typename Op>
PortableMask8 test(const PortableFloat8& a, const PortableFloat8& b, const Op& op) {
  PortableMask8 out;
  for (unsigned i = 0; i < 8; ++i) out.v[i] = op(a.v[i], b.v[i]);
  return out;
}
}  // namespace plain

inline PortableFloat8 operator+(const PortableFloat8& a, const PortableFloat8& b) {
  return plain::each(a, b, [](float x, float y) { return x + y; });
}
inline PortableFloat8 operator-(const PortableFloat8& a, const PortableFloat8& b) {
  return plain::each(a, b, [](float x, float y) { return x - y; });
}
inline PortableFloat8 operator*(const PortableFloat8& a, const PortableFloat8& b) {
  return plain::each(a, b, [](float x, float y) { return x * y; });
}
inline PortableFloat8 operator/(const PortableFloat8& a, const PortableFloat8& b) {
  return plain::each(a, b, [](float x, float y) { return x / y; });
}
/// Returns b if a or b is NaN, like max().
inline PortableFloat8 min(const PortableFloat8& a, const PortableFloat8& b) {
  return plain::each(a, b, [](float x, float y) { return x < y ? x : y; });
}
inline PortableFloat8 max(const PortableFloat8& a, const PortableFloat8& b) {
  return plain::each(a, b, [](float x, float y) { return x > y ? x : y; });
}
inline PortableFloat8 abs(const PortableFloat8& a) { return max(a, PortableFloat8(0.0F) - a); }
inline PortableFloat8 floor(const PortableFloat8& a) {
  return plain::each(a, a, [](float x, float) { return std::floor(x); });
}
inline PortableFloat8 sqrt(const PortableFloat8& a) {
  return plain::each(a, a, [](float x, float) { return std::sqrt(x); });
}
/// Returns, per lane, the largest power of two that is at most |a|. Requires normal numbers (not zero,
/// denormal, infinite or NaN).
inline PortableFloat8 power_of_two_within(const PortableFloat8& a) {
  return plain::each(a, a, [](float x, float) {
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) & 0x7F80'0000U);
  });
}
inline PortableMask8 operator<(const PortableFloat8& a, const PortableFloat8& b) {
  return plain::test(a, b, [](float x, float y) { return x < y; });
}
inline PortableMask8 operator<=(const PortableFloat8& a, const PortableFloat8& b) {
  return plain::test(a, b, [](float x, float y) { return x <= y; });
}
inline PortableMask8 operator==(const PortableFloat8& a, const PortableFloat8& b) {
  return plain::test(a, b, [](float x, float y) { return x == y; });
}
inline PortableMask8 operator&(const PortableMask8& a, const PortableMask8& b) {
  PortableMask8 out;
  for (unsigned i = 0; i < 8; ++i) out.v[i] = a.v[i] && b.v[i];
  return out;
}
inline PortableMask8 operator|(const PortableMask8& a, const PortableMask8& b) {
  PortableMask8 out;
  for (unsigned i = 0; i < 8; ++i) out.v[i] = a.v[i] || b.v[i];
  return out;
}
inline PortableFloat8 select(const PortableMask8& mask, const PortableFloat8& yes, const PortableFloat8& no) {
  PortableFloat8 out;
  for (unsigned i = 0; i < 8; ++i) out.v[i] = mask.v[i] ? yes.v[i] : no.v[i];
  return out;
}

#if defined(__AVX2__)

struct Avx2Mask8 {
  __m256 v;
  static Avx2Mask8 of_bits(unsigned bits) {
    const __m256i one_each = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    const __m256i own = _mm256_and_si256(_mm256_set1_epi32(static_cast<int>(bits)), one_each);
    return {_mm256_castsi256_ps(_mm256_cmpeq_epi32(own, one_each))};
  }
  [[nodiscard]] unsigned bits() const { return static_cast<unsigned>(_mm256_movemask_ps(v)); }
};

struct Avx2Float8 {
  using Mask = Avx2Mask8;
  __m256 v;

  Avx2Float8() = default;
  Avx2Float8(__m256 all) : v(all) {}
  Avx2Float8(float all) : v(_mm256_set1_ps(all)) {}
  static Avx2Float8 load(const float* eight) { return _mm256_loadu_ps(eight); }
  static Avx2Float8 load(const std::array<float, 8>& from) { return load(from.data()); }
  static Avx2Float8 load(const std::array<std::int16_t, 8>& from) {
    return _mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(eight(from)));
  }
  static Avx2Float8 load(const std::array<std::uint16_t, 8>& from) {
    return _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(eight(from)));
  }
  void store(std::array<float, 8>& to) const { _mm256_storeu_ps(to.data(), v); }
  void store_truncated(std::array<int, 8>& to) const {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to.data()), _mm256_cvttps_epi32(v));
  }
  void store_rounded(std::array<std::int16_t, 8>& to) const {
    const __m256i whole = rounded();
    put(_mm_packs_epi32(_mm256_castsi256_si128(whole), _mm256_extracti128_si256(whole, 1)), to);
  }
  void store_rounded(std::array<std::uint16_t, 8>& to) const {
    const __m256i whole = rounded();
    put(_mm_packus_epi32(_mm256_castsi256_si128(whole), _mm256_extracti128_si256(whole, 1)), to);
  }
  static Avx2Float8 gather(const float* base, const Avx2Float8& index, const Mask& mask) {
    return _mm256_mask_i32gather_ps(_mm256_setzero_ps(), base, _mm256_cvttps_epi32(index.v), mask.v, 4);
  }
  template <std::size_t N>
  static std::array<Avx2Float8, N> columns(const std::array<const float*, 8>& rows) {
    static_assert(N == 4 || N == 8);
    // Transposes four floats of each row.
    const auto of_half = [&](std::size_t first) {
      const auto rows_at = [&](std::size_t row) {
        return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(rows[row] + first)),
                                    _mm_loadu_ps(rows[row + 4] + first), 1);
      };
      const __m256 a = rows_at(0), b = rows_at(1), c = rows_at(2), d = rows_at(3);
      const __m256 ab_low = _mm256_unpacklo_ps(a, b), ab_high = _mm256_unpackhi_ps(a, b);
      const __m256 cd_low = _mm256_unpacklo_ps(c, d), cd_high = _mm256_unpackhi_ps(c, d);
      return std::array<Avx2Float8, 4>{_mm256_shuffle_ps(ab_low, cd_low, _MM_SHUFFLE(1, 0, 1, 0)),
                                       _mm256_shuffle_ps(ab_low, cd_low, _MM_SHUFFLE(3, 2, 3, 2)),
                                       _mm256_shuffle_ps(ab_high, cd_high, _MM_SHUFFLE(1, 0, 1, 0)),
                                       _mm256_shuffle_ps(ab_high, cd_high, _MM_SHUFFLE(3, 2, 3, 2))};
    };
    const std::array<Avx2Float8, 4> left = of_half(0);
    if constexpr (N == 4) {
      return left;
    } else {
      const std::array<Avx2Float8, 4> right = of_half(4);
      return {left[0], left[1], left[2], left[3], right[0], right[1], right[2], right[3]};
    }
  }

 private:
  template <typename Int16>
  static __m128i eight(const std::array<Int16, 8>& from) {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from.data()));
  }
  template <typename Int16>
  static void put(__m128i eight, std::array<Int16, 8>& to) {
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to.data()), eight);
  }
  [[nodiscard]] __m256i rounded() const {
    return _mm256_cvttps_epi32(_mm256_floor_ps(_mm256_add_ps(v, _mm256_set1_ps(0.5F))));
  }
};

inline Avx2Float8 operator+(const Avx2Float8& a, const Avx2Float8& b) { return _mm256_add_ps(a.v, b.v); }
inline Avx2Float8 operator-(const Avx2Float8& a, const Avx2Float8& b) { return _mm256_sub_ps(a.v, b.v); }
inline Avx2Float8 operator*(const Avx2Float8& a, const Avx2Float8& b) { return _mm256_mul_ps(a.v, b.v); }
inline Avx2Float8 operator/(const Avx2Float8& a, const Avx2Float8& b) { return _mm256_div_ps(a.v, b.v); }
inline Avx2Float8 min(const Avx2Float8& a, const Avx2Float8& b) { return _mm256_min_ps(a.v, b.v); }
inline Avx2Float8 max(const Avx2Float8& a, const Avx2Float8& b) { return _mm256_max_ps(a.v, b.v); }
inline Avx2Float8 abs(const Avx2Float8& a) { return max(a, Avx2Float8(0.0F) - a); }
inline Avx2Float8 floor(const Avx2Float8& a) { return _mm256_floor_ps(a.v); }
inline Avx2Float8 sqrt(const Avx2Float8& a) { return _mm256_sqrt_ps(a.v); }
inline Avx2Float8 power_of_two_within(const Avx2Float8& a) {
  return _mm256_and_ps(a.v, _mm256_castsi256_ps(_mm256_set1_epi32(0x7F80'0000)));
}
inline Avx2Mask8 operator<(const Avx2Float8& a, const Avx2Float8& b) {
  return {_mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ)};
}
inline Avx2Mask8 operator<=(const Avx2Float8& a, const Avx2Float8& b) {
  return {_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ)};
}
inline Avx2Mask8 operator==(const Avx2Float8& a, const Avx2Float8& b) {
  return {_mm256_cmp_ps(a.v, b.v, _CMP_EQ_OQ)};
}
inline Avx2Mask8 operator&(const Avx2Mask8& a, const Avx2Mask8& b) { return {_mm256_and_ps(a.v, b.v)}; }
inline Avx2Mask8 operator|(const Avx2Mask8& a, const Avx2Mask8& b) { return {_mm256_or_ps(a.v, b.v)}; }
inline Avx2Float8 select(const Avx2Mask8& mask, const Avx2Float8& yes, const Avx2Float8& no) {
  return _mm256_blendv_ps(no.v, yes.v, mask.v);
}

#endif

/// Version of the arithmetic on eight floats: the fastest that this compilation supports, or the portable
/// one. Both give bit-identical results.
enum class Arithmetic { kFastest, kPortable };

/// Fastest version that this compilation supports.
#if defined(__AVX2__)
using Float8 = Avx2Float8;
#else
using Float8 = PortableFloat8;
#endif

}  // namespace roomradar
