// exact_gap_test.cpp: exact_gap against results computed by hand and against a convex hull of differences.
#include "tests/support/exact_gap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/radar/shapes.hpp"

namespace roomradar::exact_gap_test {
namespace {

/// The same result by another method: object + t z and scene touch if t z is a convex combination of the nine
/// differences scene vertex - object vertex. The least and the greatest t are combinations of at most three
/// of them.
std::optional<TravelSpan> gap_by_differences(const ExactTriangle& object, const ExactTriangle& scene) {
  std::vector<ExactPoint> q;
  for (const ExactPoint& o : object) {
    for (const ExactPoint& s : scene) q.push_back(s - o);
  }
  Exact least = std::numeric_limits<Exact>::infinity(), most = -least;
  for (std::size_t i = 0; i < 9; ++i) {
    for (std::size_t j = i + 1; j < 9; ++j) {
      for (std::size_t k = j + 1; k < 9; ++k) {
        const auto cross = [](const ExactPoint& a, const ExactPoint& b) {
          return a.x() * b.y() - a.y() * b.x();
        };
        const Exact a = cross(q[j], q[k]), b = cross(q[k], q[i]), c = cross(q[i], q[j]);
        if (!((a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0))) continue;
        const Exact t = (a * q[i].z() + b * q[j].z() + c * q[k].z()) / (a + b + c);
        least = std::min(least, t);
        most = std::max(most, t);
      }
    }
  }
  if (least > most) return std::nullopt;
  return TravelSpan{static_cast<double>(least), static_cast<double>(most)};
}

ExactPoint random_point(std::mt19937& random) { return shapes::random_point(random).cast<Exact>(); }

void expect_same(const ExactTriangle& object, const ExactTriangle& scene, double tolerance_m, int& met) {
  const auto got = exact_gap(object, scene);
  const auto expected = gap_by_differences(object, scene);
  ASSERT_EQ(got.has_value(), expected.has_value());
  if (!got) return;
  ++met;
  EXPECT_NEAR(got->from_m, expected->from_m, tolerance_m);
  EXPECT_NEAR(got->to_m, expected->to_m, tolerance_m);
}

TEST(ExactGap, AgreesWithTheHullOfDifferences) {
  std::mt19937 random(1);
  int met = 0;
  for (int i = 0; i < 5000 && !HasFailure(); ++i) {
    const ExactTriangle object = {random_point(random), random_point(random), random_point(random)};
    const ExactTriangle scene = {random_point(random), random_point(random), random_point(random)};
    expect_same(object, scene, 1e-12, met);
  }
  EXPECT_GT(met, 3000);
}

TEST(ExactGap, AgreesOnNeedlesAndOnFacesAHairFromUpright) {
  std::mt19937 random(2);
  int met = 0;
  for (const Exact thin : {1e-3L, 1e-6L, 1e-9L}) {
    for (int i = 0; i < 2000 && !HasFailure(); ++i) {
      ExactTriangle object = {random_point(random), random_point(random), random_point(random)};
      ExactTriangle scene = {random_point(random), random_point(random), random_point(random)};
      object[2] = object[0] + 0.5L * (object[1] - object[0]) + thin * random_point(random);  // needle
      scene[2].head<2>() = scene[0].head<2>() + 0.5L * (scene[1] - scene[0]).head<2>() +
                           thin * random_point(random).head<2>();  // nearly edge-on
      expect_same(object, scene, 1e-7, met);
      expect_same(scene, object, 1e-7, met);
    }
  }
  EXPECT_GT(met, 2000);
}

TEST(ExactGap, FaceOverFace) {
  const ExactTriangle low = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  const ExactTriangle high = {{{0.1L, 0.1L, 2}, {0.8L, 0.1L, 2}, {0.1L, 0.8L, 3}}};
  const auto up = exact_gap(low, high);
  ASSERT_TRUE(up);
  EXPECT_NEAR(up->from_m, 2.0, 1e-15);
  EXPECT_NEAR(up->to_m, 3.0, 1e-15);
  const auto down = exact_gap(high, low);
  ASSERT_TRUE(down);
  EXPECT_NEAR(down->from_m, -3.0, 1e-15);
  EXPECT_NEAR(down->to_m, -2.0, 1e-15);
}

TEST(ExactGap, SameOutlineMeetsThoughAllItsCornersCoincide) {
  const ExactTriangle low = {{{0.3L, 0.1L, 0}, {1.7L, 0.2L, 0}, {0.4L, 1.9L, 0}}};
  ExactTriangle high = low;
  for (ExactPoint& p : high) p.z() += 0.25L;
  const auto span = exact_gap(low, high);
  ASSERT_TRUE(span);
  EXPECT_NEAR(span->from_m, 0.25, 1e-15);
  EXPECT_NEAR(span->to_m, 0.25, 1e-15);
}

TEST(ExactGap, UprightTriangleIsItsEdges) {
  const ExactTriangle upright = {{{0.2L, 0.2L, 1}, {0.4L, 0.2L, 1}, {0.3L, 0.2L, 4}}};
  const ExactTriangle flat = {{{0, 0, 5}, {1, 0, 5}, {0, 1, 5}}};
  const auto span = exact_gap(upright, flat);  // its tip touches first, its foot last
  ASSERT_TRUE(span);
  EXPECT_NEAR(span->from_m, 1.0, 1e-15);
  EXPECT_NEAR(span->to_m, 4.0, 1e-15);
}

TEST(ExactGap, TwoUprightTrianglesInOnePlane) {
  const ExactTriangle low = {{{0, 0, 0}, {3, 4, 0}, {1.5L, 2, 1}}};    // tip up, at the middle of 5 m
  const ExactTriangle high = {{{0, 0, 5}, {3, 4, 5}, {0.75L, 1, 2}}};  // tip down, at a quarter
  const auto span = exact_gap(low, high);
  ASSERT_TRUE(span);
  EXPECT_NEAR(span->from_m, 1.5, 1e-12);  // at a quarter of the lower triangle: 2 - 0.5
  EXPECT_NEAR(span->to_m, 5.0, 1e-12);
}

TEST(ExactGap, PointsAndSegmentsTouchToo) {
  const ExactPoint p(0.25L, 0.25L, 1);
  const ExactTriangle flat = {{{0, 0, 3}, {1, 0, 3}, {0, 1, 3}}};
  const auto point = exact_gap({{p, p, p}}, flat);
  ASSERT_TRUE(point);
  EXPECT_EQ(point->from_m, 2.0);
  const auto segment = exact_gap({{p, p, p + ExactPoint(0, 0, 1)}}, flat);
  ASSERT_TRUE(segment);
  EXPECT_EQ(segment->from_m, 1.0);
  EXPECT_EQ(segment->to_m, 2.0);
}

TEST(ExactGap, BesideIsNothing) {
  const ExactTriangle a = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  const ExactTriangle b = {{{0.6L, 0.6L, 0}, {1, 0.6L, 0}, {0.6L, 1, 0}}};  // boxes overlap, outlines do not
  EXPECT_FALSE(exact_gap(a, b));
}

}  // namespace
}  // namespace roomradar::exact_gap_test
