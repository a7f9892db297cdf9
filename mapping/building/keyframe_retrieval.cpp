// keyframe_retrieval.cpp: counts features of keyframes with equal hashes. Features and similarities are
// stored as binary files, with a checksum.
#include "mapping/building/keyframe_retrieval.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <string>

#include "mapping/building/building_map.hpp"
#include "mapping/localization/feature_index.hpp"
#include "mapping/localization/place_matching.hpp"
#include "mapping/storage/binary_file.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// The features of a submap's keyframes that differ in their view.
struct DistinctKeyframes {
  KeyframeDatabase database;          ///< descriptors only; not indexed
  std::vector<std::size_t> index_of;  ///< by keyframe of `database`: its index in the submap
};

DistinctKeyframes distinct_keyframes(const Submap& submap, double min_step) {
  const auto& keyframes = submap.keyframes.keyframes;
  DistinctKeyframes distinct;
  distinct.index_of = distinct_views(keyframes, min_step);
  for (const std::size_t k : distinct.index_of) {
    const auto& all = keyframes[k].descriptors;
    const auto count = std::min(all.size(), FeatureIndex::kIndexedFeatures);
    distinct.database.keyframes.emplace_back().descriptors.assign(
        all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
  }
  return distinct;
}

/// A keyframe of a group of submaps.
struct Row {
  std::uint32_t submap;
  std::uint32_t keyframe;
  const KeyframeFeatures* features;
};

std::vector<Row> rows_of(std::span<const SubmapFeatures> group) {
  std::vector<Row> rows;
  for (std::uint32_t submap = 0; submap < group.size(); ++submap)
    for (std::uint32_t k = 0; k < group[submap].keyframes.size(); ++k)
      rows.push_back({submap, k, &group[submap].keyframes[k]});
  return rows;
}

/// Counts collisions of the keyframes of two groups in all hash tables.
/// @return by row of `a`: by row of `b`
std::vector<std::vector<std::uint32_t>> count_collisions(std::span<const Row> a, std::span<const Row> b) {
  std::vector<std::vector<std::uint32_t>> counts(a.size(), std::vector<std::uint32_t>(b.size(), 0));
  std::vector<std::uint32_t> begin, rows;  // rows of b by hash: those of hash h begin at rows[begin[h]]
  for (unsigned table = 0; table < kFeatureTables; ++table) {
    begin.assign((std::size_t{1} << kFeatureHashBits) + 2, 0);
    for (const Row& row : b)
      for (const std::uint32_t hash : row.features->hashes[table]) ++begin[hash + 2];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    rows.resize(begin.back());
    for (std::uint32_t j = 0; j < b.size(); ++j)
      for (const std::uint32_t hash : b[j].features->hashes[table]) rows[begin[hash + 1]++] = j;
    for (std::size_t i = 0; i < a.size(); ++i) {
      std::uint32_t* const of_row = counts[i].data();
      for (const std::uint32_t hash : a[i].features->hashes[table])
        for (std::uint32_t at = begin[hash]; at < begin[hash + 1]; ++at) ++of_row[rows[at]];
    }
  }
  return counts;
}

bool is_more_similar(const SimilarSubmap& one, const SimilarSubmap& other) {
  return one.collisions != other.collisions ? one.collisions > other.collisions : one.submap < other.submap;
}

/// Inserts a submap in order, unless `most` better ones are there. It must not be among `others`.
void insert(std::vector<SimilarSubmap>& others, const SimilarSubmap& found, std::size_t most) {
  others.insert(std::upper_bound(others.begin(), others.end(), found, is_more_similar), found);
  if (others.size() > most) others.pop_back();
}

/// Inserts the submaps of which one keyframe has collisions.
/// @param collisions  with all keyframes of a group, in order of their submaps
/// @param rows        these keyframes
void insert_all(std::vector<SimilarSubmap>& others, std::span<const std::uint32_t> collisions,
                std::span<const Row> rows, std::size_t most) {
  for (std::size_t i = 0; i < rows.size();) {
    SimilarSubmap best{rows[i].submap, 0};
    for (; i < rows.size() && rows[i].submap == best.submap; ++i)
      best.collisions = std::max(best.collisions, collisions[i]);
    if (best.collisions > 0) insert(others, best, most);
  }
}

std::vector<SubmapSimilarity> without_others(std::span<const SubmapFeatures> group) {
  std::vector<SubmapSimilarity> similarities(group.size());
  for (std::size_t i = 0; i < group.size(); ++i)
    for (const KeyframeFeatures& features : group[i].keyframes)
      similarities[i].push_back({features.count, {}});
  return similarities;
}

/// Returns how many collisions a keyframe may have with an unrelated one.
std::uint32_t unrelated_collisions(const KeyframeSimilarity& keyframe, std::size_t candidates) {
  // A feature has 0.11 collisions with half of all keyframes (two simulated buildings, 300 features each);
  // for one keyframe in 20, with repeated textures, 0.15.
  constexpr double kPerFeature = 0.15;
  const auto usual = static_cast<std::uint32_t>(std::lround(kPerFeature * keyframe.features));
  const std::uint32_t last = keyframe.others.size() < candidates ? 0 : keyframe.others.back().collisions;
  return std::clamp(last, usual, 2 * usual);
}

/// Returns the pairs that are among the `partners` best of one of their submaps, sorted by a, then b.
std::vector<CandidatePair> best_partners(std::vector<CandidatePair> found, std::size_t submaps,
                                         std::size_t partners) {
  std::stable_sort(found.begin(), found.end(), [](const CandidatePair& one, const CandidatePair& other) {
    return one.collisions > other.collisions;
  });
  std::vector<CandidatePair> best;
  std::vector<std::size_t> pairs_of(submaps, 0);
  for (const CandidatePair& pair : found) {
    const bool is_kept = std::min(pairs_of[pair.a]++, pairs_of[pair.b]++) < partners;
    if (is_kept) best.push_back(pair);
  }
  std::sort(best.begin(), best.end(), [](const CandidatePair& one, const CandidatePair& other) {
    return std::pair(one.a, one.b) < std::pair(other.a, other.b);
  });
  return best;
}

constexpr std::string_view kFeaturesMagic = "RRFEATUR";
constexpr std::uint32_t kFeaturesVersion = 1;
constexpr std::string_view kSimilarityMagic = "RRSIMILA";
constexpr std::uint32_t kSimilarityVersion = 1;

}  // namespace

