// hitting_set_test.cpp: the cheapest set that breaks all conflicts, against trying all sets.
#include "mapping/building/hitting_set.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace roomradar::hitting_set_test {
namespace {

bool breaks_all(unsigned set, const std::vector<Conflict>& conflicts) {
  return std::all_of(conflicts.begin(), conflicts.end(), [&](const Conflict& conflict) {
    return std::any_of(conflict.begin(), conflict.end(), [&](std::size_t e) { return set >> e & 1U; });
  });
}

double cost_of(unsigned set, const std::vector<double>& costs) {
  double cost = 0.0;
  for (std::size_t e = 0; e < costs.size(); ++e) cost += set >> e & 1U ? costs[e] : 0.0;
  return cost;
}

TEST(HittingSet, IsTheCheapestOfAllSets) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> cost(0.1, 2.0);
  constexpr std::size_t kElements = 12;
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<double> costs(kElements);
    std::generate(costs.begin(), costs.end(), [&] { return cost(random); });
    std::vector<Conflict> conflicts(1 + random() % 15);
    for (Conflict& conflict : conflicts) {
      for (std::size_t e = 0; e < kElements; ++e)
        if (random() % 4 == 0) conflict.push_back(e);
      if (conflict.empty()) conflict.push_back(random() % kElements);
    }
    double least = std::numeric_limits<double>::infinity();
    for (unsigned set = 0; set < 1U << kElements; ++set)
      if (breaks_all(set, conflicts)) least = std::min(least, cost_of(set, costs));
    unsigned found = 0;
    for (const std::size_t e : cheapest_hitting_set(conflicts, costs)) found |= 1U << e;
    EXPECT_TRUE(breaks_all(found, conflicts)) << trial;
    EXPECT_NEAR(cost_of(found, costs), least, 1e-9) << trial;
  }
}

TEST(HittingSet, OfNoConflictIsEmptyAndOfOneElementIsThatElement) {
  const std::vector<double> costs{5.0, 1.0, 1.0};
  EXPECT_TRUE(cheapest_hitting_set({}, costs).empty());
  EXPECT_TRUE(cheapest_hitting_set({}, {}).empty());
  const std::vector<Conflict> alone{{0}, {0, 1, 2}};
  EXPECT_EQ(cheapest_hitting_set(alone, costs), (std::vector<std::size_t>{0}));
}

TEST(HittingSet, ManyConflictsOfManyElementsEndWithASetThatBreaksThem) {
  std::mt19937 random(1);
  const std::vector<double> costs(200, 1.0);
  std::vector<Conflict> conflicts(400);
  for (Conflict& conflict : conflicts)
    for (int i = 0; i < 6; ++i) conflict.push_back(random() % costs.size());
  const std::vector<std::size_t> found = cheapest_hitting_set(conflicts, costs);
  for (const Conflict& conflict : conflicts)
    EXPECT_TRUE(std::any_of(conflict.begin(), conflict.end(), [&](std::size_t e) {
      return std::binary_search(found.begin(), found.end(), e);
    }));
  EXPECT_LT(found.size(), 130U);
}

}  // namespace
}  // namespace roomradar::hitting_set_test
