// map_content.hpp: the samples of a static map, and a check that two maps are the same.
#pragma once
#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "mapping/octree/static_map.hpp"

namespace roomradar::test {

inline std::vector<SurfaceSample> samples_of(const StaticMap& map) {
  std::vector<SurfaceSample> samples;
  map.visit_samples([&](const SurfaceSample& sample) { samples.push_back(sample); });
  return samples;
}

inline void expect_equal(const StaticMap& a, const StaticMap& b) {
  const std::vector<SurfaceSample> in_a = samples_of(a), in_b = samples_of(b);
  ASSERT_EQ(in_a.size(), in_b.size());
  for (std::size_t i = 0; i < in_a.size(); ++i) {
    ASSERT_EQ(in_a[i].voxel, in_b[i].voxel);
    ASSERT_EQ(in_a[i].distance_m, in_b[i].distance_m);
    ASSERT_EQ(in_a[i].weight, in_b[i].weight);
    ASSERT_EQ(in_a[i].colour, in_b[i].colour);
    ASSERT_EQ(in_a[i].occupancy, in_b[i].occupancy);
  }
  const MapCounts counts_a = a.counts(), counts_b = b.counts();
  EXPECT_EQ(counts_a.nodes, counts_b.nodes);
  EXPECT_EQ(counts_a.free_leaves, counts_b.free_leaves);
  EXPECT_EQ(counts_a.occupied_leaves, counts_b.occupied_leaves);
  EXPECT_EQ(counts_a.memory_bytes, counts_b.memory_bytes);
}

}  // namespace roomradar::test
