// keyframe_retrieval.hpp: finds recordings of a building, and their keyframes, that may show the same place.
//
// Submaps are compared group by group, so that groups are compared by separate jobs, and a submap that
// changes requires only the comparisons of its group again. The pairs do not depend on the groups. A
// collision is a feature hash that two keyframes share (feature_index.hpp).
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <utility>
#include <vector>

#include "mapping/building/submap.hpp"
#include "mapping/localization/feature_index.hpp"

namespace roomradar {

struct RetrievalConfig {
  double min_step = 0.25;       ///< min view_distance() of the keyframes of a submap that are compared
  std::size_t candidates = 12;  ///< max similar submaps per keyframe; those with the most collisions
  /// Min collisions of similar keyframes above the number expected of unrelated ones.
  std::uint32_t min_excess = 15;
  std::size_t min_similar = 2;  ///< min number of similar keyframes in one of the submaps of a pair
  std::size_t partners = 16;    ///< best pairs kept per submap, by excess collisions
};

/// The strongest features of a keyframe. Features of a repeated texture have equal hashes, which count once:
/// otherwise two views of brickwork would be more similar than two views of one place. Source: Jegou, Douze
/// and Schmid, On the burstiness of visual elements, CVPR 2009.
struct KeyframeFeatures {
  std::uint32_t count = 0;
  std::array<std::vector<std::uint32_t>, kFeatureTables> hashes;  ///< per table: ascending, distinct
};
/// Features of those keyframes of a submap that differ in their view.
struct SubmapFeatures {
  std::vector<KeyframeFeatures> keyframes;
};
SubmapFeatures features_of(const Submap& submap, const RetrievalConfig& config = {});

/// A submap that resembles a keyframe of another submap.
struct SimilarSubmap {
  std::uint32_t submap = 0;
  std::uint32_t collisions = 0;  ///< max number of equal hashes with one of its keyframes
};
struct KeyframeSimilarity {
  std::uint32_t features = 0;         ///< number of the keyframe's features
  std::vector<SimilarSubmap> others;  ///< most collisions first, then lowest number; no submap twice
};
/// One entry per keyframe of a submap.
using SubmapSimilarity = std::vector<KeyframeSimilarity>;

/// Similarities of the submaps of two groups.
struct GroupSimilarity {
  // One entry per submap of the first and of the second group. SimilarSubmap::submap is an index in the other
  // group. b is empty if a group is compared with itself.
  std::vector<SubmapSimilarity> a, b;
};
/// Counts the collisions of all keyframes of one group with all of another. Keeps `candidates` submaps per
/// keyframe.
GroupSimilarity compare_groups(std::span<const SubmapFeatures> a, std::span<const SubmapFeatures> b,
                               const RetrievalConfig& config = {});
/// Compares the submaps of one group with each other, as compare_groups() does.
GroupSimilarity compare_within(std::span<const SubmapFeatures> group, const RetrievalConfig& config = {});

/// Adds the similarities of a submap's keyframes to those with other groups, and keeps the best `candidates`.
/// @param number_of  for each SimilarSubmap::submap in `found`, the number of that submap in `all`; ascending
/// @return false if `found` has another number of keyframes or features than `all`
bool add_similar(SubmapSimilarity& all, const SubmapSimilarity& found, std::span<const std::size_t> number_of,
                 const RetrievalConfig& config = {});

/// Two submaps that may show the same place.
struct CandidatePair {
  std::size_t a = 0, b = 0;      ///< submaps, a < b
  std::size_t similar = 0;       ///< keyframes, in both submaps, that are similar to a keyframe of the other
  std::uint64_t collisions = 0;  ///< sum of the excess collisions of these keyframes
};
/// Returns the pairs of submaps that look alike, sorted by a, then b. A pair is among the `partners` best
/// pairs of one of its submaps, so the number of pairs grows linearly with the number of submaps.
/// @param similarities  one per submap, merged over all groups by add_similar()
std::vector<CandidatePair> choose_pairs(std::span<const SubmapSimilarity> similarities,
                                        const RetrievalConfig& config = {});

struct SimilarConfig {
  double min_step = 0.25;        ///< min view_distance() of the keyframes of a submap that are compared
  int min_matches = 15;          ///< min number of features that match
  std::size_t candidates = 8;    ///< max keyframes of a to compare with a keyframe of b
  std::size_t per_keyframe = 2;  ///< max pairs to return per keyframe of b
};

/// Returns pairs of keyframes of two submaps (of a, of b) that look similar, sorted. Depends only on the
/// two submaps.
std::vector<std::pair<std::size_t, std::size_t>> similar_keyframes(const Submap& a, const Submap& b,
                                                                   const SimilarConfig& config = {});

/// Writes a submap's features. Throws Error if the file cannot be written.
void save_features(const SubmapFeatures& features, const std::filesystem::path& path);
/// Reads the features. Throws Error naming the file and the fault if it is missing, damaged or of another
/// version.
SubmapFeatures load_features(const std::filesystem::path& path);

/// Writes the similarities of two groups of submaps. Throws Error if the file cannot be written.
void save_similarity(const GroupSimilarity& similarity, const std::filesystem::path& path);
/// Reads the similarities. Throws Error naming the file and the fault if it is missing, damaged or of another
/// version, or if the groups have other numbers of submaps.
/// @param submaps_b  number of submaps of the second group; 0: one group, compared with itself
GroupSimilarity load_similarity(const std::filesystem::path& path, std::size_t submaps_a,
                                std::size_t submaps_b);

}  // namespace roomradar
