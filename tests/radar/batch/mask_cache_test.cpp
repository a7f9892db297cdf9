// mask_cache_test.cpp: cached masks are found, and masks used in the current round are not evicted.
#include "radar/batch/mask_cache.hpp"

#include <gtest/gtest.h>

namespace roomradar::mask_cache_test {
namespace {

MaskKey key(std::int64_t i) { return {static_cast<std::uint64_t>(i % 5), {i, 2 * i, -i}}; }

TEST(MaskCache, FindsWhatItHoldsAndNothingElse) {
  MaskCache cache;
  EXPECT_EQ(cache.find(key(1)), MaskCache::kNone);
  EXPECT_EQ(cache.claim(key(1)), MaskCache::kNone) << "no tiles yet";
  cache.reset(100);
  cache.begin_round();
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(cache.find(key(i)), MaskCache::kNone);
    const std::size_t tile = cache.claim(key(i));
    ASSERT_NE(tile, MaskCache::kNone);
    EXPECT_FALSE(cache.mask(tile).is_drawn);
    cache.mask(tile).is_drawn = true;
    EXPECT_EQ(cache.find(key(i)), tile);
  }
  EXPECT_EQ(cache.claim(key(100)), MaskCache::kNone) << "this round uses them all";
  for (int i = 0; i < 100; ++i) EXPECT_NE(cache.find(key(i)), MaskCache::kNone);
}

TEST(MaskCache, GivesAwayOnlyWhatTheRoundDoesNotUse) {
  MaskCache cache;
  cache.reset(10);
  cache.begin_round();
  for (int i = 0; i < 10; ++i) ASSERT_NE(cache.claim(key(i)), MaskCache::kNone);
  cache.begin_round();
  for (int i = 0; i < 4; ++i) ASSERT_NE(cache.find(key(i)), MaskCache::kNone);
  for (int i = 10; i < 16; ++i) {
    const std::size_t tile = cache.claim(key(i));
    ASSERT_NE(tile, MaskCache::kNone);
    EXPECT_FALSE(cache.mask(tile).is_drawn) << "of another object";
  }
  EXPECT_EQ(cache.claim(key(16)), MaskCache::kNone);
  for (int i = 0; i < 4; ++i) EXPECT_NE(cache.find(key(i)), MaskCache::kNone) << i;
  for (int i = 4; i < 10; ++i) EXPECT_EQ(cache.find(key(i)), MaskCache::kNone) << i;
  cache.forget();
  for (int i = 0; i < 16; ++i) EXPECT_EQ(cache.find(key(i)), MaskCache::kNone) << i;
}

}  // namespace
}  // namespace roomradar::mask_cache_test