SubmapFeatures features_of(const Submap& submap, const RetrievalConfig& config) {
  SubmapFeatures features;
  for (const MapKeyframe& keyframe : distinct_keyframes(submap, config.min_step).database.keyframes) {
    const std::size_t count = keyframe.descriptors.size();
    const std::vector<std::uint32_t> hashes = feature_hashes(keyframe.descriptors);
    KeyframeFeatures& of_keyframe = features.keyframes.emplace_back();
    of_keyframe.count = static_cast<std::uint32_t>(count);
    auto begin = hashes.begin();
    for (std::vector<std::uint32_t>& in_table : of_keyframe.hashes) {
      const auto end = begin + static_cast<std::ptrdiff_t>(count);
      in_table.assign(begin, end);
      std::sort(in_table.begin(), in_table.end());
      in_table.erase(std::unique(in_table.begin(), in_table.end()), in_table.end());
      begin = end;
    }
  }
  return features;
}

GroupSimilarity compare_groups(std::span<const SubmapFeatures> a, std::span<const SubmapFeatures> b,
                               const RetrievalConfig& config) {
  const std::vector<Row> rows_a = rows_of(a), rows_b = rows_of(b);
  const std::vector<std::vector<std::uint32_t>> counts = count_collisions(rows_a, rows_b);
  GroupSimilarity found{without_others(a), without_others(b)};
  for (std::size_t i = 0; i < rows_a.size(); ++i)
    insert_all(found.a[rows_a[i].submap][rows_a[i].keyframe].others, counts[i], rows_b, config.candidates);
  std::vector<std::uint32_t> column(rows_a.size());
  for (std::size_t j = 0; j < rows_b.size(); ++j) {
    std::transform(counts.begin(), counts.end(), column.begin(), [j](const auto& row) { return row[j]; });
    insert_all(found.b[rows_b[j].submap][rows_b[j].keyframe].others, column, rows_a, config.candidates);
  }
  return found;
}

GroupSimilarity compare_within(std::span<const SubmapFeatures> group, const RetrievalConfig& config) {
  const std::vector<Row> rows = rows_of(group);
  std::vector<std::vector<std::uint32_t>> counts = count_collisions(rows, rows);
  GroupSimilarity found{without_others(group), {}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < rows.size(); ++j)
      if (rows[j].submap == rows[i].submap) counts[i][j] = 0;
    insert_all(found.a[rows[i].submap][rows[i].keyframe].others, counts[i], rows, config.candidates);
  }
  return found;
}

bool add_similar(SubmapSimilarity& all, const SubmapSimilarity& found, std::span<const std::size_t> number_of,
                 const RetrievalConfig& config) {
  const auto has_same_features = [](const KeyframeSimilarity& one, const KeyframeSimilarity& other) {
    return one.features == other.features;
  };
  if (all.empty())
    for (const KeyframeSimilarity& keyframe : found) all.push_back({keyframe.features, {}});
  if (!std::equal(all.begin(), all.end(), found.begin(), found.end(), has_same_features)) return false;
  for (std::size_t k = 0; k < found.size(); ++k)
    for (const SimilarSubmap& other : found[k].others)
      insert(all[k].others, {static_cast<std::uint32_t>(number_of[other.submap]), other.collisions},
             config.candidates);
  return true;
}

