// feature_index.cpp: hash tables of descriptors, at randomly chosen bits.
#include "mapping/localization/feature_index.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "mapping/types/system/counter_random.hpp"

namespace roomradar {
namespace {

// Two descriptors of one feature differ in 30 of 256 bits on average, those of different features in about
// 110. With 20 bits, the former collide in 8 % of the tables, the latter in 0.001 %.
constexpr unsigned kTables = 16;
constexpr unsigned kBits = 20;        // per table
constexpr unsigned kBucketBits = 16;  // select the bucket; the others are stored with the entry
constexpr std::size_t kBuckets = 1U << kBucketBits;
constexpr unsigned kKeyframeBits = 24;  // of an entry; the other bits are those of the hash
static_assert(kBits - kBucketBits + kKeyframeBits <= 32);

using TableBits = std::array<std::array<std::uint8_t, kBits>, kTables>;

/// Draws the bits of each table, without repetition in one table.
TableBits draw_bits() {
  TableBits bits{};
  for (unsigned table = 0; table < kTables; ++table) {
    std::array<std::uint8_t, 256> left{};
    for (unsigned i = 0; i < left.size(); ++i) left[i] = static_cast<std::uint8_t>(i);
    CounterRandom random(0x66656174, table);
    for (unsigned i = 0; i < kBits; ++i) {
      const auto at = i + static_cast<unsigned>(random.uniform() * static_cast<double>(left.size() - i));
      std::swap(left[i], left[at]);
      bits[table][i] = left[i];
    }
  }
  return bits;
}

std::uint32_t hash_in(const std::array<std::uint8_t, kBits>& bits, const Descriptor& descriptor) {
  std::uint32_t hash = 0;
  for (const std::uint8_t bit : bits)
    hash = hash << 1U | (static_cast<std::uint32_t>(descriptor[bit >> 3U]) >> (bit & 7U) & 1U);
  return hash;
}

/// Calls visit(bucket, rest of the hash) for each indexed descriptor and table.
template <typename Visit>
void for_each_hash(std::span<const Descriptor> descriptors, const Visit& visit) {
  static const TableBits bits = draw_bits();
  const std::size_t count = std::min(descriptors.size(), FeatureIndex::kIndexedFeatures);
  for (unsigned table = 0; table < kTables; ++table)
    for (const Descriptor& descriptor : descriptors.first(count)) {
      const std::uint32_t hash = hash_in(bits[table], descriptor);
      visit(table * kBuckets + (hash & (kBuckets - 1)), hash >> kBucketBits);
    }
}

}  // namespace

void FeatureIndex::add(std::span<const Descriptor> descriptors) {
  static_assert(kMaxKeyframes < (1U << kKeyframeBits) &&
                kMaxKeyframes * kTables * kIndexedFeatures < 1ULL << 32U);
  first_.resize(kTables * kBuckets, 0);
  if (entries_.empty()) entries_.emplace_back();
  if (keyframes_ < kMaxKeyframes)
    for_each_hash(descriptors, [this](std::size_t bucket, std::uint32_t rest) {
      const std::uint32_t number = rest << kKeyframeBits | static_cast<std::uint32_t>(keyframes_);
      entries_.push_back(
          {number, std::exchange(first_[bucket], static_cast<std::uint32_t>(entries_.size()))});
    });
  ++keyframes_;
}

std::vector<std::size_t> FeatureIndex::candidates(std::span<const Descriptor> query, std::size_t count,
                                                  const std::function<bool(std::size_t)>& accept) const {
  if (keyframes_ == 0) return {};
  std::vector<std::uint32_t> collisions(std::min(keyframes_, kMaxKeyframes), 0);
  for_each_hash(query, [&](std::size_t bucket, std::uint32_t rest) {
    for (std::uint32_t at = first_[bucket]; at != 0; at = entries_[at].next) {
      const std::uint32_t entry = entries_[at].rest_and_keyframe;
      if (entry >> kKeyframeBits == rest) ++collisions[entry & ((1U << kKeyframeBits) - 1)];
    }
  });
  std::vector<std::pair<std::uint32_t, std::size_t>> found;  // sorts by count, then the older first
  for (std::size_t i = 0; i < collisions.size(); ++i)
    if (collisions[i] > 0 && (!accept || accept(i))) found.emplace_back(~collisions[i], i);
  const std::size_t kept = std::min(count, found.size());
  std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(kept), found.end());
  std::vector<std::size_t> best;
  best.reserve(kept);
  for (std::size_t i = 0; i < kept; ++i) best.push_back(found[i].second);
  return best;
}

}  // namespace roomradar
