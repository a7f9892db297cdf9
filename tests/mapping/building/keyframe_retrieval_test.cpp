// keyframe_retrieval_test.cpp: submaps with common features are found among others, and no more pairs than
// wanted.
#include "mapping/building/keyframe_retrieval.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include "mapping/types/system/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::keyframe_retrieval_test {
namespace {

using Features = std::vector<Descriptor>;

Features drawn(std::size_t count, std::mt19937& random) {
  Features features(count);
  for (Descriptor& one : features)
    for (std::uint8_t& byte : one) byte = static_cast<std::uint8_t>(random());
  return features;
}

/// A submap with a keyframe every metre, each with 60 features of its own and these of a place.
Submap submap_of(const std::vector<const Features*>& places, std::mt19937& random) {
  Submap submap;
  for (std::size_t i = 0; i < places.size(); ++i) {
    MapKeyframe& keyframe = submap.keyframes.keyframes.emplace_back();
    keyframe.T_world_camera.translation().x() = static_cast<double>(i);
    keyframe.descriptors = drawn(60, random);
    if (places[i] != nullptr)
      keyframe.descriptors.insert(keyframe.descriptors.end(), places[i]->begin(), places[i]->end());
  }
  return submap;
}

/// Compares group with group, as the jobs of a building do.
/// @param groups  submap i is in group i * 7 % groups
std::vector<CandidatePair> find_pairs(const std::vector<Submap>& submaps, const RetrievalConfig& config = {},
                                      std::size_t groups = 1) {
  std::vector<std::vector<std::size_t>> numbers(groups);
  std::vector<std::vector<SubmapFeatures>> features(groups);
  for (std::size_t i = 0; i < submaps.size(); ++i) {
    numbers[i * 7 % groups].push_back(i);
    features[i * 7 % groups].push_back(features_of(submaps[i], config));
  }
  std::vector<SubmapSimilarity> all(submaps.size());
  const auto add = [&](const std::vector<SubmapSimilarity>& found, std::size_t of, std::size_t in) {
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_TRUE(add_similar(all[numbers[of][i]], found[i], numbers[in], config));
  };
  for (std::size_t a = 0; a < groups; ++a) {
    add(compare_within(features[a], config).a, a, a);
    for (std::size_t b = 0; b < a; ++b) {
      const GroupSimilarity found = compare_groups(features[a], features[b], config);
      add(found.a, a, b);
      add(found.b, b, a);
    }
  }
  return choose_pairs(all, config);
}

void expect_equal(const std::vector<CandidatePair>& found, const std::vector<CandidatePair>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(std::pair(found[i].a, found[i].b), std::pair(expected[i].a, expected[i].b));
    EXPECT_EQ(found[i].similar, expected[i].similar);
    EXPECT_EQ(found[i].collisions, expected[i].collisions);
  }
}

TEST(KeyframeRetrieval, FindsNeighboursAmongManySubmaps) {
  std::mt19937 random(3);
  constexpr std::size_t kSubmaps = 30;
  std::vector<Features> doors;  // door i: seen from submaps i and i + 1, in three keyframes
  for (std::size_t i = 0; i <= kSubmaps; ++i) doors.push_back(drawn(40, random));
  std::vector<Submap> submaps;
  for (std::size_t i = 0; i < kSubmaps; ++i) {
    const Features *before = &doors[i], *after = &doors[i + 1];
    submaps.push_back(submap_of({before, before, before, nullptr, nullptr, after, after, after}, random));
    EXPECT_EQ(features_of(submaps.back()).keyframes.size(), 8U);
  }
  const std::vector<CandidatePair> pairs = find_pairs(submaps);
  ASSERT_EQ(pairs.size(), kSubmaps - 1);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    EXPECT_EQ(pairs[i].a, i);
    EXPECT_EQ(pairs[i].b, i + 1);
    EXPECT_EQ(pairs[i].similar, 6U);
  }
  for (const std::size_t groups : {2, 5, 10}) expect_equal(find_pairs(submaps, {}, groups), pairs);
}