std::vector<CandidatePair> choose_pairs(std::span<const SubmapSimilarity> similarities,
                                        const RetrievalConfig& config) {
  struct Similar {
    std::size_t in_a = 0, in_b = 0;  // keyframes that look similar to one of the other submap
    std::uint64_t collisions = 0;
  };
  std::map<std::pair<std::size_t, std::size_t>, Similar> similar;  // by submaps a and b
  for (std::size_t own = 0; own < similarities.size(); ++own)
    for (const KeyframeSimilarity& keyframe : similarities[own]) {
      const std::uint32_t least = unrelated_collisions(keyframe, config.candidates) + config.min_excess;
      for (const SimilarSubmap& other : keyframe.others) {
        if (other.collisions < least) break;
        Similar& of_pair = similar[std::minmax<std::size_t>(own, other.submap)];
        ++(own < other.submap ? of_pair.in_a : of_pair.in_b);
        of_pair.collisions += other.collisions - least + config.min_excess;
      }
    }
  std::vector<CandidatePair> found;
  for (const auto& [pair, count] : similar)
    if (std::max(count.in_a, count.in_b) >= config.min_similar)
      found.push_back({pair.first, pair.second, count.in_a + count.in_b, count.collisions});
  return best_partners(std::move(found), similarities.size(), config.partners);
}

std::vector<std::pair<std::size_t, std::size_t>> similar_keyframes(const Submap& a, const Submap& b,
                                                                   const SimilarConfig& config) {
  DistinctKeyframes of_a = distinct_keyframes(a, config.min_step);
  const DistinctKeyframes of_b = distinct_keyframes(b, config.min_step);
  update_index(of_a.database);
  of_a.database.index.sort();
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t j = 0; j < of_b.index_of.size(); ++j) {
    const MapKeyframe& keyframe = of_b.database.keyframes[j];
    const auto candidates = of_a.database.index.candidates(keyframe.descriptors, config.candidates, {});
    for (const std::size_t i :
         most_alike_of(candidates, keyframe, of_a.database, config.per_keyframe, config.min_matches))
      pairs.emplace_back(of_a.index_of[i], of_b.index_of[j]);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

template <typename Archive>
static void serialize(Archive& archive, Ref<Archive, KeyframeFeatures> features) {
  archive(features.count);
  for (auto& hashes : features.hashes) {
    serialize_items(archive, hashes);
    if constexpr (Archive::kReads)
      if (hashes.size() > features.count || (!hashes.empty() && hashes.back() >> kFeatureHashBits != 0) ||
          std::adjacent_find(hashes.begin(), hashes.end(), std::greater_equal<>()) != hashes.end())
        archive.fail("is damaged: not hashes of features in order");
  }
}

template <typename Archive>
static void serialize(Archive& archive, Ref<Archive, SimilarSubmap> similar) {
  archive(similar.submap, similar.collisions);
}

template <typename Archive>
static void serialize(Archive& archive, Ref<Archive, KeyframeSimilarity> keyframe) {
  archive(keyframe.features, keyframe.others);
}

void save_features(const SubmapFeatures& features, const std::filesystem::path& path) {
  save_binary(path, kFeaturesMagic, kFeaturesVersion, features.keyframes);
}

SubmapFeatures load_features(const std::filesystem::path& path) {
  SubmapFeatures features;
  load_binary(path, kFeaturesMagic, kFeaturesVersion, features.keyframes);
  return features;
}

void save_similarity(const GroupSimilarity& similarity, const std::filesystem::path& path) {
  save_binary(path, kSimilarityMagic, kSimilarityVersion, similarity.a, similarity.b);
}

GroupSimilarity load_similarity(const std::filesystem::path& path, std::size_t submaps_a,
                                std::size_t submaps_b) {
  GroupSimilarity similarity;
  load_binary(path, kSimilarityMagic, kSimilarityVersion, similarity.a, similarity.b);
  const auto require_submaps_below = [&path](const std::vector<SubmapSimilarity>& side, std::size_t submaps) {
    for (const SubmapSimilarity& submap : side)
      for (const KeyframeSimilarity& keyframe : submap)
        for (const SimilarSubmap& other : keyframe.others)
          if (other.submap >= submaps) throw Error(path.string() + ": is damaged: no such recording");
  };
  if (similarity.a.size() != submaps_a || similarity.b.size() != submaps_b)
    throw Error(path.string() + ": is of other recordings");
  require_submaps_below(similarity.a, submaps_b == 0 ? submaps_a : submaps_b);
  require_submaps_below(similarity.b, submaps_a);
  return similarity;
}

}  // namespace roomradar
