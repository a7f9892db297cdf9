// retrieval_files.cpp: features and similarities as binary files, with a checksum.
#include "mapping/building/retrieval_files.hpp"

#include <algorithm>
#include <functional>
#include <string>

#include "mapping/localization/feature_index.hpp"
#include "mapping/mesh/serialize_mesh.hpp"
#include "mapping/storage/binary_file.hpp"
#include "mapping/types/serialize.hpp"

namespace roomradar {
namespace {

constexpr std::string_view kFeaturesMagic = "RRFEATUR";
constexpr std::uint32_t kFeaturesVersion = 1;
constexpr std::string_view kSimilarityMagic = "RRSIMILA";
constexpr std::uint32_t kSimilarityVersion = 1;

}  // namespace

template <typename Archive>
static void serialize(Archive& archive, KeyframeFeatures& features) {
  serialize(archive, features.count);
  for (std::vector<std::uint32_t>& hashes : features.hashes) {
    serialize_items(archive, hashes);
    if constexpr (Archive::kReads)
      if (hashes.size() > features.count || (!hashes.empty() && hashes.back() >> kFeatureHashBits != 0) ||
          std::adjacent_find(hashes.begin(), hashes.end(), std::greater_equal<>()) != hashes.end())
        archive.fail("is damaged: not hashes of features in order");
  }
}

template <typename Archive>
static void serialize(Archive& archive, SimilarSubmap& similar) {
  serialize(archive, similar.submap);
  serialize(archive, similar.collisions);
}

template <typename Archive>
static void serialize(Archive& archive, KeyframeSimilarity& keyframe) {
  serialize(archive, keyframe.features);
  serialize(archive, keyframe.others);
}

void save_features(const SubmapFeatures& features, const std::filesystem::path& path) {
  ByteWriter out;
  SubmapFeatures copy = features;
  serialize(out, copy.keyframes);
  write_binary(path, kFeaturesMagic, kFeaturesVersion, out.bytes());
}

SubmapFeatures load_features(const std::filesystem::path& path) {
  const std::string bytes = read_binary(path, kFeaturesMagic, kFeaturesVersion);
  ByteReader in(bytes, path.string());
  SubmapFeatures features;
  serialize(in, features.keyframes);
  in.require_end();
  return features;
}

void save_similarity(const GroupSimilarity& similarity, const std::filesystem::path& path) {
  ByteWriter out;
  GroupSimilarity copy = similarity;
  serialize(out, copy.a);
  serialize(out, copy.b);
  write_binary(path, kSimilarityMagic, kSimilarityVersion, out.bytes());
}

GroupSimilarity load_similarity(const std::filesystem::path& path, std::size_t submaps_a,
                                std::size_t submaps_b) {
  const std::string bytes = read_binary(path, kSimilarityMagic, kSimilarityVersion);
  ByteReader in(bytes, path.string());
  GroupSimilarity similarity;
  serialize(in, similarity.a);
  serialize(in, similarity.b);
  in.require_end();
  const auto require_submaps_below = [&in](const std::vector<SubmapSimilarity>& side, std::size_t submaps) {
    for (const SubmapSimilarity& submap : side)
      for (const KeyframeSimilarity& keyframe : submap)
        for (const SimilarSubmap& other : keyframe.others)
          if (other.submap >= submaps) in.fail("is damaged: no such recording");
  };
  if (similarity.a.size() != submaps_a || similarity.b.size() != submaps_b) in.fail("is of other recordings");
  require_submaps_below(similarity.a, submaps_b == 0 ? submaps_a : submaps_b);
  require_submaps_below(similarity.b, submaps_a);
  return similarity;
}

}  // namespace roomradar
