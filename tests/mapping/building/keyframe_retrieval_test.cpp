// keyframe_retrieval_test.cpp: submaps with common features are found among others, and no more pairs than
// wanted.
#include "mapping/building/keyframe_retrieval.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

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

TEST(KeyframeRetrieval, FindsNeighboursAmongManySubmaps) {
  std::mt19937 random(3);
  constexpr std::size_t kSubmaps = 30;
  std::vector<Features> doors;  // door i: seen from submaps i and i + 1, in three keyframes
  for (std::size_t i = 0; i <= kSubmaps; ++i) doors.push_back(drawn(40, random));
  KeyframeRetrieval retrieval;
  for (std::size_t i = 0; i < kSubmaps; ++i) {
    const Features *before = &doors[i], *after = &doors[i + 1];
    retrieval.add(submap_of({before, before, before, nullptr, nullptr, after, after, after}, random));
  }
  EXPECT_EQ(retrieval.keyframes(), 8 * kSubmaps);
  const std::vector<CandidatePair> pairs = retrieval.find_pairs();
  ASSERT_EQ(pairs.size(), kSubmaps - 1);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    EXPECT_EQ(pairs[i].a, i);
    EXPECT_EQ(pairs[i].b, i + 1);
    EXPECT_EQ(pairs[i].similar, 6U);
  }
}

// A recording that changes must not change which others are compared.
TEST(KeyframeRetrieval, DoesNotDependOnTheOrderOfSubmaps) {
  std::mt19937 random(8);
  constexpr std::size_t kSubmaps = 8;
  const Features corridor = drawn(40, random);
  std::vector<Submap> submaps;
  for (std::size_t i = 0; i < kSubmaps; ++i)
    submaps.push_back(submap_of({i % 3 == 0 ? &corridor : nullptr, &corridor, &corridor, nullptr}, random));
  KeyframeRetrieval forward, backward;
  for (std::size_t i = 0; i < kSubmaps; ++i) {
    forward.add(submaps[i]);
    backward.add(submaps[kSubmaps - 1 - i]);
  }
  std::vector<CandidatePair> expected = forward.find_pairs(), found = backward.find_pairs();
  ASSERT_EQ(found.size(), kSubmaps * (kSubmaps - 1) / 2);
  ASSERT_EQ(expected.size(), found.size());
  const auto last = [](const CandidatePair& pair) {
    return CandidatePair{kSubmaps - 1 - pair.b, kSubmaps - 1 - pair.a, pair.similar};
  };
  std::transform(found.begin(), found.end(), found.begin(), last);
  std::sort(found.begin(), found.end(), [](const CandidatePair& one, const CandidatePair& other) {
    return std::pair(one.a, one.b) < std::pair(other.a, other.b);
  });
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(std::pair(found[i].a, found[i].b), std::pair(expected[i].a, expected[i].b));
    EXPECT_EQ(found[i].similar, expected[i].similar);
  }
}

TEST(KeyframeRetrieval, OneSimilarKeyframeIsNotEnough) {
  std::mt19937 random(4);
  const Features door = drawn(40, random);
  KeyframeRetrieval retrieval;
  EXPECT_TRUE(retrieval.find_pairs().empty());
  retrieval.add(submap_of({&door, nullptr}, random));
  retrieval.add(submap_of({nullptr, &door}, random));
  retrieval.add({});
  EXPECT_TRUE(retrieval.find_pairs().empty());
}

// Corridors that all look alike: the number of pairs grows with the number of submaps, not with its square.
TEST(KeyframeRetrieval, KeepsTheBestPartnersOfEachSubmap) {
  std::mt19937 random(5);
  constexpr std::size_t kSubmaps = 20;
  const Features corridor = drawn(40, random), room = drawn(40, random);
  RetrievalConfig config;
  config.partners = 3;
  KeyframeRetrieval retrieval(config);
  for (std::size_t i = 0; i < kSubmaps; ++i) {
    const Features* also = i == 2 || i == 17 ? &room : nullptr;
    retrieval.add(submap_of({&corridor, &corridor, also, also, also}, random));
  }
  const std::vector<CandidatePair> pairs = retrieval.find_pairs();
  EXPECT_LE(pairs.size(), 3 * kSubmaps);
  EXPECT_GE(pairs.size(), kSubmaps);
  const bool has_best = std::any_of(pairs.begin(), pairs.end(),
                                    [](const CandidatePair& pair) { return pair.a == 2 && pair.b == 17; });
  EXPECT_TRUE(has_best);
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
