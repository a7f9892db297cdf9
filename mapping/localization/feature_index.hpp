// feature_index.hpp: locality-sensitive hash index of keyframes by their feature descriptors.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "mapping/localization/patches.hpp"

namespace roomradar {

/// Returns the hashes of descriptors, table by table: hash i of table t at [t * descriptors.size() + i],
/// below 2^kFeatureHashBits. Two descriptors collide in a table if their hashes there are equal.
std::vector<std::uint32_t> feature_hashes(std::span<const Descriptor> descriptors);

inline constexpr unsigned kFeatureTables = 16;
inline constexpr unsigned kFeatureHashBits = 20;

/// Index over the descriptors of a sequence of keyframes, by locality-sensitive hashing. Two descriptors
/// collide in one of the index's hash tables if they have equal values at the table's randomly chosen bits.
/// Descriptors of one feature collide often, those of different features rarely. Deterministic. Source: Indyk
/// and Motwani, Approximate nearest neighbors, STOC 1998 (bit sampling).
class FeatureIndex {
 public:
  /// Adds the next keyframe under the number size(). Indexes its first kIndexedFeatures descriptors. Uses 8
  /// bytes per descriptor and table, at most 38 kB per keyframe; 19 kB once its entries are sorted.
  void add(std::span<const Descriptor> descriptors);
  /// Sorts the entries that are still unsorted; add() sorts only once enough of them have accumulated.
  /// candidates() is several times as fast afterwards, with the same result.
  void sort();
  /// Returns the number of keyframes in the index.
  [[nodiscard]] std::size_t size() const { return keyframes_; }

  /// Returns the numbers of the keyframes with the most collisions with `query`, best first. Two descriptors
  /// that collide in several tables count once per table. Returns at most `count` keyframes, all with at
  /// least one collision.
  /// @param accept  called with a keyframe's number; false: the keyframe is left out. Empty: all are accepted
  [[nodiscard]] std::vector<std::size_t> candidates(std::span<const Descriptor> query, std::size_t count,
                                                    const std::function<bool(std::size_t)>& accept) const;

  static constexpr std::size_t kIndexedFeatures = 300;
  static constexpr std::size_t kMaxKeyframes = 500'000;  ///< later keyframes are not indexed

 private:
  /// A descriptor in a bucket. Buckets are linked lists in one array: many small arrays that grow between
  /// large images would fragment the heap.
  struct Entry {
    std::uint32_t rest_and_keyframe;  ///< hash bits that the bucket does not imply, and the keyframe's number
    std::uint32_t next;               ///< index of the bucket's next entry; 0: none
  };

  std::size_t keyframes_ = 0;
  std::vector<std::uint32_t> first_;  ///< by bucket, of all tables: index of the first entry; 0: none
  std::vector<Entry> entries_;        ///< of the newest keyframes; entry 0 is unused

  unsigned sorted_bucket_bits_ = 0;  ///< bits of a hash that select a bucket of `sorted_`
  std::vector<std::uint32_t>
      begin_;  ///< start offset in `sorted_` of each bucket of each table, then the end
  std::vector<std::uint32_t> sorted_;  ///< rest_and_keyframe of the older keyframes, bucket by bucket
};

}  // namespace roomradar