// A recording that changes must not change which others are compared.
TEST(KeyframeRetrieval, DoesNotDependOnTheOrderOfSubmaps) {
  std::mt19937 random(8);
  constexpr std::size_t kSubmaps = 8;
  const Features corridor = drawn(40, random);
  std::vector<Submap> submaps;
  for (std::size_t i = 0; i < kSubmaps; ++i)
    submaps.push_back(submap_of({i % 3 == 0 ? &corridor : nullptr, &corridor, &corridor, nullptr}, random));
  std::vector<CandidatePair> expected = find_pairs(submaps);
  ASSERT_EQ(expected.size(), kSubmaps * (kSubmaps - 1) / 2);
  std::reverse(submaps.begin(), submaps.end());
  std::vector<CandidatePair> found = find_pairs(submaps);
  const auto last = [](const CandidatePair& pair) {
    return CandidatePair{kSubmaps - 1 - pair.b, kSubmaps - 1 - pair.a, pair.similar, pair.collisions};
  };
  std::transform(found.begin(), found.end(), found.begin(), last);
  std::sort(found.begin(), found.end(), [](const CandidatePair& one, const CandidatePair& other) {
    return std::pair(one.a, one.b) < std::pair(other.a, other.b);
  });
  expect_equal(found, expected);
}

TEST(KeyframeRetrieval, ARepeatedTextureCountsOnce) {
  std::mt19937 random(11);
  const Features brick = drawn(1, random);
  const Features wall(200, brick.front()), own = drawn(40, random);
  Features seen = own;
  seen.insert(seen.end(), wall.begin(), wall.end());
  const std::vector<CandidatePair> pairs =
      find_pairs({submap_of({&seen, &seen}, random), submap_of({&wall, &wall}, random),
                  submap_of({&own, &own}, random)});
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(std::pair(pairs[0].a, pairs[0].b), std::pair(std::size_t{0}, std::size_t{2}));
}

// More submaps show the corridor than a keyframe may resemble.
TEST(KeyframeRetrieval, FindsAPlaceThatManySubmapsShow) {
  std::mt19937 random(9);
  const Features corridor = drawn(100, random);
  std::vector<Submap> submaps;
  for (std::size_t i = 0; i < 30; ++i) submaps.push_back(submap_of({&corridor, &corridor, nullptr}, random));
  const std::vector<CandidatePair> pairs = find_pairs(submaps);
  std::vector<int> partners(submaps.size());
  for (const CandidatePair& pair : pairs) {
    ++partners[pair.a];
    ++partners[pair.b];
  }
  EXPECT_GE(*std::min_element(partners.begin(), partners.end()), 5);
  expect_equal(find_pairs(submaps, {}, 4), pairs);
}

TEST(KeyframeRetrieval, OneSimilarKeyframeIsNotEnough) {
  std::mt19937 random(4);
  const Features door = drawn(40, random);
  EXPECT_TRUE(find_pairs({}).empty());
  EXPECT_TRUE(
      find_pairs({submap_of({&door, nullptr}, random), submap_of({nullptr, &door}, random), {}}).empty());
}

// Corridors that all look alike: the number of pairs grows with the number of submaps, not with its square.
TEST(KeyframeRetrieval, KeepsTheBestPartnersOfEachSubmap) {
  std::mt19937 random(5);
  constexpr std::size_t kSubmaps = 20;
  const Features corridor = drawn(40, random), room = drawn(40, random);
  RetrievalConfig config;
  config.partners = 3;
  std::vector<Submap> submaps;
  for (std::size_t i = 0; i < kSubmaps; ++i) {
    const Features* also = i == 2 || i == 17 ? &room : nullptr;
    submaps.push_back(submap_of({&corridor, &corridor, also, also, also}, random));
  }
  const std::vector<CandidatePair> pairs = find_pairs(submaps, config);
  EXPECT_LE(pairs.size(), 3 * kSubmaps);
  EXPECT_GE(pairs.size(), kSubmaps);
  const bool has_best = std::any_of(pairs.begin(), pairs.end(),
                                    [](const CandidatePair& pair) { return pair.a == 2 && pair.b == 17; });
  EXPECT_TRUE(has_best);
}

