// cell_outline_test.cpp: polygons of cut cells, and triangles of bisected squares.
#include "dynamic/surface/cell_outline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "dynamic/surface/pixel_bits.hpp"
#include "dynamic/surface/rtin.hpp"

namespace roomradar::cell_outline_test {
namespace {

CellBits where(bool (*is_in)(int x, int y)) {
  CellBits bits = 0;
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 5; ++x) bits |= CellBits{is_in(x, y)} << (5 * y + x);
  return bits;
}

TEST(CellOutline, AWholeCellIsItsRing) {
  RingArc arc;
  ASSERT_TRUE(find_outline(kWholeCell, arc));
  EXPECT_EQ(arc.count, 16);
  ASSERT_TRUE(find_outline(kWholeCell & ~(CellBits{1} << 12), arc)) << "a speck in the middle";
  EXPECT_EQ(arc.count, 16);
}

TEST(CellOutline, AStraightCutIsFollowedAndAThinBandIsNot) {
  RingArc arc;
  ASSERT_TRUE(find_outline(where([](int x, int) { return x >= 2; }), arc));
  EXPECT_EQ(arc.first, 6);  // (2, 4)
  EXPECT_EQ(arc.count, 9);  // to (2, 0)
  ASSERT_TRUE(find_outline(where([](int x, int y) { return x + y <= 3; }), arc));
  EXPECT_EQ(arc.count, 7);
  EXPECT_FALSE(find_outline(where([](int x, int) { return x == 2; }), arc)) << "two runs";
  EXPECT_FALSE(find_outline(where([](int x, int y) { return x == 0 || y == 0 || (x == 1 && y == 4); }), arc))
      << "hollow";
}

TEST(CellOutline, TrianglesCoverThePolygonWhateverItsCorners) {
  for (int first = 0; first < 16; ++first) {
    for (int count = 1; count <= 16; ++count) {
      for (const unsigned keep : {0xFFFFU, 0x1111U, 0x5555U, 0x1F1FU}) {
        std::vector<int> corners;
        for (int k = 0; k < count; ++k) {
          const int i = (first + k) % 16;
          if (k == 0 || k == count - 1 || (keep >> i & 1U) != 0 || i % 4 == 0) corners.push_back(i);
        }
        const auto pixel = [&](std::size_t i) { return kRing[static_cast<std::size_t>(corners[i])]; };
        const auto twice_area = [&](std::size_t a, std::size_t b, std::size_t c) {
          const CellPixel p = pixel(a), q = pixel(b), r = pixel(c);
          return (q.y - p.y) * (r.x - p.x) - (q.x - p.x) * (r.y - p.y);
        };
        int area = 0;
        for (std::size_t i = 1; i + 1 < corners.size(); ++i) area += twice_area(0, i, i + 1);
        const CellTriangles triangles = triangulate(corners.data(), static_cast<int>(corners.size()));
        int covered = 0;
        for (int t = 0; t < triangles.count; ++t) {
          const auto& c = triangles.triangles[static_cast<std::size_t>(t)];
          ASSERT_GT(twice_area(c[0], c[1], c[2]), 0);
          covered += twice_area(c[0], c[1], c[2]);
        }
        ASSERT_EQ(covered, area) << first << " " << count;
        if (area > 0) {
          ASSERT_EQ(triangles.count, static_cast<int>(corners.size()) - 2);
        }
      }
    }
  }
}

TEST(PixelBits, MajorityAndFarAreWhatCountingSays) {
  std::mt19937 random(2);
  for (const int width : {1, 63, 64, 130}) {
    PixelBits bits, smooth, far;
    bits.resize(width, 9);
    for (int y = 0; y < 9; ++y)
      for (int x = 0; x < width; ++x)
        if (random() % 2 == 0) bits.row(y)[x >> 6] |= std::uint64_t{1} << (x & 63);
    take_majority(bits, smooth);
    take_far_from(bits, smooth, far);
    for (int y = 0; y < 9; ++y) {
      for (int x = 0; x < 64 * bits.words; ++x) {
        int count = 0;
        bool near = false;
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            count += bits.at(x + dx, y + dy) ? 1 : 0;
            near = near || smooth.at(x + dx, y + dy);
          }
        }
        ASSERT_EQ(smooth.at(x, y), x < width && count >= 5) << x << " " << y;
        ASSERT_EQ(far.at(x, y), bits.at(x, y) && !near) << x << " " << y;
      }
    }
  }
}

