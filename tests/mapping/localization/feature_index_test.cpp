// feature_index_test.cpp: the index finds keyframes with noisy copies of a view's descriptors, and those
// alone.
#include "mapping/localization/feature_index.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "mapping/localization/place_matching.hpp"

namespace roomradar::feature_index_test {
namespace {

std::vector<Descriptor> drawn(std::size_t count, std::mt19937& random) {
  std::vector<Descriptor> descriptors(count);
  for (Descriptor& one : descriptors)
    for (std::uint8_t& byte : one) byte = static_cast<std::uint8_t>(random());
  return descriptors;
}

/// Flips each bit with this probability.
std::vector<Descriptor> with_noise(std::vector<Descriptor> descriptors, double share, std::mt19937& random) {
  std::bernoulli_distribution flips(share);
  for (Descriptor& one : descriptors)
    for (std::uint8_t& byte : one)
      for (unsigned bit = 0; bit < 8; ++bit)
        if (flips(random)) byte = static_cast<std::uint8_t>(byte ^ (1U << bit));
  return descriptors;
}

TEST(FeatureIndex, FindsTheKeyframeWhoseFeaturesAreSeenAgainAmongHundreds) {
  std::mt19937 random(4);
  FeatureIndex index;
  std::vector<std::vector<Descriptor>> views;
  for (int i = 0; i < 300; ++i) {
    views.push_back(drawn(300, random));
    index.add(views.back());
  }
  EXPECT_EQ(index.size(), 300U);
  for (const std::size_t i : {0U, 7U, 150U, 299U}) {
    // A tenth of the features is seen again, with an eighth of their bits changed; the others are new.
    std::vector<Descriptor> query = drawn(270, random);
    const auto seen_again = with_noise({views[i].begin(), views[i].begin() + 30}, 0.125, random);
    query.insert(query.end(), seen_again.begin(), seen_again.end());
    const auto found = index.candidates(query, 3, {});
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found.front(), i);
    EXPECT_LE(found.size(), 3U);
    for (const std::size_t other : index.candidates(query, 3, [&](std::size_t one) { return one != i; }))
      EXPECT_NE(other, i);
  }
}

TEST(FeatureIndex, OfNothingFindsNothing) {
  std::mt19937 random(5);
  const std::vector<Descriptor> view = drawn(100, random);
  FeatureIndex index;
  EXPECT_TRUE(index.candidates(view, 5, {}).empty());
  index.add({});  // a keyframe without features has a number, too
  index.add(view);
  EXPECT_EQ(index.size(), 2U);
  EXPECT_EQ(index.candidates(view, 5, {}), std::vector<std::size_t>{1});
  EXPECT_TRUE(index.candidates({}, 5, {}).empty());
  EXPECT_TRUE(index.candidates(view, 0, {}).empty());
}

// The entries of older keyframes are sorted; it must not show.
TEST(FeatureIndex, OfThousandsCountsAsOneOfFew) {
  constexpr std::size_t kMany = 1200, kFirst = 900, kEnd = 1190;  // sorted now and then
  std::mt19937 random(7);
  FeatureIndex of_all, of_few;
  for (std::size_t i = 0; i < kMany; ++i) {
    const std::vector<Descriptor> view = drawn(300, random);
    of_all.add(view);
    if (i >= kFirst && i < kEnd) of_few.add(view);
  }
  for (int i = 0; i < 3; ++i) {
    const std::vector<Descriptor> query = drawn(300, random);
    const auto expected = of_few.candidates(query, 50, {});
    auto found = of_all.candidates(query, 50, [](std::size_t one) { return one >= kFirst && one < kEnd; });
    ASSERT_EQ(expected.size(), 50U);  // unlike features collide now and then
    for (std::size_t& one : found) one -= kFirst;
    EXPECT_EQ(found, expected);
    const auto before = of_all.candidates(query, 50, {});
    of_all.sort();
    EXPECT_EQ(of_all.candidates(query, 50, {}), before);
    of_few.sort();
    EXPECT_EQ(of_few.candidates(query, 50, {}), expected);
  }
}

TEST(FeatureIndex, AViewIsAlikeIfEnoughFeaturesMatch) {
  std::mt19937 random(9);
  for (const std::size_t common : {0U, 15U, 40U}) {
    KeyframeDatabase one;
    one.keyframes.emplace_back().descriptors = drawn(200, random);
    MapKeyframe query;
    query.descriptors = drawn(300 - common, random);
    const auto& seen = one.keyframes[0].descriptors;
    query.descriptors.insert(query.descriptors.end(), seen.begin(), seen.begin() + static_cast<int>(common));
    for (const int min_matches : {1, 15, 16, 40, 41, 301}) {
      const bool expected = static_cast<int>(common) >= min_matches;
      EXPECT_EQ(!most_alike(query, one, 1, min_matches).empty(), expected) << common << ", " << min_matches;
    }
    EXPECT_TRUE(most_alike({}, one, 1, 1).empty());
    EXPECT_TRUE(most_alike(query, {}, 1, 1).empty());
  }
}

// The database's index may be behind its keyframes, which are then compared one by one.
TEST(FeatureIndex, WhatIsMostAlikeIsTheSameWithAndWithoutIt) {
  std::mt19937 random(6);
  KeyframeDatabase compared_all;
  for (int i = 0; i < 120; ++i) {
    MapKeyframe keyframe;
    keyframe.descriptors = drawn(200, random);
    compared_all.keyframes.push_back(std::move(keyframe));
  }
  for (const std::size_t i : {20U, 60U, 100U}) {
    const auto& seen = compared_all.keyframes[i].descriptors;
    auto& again = compared_all.keyframes[i + 5].descriptors;
    std::copy_n(seen.begin(), 100, again.begin());
  }
  KeyframeDatabase indexed = compared_all;
  indexed.keyframes.resize(80);
  update_index(indexed);
  indexed.keyframes = compared_all.keyframes;
  ASSERT_EQ(indexed.index.size(), 80U);
  for (const std::size_t i : {20U, 60U, 100U}) {
    MapKeyframe query;
    query.descriptors = with_noise(compared_all.keyframes[i].descriptors, 0.08, random);
    const auto expected = most_alike(query, compared_all, 2, 25);
    EXPECT_EQ(expected, (std::vector<std::size_t>{i, i + 5}));
    EXPECT_EQ(most_alike(query, indexed, 2, 25), expected);
  }
}

}  // namespace
}  // namespace roomradar::feature_index_test
