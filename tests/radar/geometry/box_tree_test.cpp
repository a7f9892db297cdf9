// box_tree_test.cpp: same results as testing each box, with fewer tests.
#include "radar/geometry/box_tree.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/radar/shapes.hpp"

namespace roomradar::box_tree_test {
namespace {

TEST(BoxTree, FindsWhatAskingEachFindsInOrder) {
  std::mt19937 random(3);
  BoxTree tree;
  for (const std::size_t count : {0U, 1U, 7U, 8U, 9U, 64U, 65U, 1000U}) {
    std::vector<Eigen::AlignedBox3d> boxes(count);
    for (std::size_t i = 0; i < count; ++i) {  // along a line, so neighbours are close together
      const Eigen::Vector3d p = shapes::random_point(random) + Eigen::Vector3d(0.1 * double(i), 0, 0);
      boxes[i] = {p, p + 0.2 * (shapes::random_point(random) + Eigen::Vector3d::Ones())};
    }
    tree.build(boxes);
    EXPECT_EQ(tree.size(), count);
    const Eigen::AlignedBox3d wanted(Eigen::Vector3d(20, -0.5, -0.5), Eigen::Vector3d(21, 0.5, 0.5));
    std::vector<std::size_t> expected, found;
    for (std::size_t i = 0; i < count; ++i) {
      if (boxes[i].intersects(wanted)) expected.push_back(i);
    }
    std::size_t asked = 0;
    tree.visit(
        [&](const Eigen::AlignedBox3d& box) {
          ++asked;
          return box.intersects(wanted);
        },
        [&](std::size_t i) { found.push_back(i); });
    EXPECT_EQ(found, expected);
    if (count == 1000) {
      EXPECT_LT(asked, 150U);
    }
  }
}

}  // namespace
}  // namespace roomradar::box_tree_test