TEST(KeyframeRetrieval, ASubmapThatChangedMeanwhileIsRefused) {
  SubmapSimilarity all;
  const std::vector<std::size_t> numbers = {0, 1};
  const SubmapSimilarity found = {{300, {{1, 20}, {0, 10}}}};
  EXPECT_TRUE(add_similar(all, found, numbers));
  EXPECT_FALSE(add_similar(all, {}, numbers));
  EXPECT_FALSE(add_similar(all, {{299, {}}}, numbers));
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].others.size(), 2U);
}

TEST(RetrievalFiles, KeepWhatIsWritten) {
  std::mt19937 random(10);
  const Features door = drawn(40, random);
  const std::vector<SubmapFeatures> a = {features_of(submap_of({&door, nullptr}, random)), {}};
  const std::vector<SubmapFeatures> b = {features_of(submap_of({&door}, random))};
  const test::TemporaryFolder folder;
  save_features(a[0], folder.path() / "features.bin");
  const SubmapFeatures read_features = load_features(folder.path() / "features.bin");
  ASSERT_EQ(read_features.keyframes.size(), 2U);
  EXPECT_EQ(read_features.keyframes[0].count, 100U);
  EXPECT_EQ(read_features.keyframes[0].hashes, a[0].keyframes[0].hashes);
  save_features(a[1], folder.path() / "features.bin");
  EXPECT_TRUE(load_features(folder.path() / "features.bin").keyframes.empty());

  const std::filesystem::path path = folder.path() / "similarity.bin";
  const GroupSimilarity expected = compare_groups(a, b);
  save_similarity(expected, path);
  const GroupSimilarity read = load_similarity(path, 2, 1);
  ASSERT_EQ(read.a[0].size(), 2U);
  ASSERT_EQ(read.a[0][0].others.size(), 1U);
  EXPECT_EQ(read.a[0][0].others[0].collisions, expected.a[0][0].others[0].collisions);
  EXPECT_GE(read.a[0][0].others[0].collisions, 40U * 16U);
  EXPECT_EQ(read.b[0][0].features, 100U);
  EXPECT_THROW(load_similarity(path, 2, 2), Error);
  EXPECT_THROW(load_similarity(path, 1, 1), Error);
  EXPECT_THROW(load_similarity(path, 2, 0), Error);

  GroupSimilarity damaged = expected;
  damaged.a[0][0].others[0].submap = 1;
  save_similarity(damaged, path);
  EXPECT_THROW(load_similarity(path, 2, 1), Error);
  SubmapFeatures not_hashes = a[0];
  std::swap(not_hashes.keyframes[0].hashes[15].front(), not_hashes.keyframes[0].hashes[15].back());
  save_features(not_hashes, folder.path() / "features.bin");
  EXPECT_THROW(load_features(folder.path() / "features.bin"), Error);
}

TEST(SimilarKeyframes, AreTheKeyframesOfTheSamePlace) {
  std::mt19937 random(6);
  const Features door = drawn(40, random), desk = drawn(40, random);
  const Submap a = submap_of({nullptr, &door, nullptr, &desk}, random),
               b = submap_of({&desk, nullptr, &door}, random);
  const std::vector<std::pair<std::size_t, std::size_t>> expected = {{1, 2}, {3, 0}};
  EXPECT_EQ(similar_keyframes(a, b), expected);
  EXPECT_TRUE(similar_keyframes(a, {}).empty());
  EXPECT_TRUE(similar_keyframes({}, b).empty());
}

}  // namespace
}  // namespace roomradar::keyframe_retrieval_test