// Every triangle is within the tolerance of every grid point on it, and no vertex is inside another
// triangle's side.
TEST(Rtin, FollowsTheValuesWithoutCracks) {
  constexpr int kPoints = 33;
  std::mt19937 random(4);
  std::normal_distribution<float> normal;
  for (int round = 0; round < 10; ++round) {
    std::vector<float> values(kPoints * kPoints), tolerances(kPoints * kPoints, 0.1F);
    std::vector<std::uint8_t> needed(kPoints * kPoints, 0), cells((kPoints - 1) * (kPoints - 1), 1);
    const float bend = 0.02F * static_cast<float>(round);
    for (int y = 0; y < kPoints; ++y)
      for (int x = 0; x < kPoints; ++x)
        values[static_cast<std::size_t>(y * kPoints + x)] =
            0.3F * static_cast<float>(x) + bend * std::pow(static_cast<float>(y - 16), 2.0F) / 8.0F +
            (round % 3 == 0 ? 0.05F * normal(random) : 0.0F);
    needed[17 * kPoints + 11] = 1;
    const Rtin grid{kPoints, kPoints, cells};
    find_needed(grid, values, tolerances, needed);
    std::map<std::pair<int, int>, int> edges;  // directed, as point indices
    long area = 0;
    for (int row = 0; row + 1 < kPoints; row += 8) {
      for (int column = 0; column + 1 < kPoints; column += 8) {
        walk_square(grid, needed, column, row, [&](GridPoint a, GridPoint b, GridPoint c) {
          const auto cross = [](GridPoint p, GridPoint q, GridPoint r) {
            return (q.y - p.y) * (r.x - p.x) - (q.x - p.x) * (r.y - p.y);
          };
          const int twice = cross(a, b, c);
          ASSERT_GT(twice, 0);
          area += twice;
          const auto id = [&](GridPoint p) { return p.y * kPoints + p.x; };
          const auto value = [&](GridPoint p) { return values[static_cast<std::size_t>(id(p))]; };
          for (const auto& [p, q] : {std::pair{a, b}, {b, c}, {c, a}}) {
            if (edges.erase({id(q), id(p)}) == 0) edges[{id(p), id(q)}] = 1;
          }
          for (int y = 0; y < kPoints; ++y) {
            for (int x = 0; x < kPoints; ++x) {
              const GridPoint p{x, y};
              const int wa = cross(p, b, c), wb = cross(a, p, c), wc = cross(a, b, p);
              if (wa < 0 || wb < 0 || wc < 0) continue;
              const float flat = (static_cast<float>(wa) * value(a) + static_cast<float>(wb) * value(b) +
                                  static_cast<float>(wc) * value(c)) /
                                 static_cast<float>(twice);
              ASSERT_LE(std::abs(flat - value(p)), 0.1F + 1e-4F);
            }
          }
        });
      }
    }
    EXPECT_EQ(area, 2L * (kPoints - 1) * (kPoints - 1));
    for (const auto& [edge, one] : edges) {  // only the grid's own border is left
      const auto on_border = [&](int id) {
        const int x = id % kPoints, y = id / kPoints;
        return x == 0 || y == 0 || x == kPoints - 1 || y == kPoints - 1;
      };
      EXPECT_TRUE(on_border(edge.first) && on_border(edge.second));
    }
    if (round == 1) {
      EXPECT_LT(std::count(needed.begin(), needed.end(), 1), kPoints * kPoints / 2);
    }
  }
}

}  // namespace
}  // namespace roomradar::cell_outline_test
