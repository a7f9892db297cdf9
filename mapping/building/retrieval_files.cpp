// retrieval_files.cpp: features and similarities as binary files, with a checksum.
#include "mapping/building/retrieval_files.hpp"

#include <algorithm>
#include <functional>
#include <string>

#include "mapping/localization/feature_index.hpp"
#include "mapping/storage/binary_file.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr std::string_view kFeaturesMagic = "RRFEATUR";
constexpr std::uint32_t kFeaturesVersion = 1;
constexpr std::string_view kSimilarityMagic = "RRSIMILA";
constexpr std::uint32_t kSimilarityVersion = 1;

}  // namespace

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
