// feature_index.cpp: locality-sensitive hashing of descriptors by bit sampling.
#include "mapping/localization/feature_index.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <utility>

#include "mapping/types/system/counter_random.hpp"

namespace roomradar {
namespace {

// Two descriptors of one feature differ in 30 of 256 bits on average, those of different features in about
// 110. With 20 bits, the former collide in 8 % of the tables, the latter in 0.001 %.
constexpr unsigned kTables = kFeatureTables;
constexpr unsigned kBits = kFeatureHashBits;
constexpr unsigned kBucketBits = 16;  // select the bucket; the others are stored with the entry
constexpr std::size_t kBuckets = 1U << kBucketBits;
constexpr unsigned kKeyframeBits = 24;  // of an entry; the other bits are those of the hash
static_assert(kBits - kBucketBits + kKeyframeBits <= 32);
constexpr std::uint32_t kKeyframeMask = (1U << kKeyframeBits) - 1;
constexpr std::size_t kMinSorted = 250 * kTables * FeatureIndex::kIndexedFeatures;  // entries

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

/// Calls visit(table, hash) for each table and descriptor.
template <typename Visit>
void for_each_hash(std::span<const Descriptor> descriptors, const Visit& visit) {
  static const TableBits bits = draw_bits();
  for (unsigned table = 0; table < kTables; ++table)
    for (const Descriptor& descriptor : descriptors) visit(table, hash_in(bits[table], descriptor));
}

std::span<const Descriptor> indexed(std::span<const Descriptor> descriptors) {
  return descriptors.first(std::min(descriptors.size(), FeatureIndex::kIndexedFeatures));
}

/// A bucket among those of all tables, and the hash bits that it does not imply.
struct BucketOf {
  BucketOf(unsigned table, std::uint32_t hash, unsigned bucket_bits)
      : bucket((static_cast<std::size_t>(table) << bucket_bits) + (hash & ((1U << bucket_bits) - 1))),
        rest(hash >> bucket_bits) {}
  std::size_t bucket;
  std::uint32_t rest;
};

}  // namespace

std::vector<std::uint32_t> feature_hashes(std::span<const Descriptor> descriptors) {
  std::vector<std::uint32_t> hashes;
  hashes.reserve(kTables * descriptors.size());
  for_each_hash(descriptors, [&](unsigned, std::uint32_t hash) { hashes.push_back(hash); });
  return hashes;
}

void FeatureIndex::add(std::span<const Descriptor> descriptors) {
  static_assert(kMaxKeyframes < (1U << kKeyframeBits) &&
                kMaxKeyframes * kTables * kIndexedFeatures < 1ULL << 32U);
  first_.resize(kTables * kBuckets, 0);
  if (entries_.empty()) entries_.emplace_back();
  if (keyframes_ < kMaxKeyframes)
    for_each_hash(indexed(descriptors), [this](unsigned table, std::uint32_t hash) {
      const BucketOf at(table, hash, kBucketBits);
      const std::uint32_t number = at.rest << kKeyframeBits | static_cast<std::uint32_t>(keyframes_);
      entries_.push_back(
          {number, std::exchange(first_[at.bucket], static_cast<std::uint32_t>(entries_.size()))});
    });
  ++keyframes_;
  if (entries_.size() > std::max(kMinSorted, sorted_.size() / 4)) sort();
}

void FeatureIndex::sort() {
  if (entries_.size() <= 1) return;
  const std::size_t count = sorted_.size() + entries_.size() - 1;
  // Four entries a bucket and more, so that begin_ is small beside sorted_.
  const unsigned bits =
      std::clamp(static_cast<unsigned>(std::bit_width(count / kTables / 8)), kBucketBits, kBits);

  const auto for_each_entry = [this](const auto& visit) {  // visit(table, hash, keyframe)
    const auto visit_entry = [&](std::size_t bucket, unsigned bucket_bits, std::uint32_t rest_and_keyframe) {
      const auto in_table = static_cast<std::uint32_t>(bucket & ((std::size_t{1} << bucket_bits) - 1));
      visit(static_cast<unsigned>(bucket >> bucket_bits),
            rest_and_keyframe >> kKeyframeBits << bucket_bits | in_table, rest_and_keyframe & kKeyframeMask);
    };
    for (std::size_t bucket = 0; bucket + 1 < begin_.size(); ++bucket)
      for (std::uint32_t at = begin_[bucket]; at < begin_[bucket + 1]; ++at)
        visit_entry(bucket, sorted_bucket_bits_, sorted_[at]);
    for (std::size_t bucket = 0; bucket < first_.size(); ++bucket)
      for (std::uint32_t at = first_[bucket]; at != 0; at = entries_[at].next)
        visit_entry(bucket, kBucketBits, entries_[at].rest_and_keyframe);
  };

  std::vector<std::uint32_t> begin((std::size_t{kTables} << bits) + 1, 0);
  for_each_entry([&](unsigned table, std::uint32_t hash, std::uint32_t) {
    ++begin[BucketOf(table, hash, bits).bucket + 1];
  });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::uint32_t> sorted(count);
  for_each_entry([&](unsigned table, std::uint32_t hash, std::uint32_t keyframe) {
    const BucketOf at(table, hash, bits);
    sorted[begin[at.bucket]++] = at.rest << kKeyframeBits | keyframe;
  });
  // Each bucket's begin has moved to the next one's.
  std::shift_right(begin.begin(), begin.end(), 1);
  begin.front() = 0;

  sorted_bucket_bits_ = bits;
  begin_ = std::move(begin);
  sorted_ = std::move(sorted);
  std::fill(first_.begin(), first_.end(), 0);
  entries_ = std::vector<Entry>(1);
}

std::vector<std::size_t> FeatureIndex::candidates(std::span<const Descriptor> query, std::size_t count,
                                                  const std::function<bool(std::size_t)>& accept) const {
  if (keyframes_ == 0) return {};
  std::vector<std::uint32_t> collisions(std::min(keyframes_, kMaxKeyframes), 0);
  const auto compare = [&](std::uint32_t rest, std::uint32_t rest_and_keyframe) {
    collisions[rest_and_keyframe & kKeyframeMask] += rest_and_keyframe >> kKeyframeBits == rest ? 1U : 0U;
  };

  // Buckets are all over the memory: each pass fetches what the next one reads.
  std::vector<BucketOf> in_sorted, in_lists;
  for_each_hash(indexed(query), [&](unsigned table, std::uint32_t hash) {
    if (!sorted_.empty())
      __builtin_prefetch(&begin_[in_sorted.emplace_back(table, hash, sorted_bucket_bits_).bucket]);
    if (entries_.size() > 1)
      __builtin_prefetch(&first_[in_lists.emplace_back(table, hash, kBucketBits).bucket]);
  });
  for (const BucketOf& at : in_sorted) __builtin_prefetch(sorted_.data() + begin_[at.bucket]);
  for (const BucketOf& at : in_sorted)
    for (std::uint32_t i = begin_[at.bucket]; i < begin_[at.bucket + 1]; ++i) compare(at.rest, sorted_[i]);
  for (const BucketOf& at : in_lists)
    for (std::uint32_t i = first_[at.bucket]; i != 0; i = entries_[i].next)
      compare(at.rest, entries_[i].rest_and_keyframe);

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
