// bit_grid_test.cpp: boxes of bits against voxel-by-voxel operations, in rows of more than one word.
#include "mapping/surface/unknown/bit_grid.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "mapping/surface/unknown/blocked_neighbours.hpp"
#include "mapping/surface/unknown/run_grid.hpp"
#include "mapping/surface/unknown/voxel_face_mesh.hpp"

namespace roomradar::bit_grid_test {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

const Vector3i kSize(150, 9, 7);

template <typename Visit>
void for_each_voxel(const Vector3i& size, const Visit& visit) {
  for (int z = 0; z < size.z(); ++z)
    for (int y = 0; y < size.y(); ++y)
      for (int x = 0; x < size.x(); ++x) visit(Vector3i(x, y, z));
}

BitGrid random_bits(std::mt19937& random, unsigned out_of_8) {
  BitGrid bits(kSize, false);
  for_each_voxel(kSize, [&](const Vector3i& p) { bits.set(p, random() % 8 < out_of_8); });
  return bits;
}

TEST(BitGrid, ABoxIsSetAsFarAsItLiesInside) {
  BitGrid bits(kSize, false);
  bits.set_box({60, -3, 2}, {131, 4, 99}, true);
  bits.set_box({70, 1, 3}, {70, 5, 5}, true);  // empty
  std::size_t count = 0;
  bits.for_each_set([&](const Vector3i&) { ++count; });
  EXPECT_EQ(count, 71U * 4U * 5U);
  EXPECT_TRUE(bits.at({130, 0, 6}));
  EXPECT_FALSE(bits.at({131, 0, 6}));
}

TEST(RunGrid, HoldsTheSameBits) {
  std::mt19937 random(3);
  for (const unsigned out_of_8 : {0U, 1U, 4U, 7U, 8U}) {  // none, and one run across all rows
    const BitGrid bits = random_bits(random, out_of_8);
    const RunGrid runs(bits);
    int wrong = 0;
    for_each_voxel(kSize + Vector3i::Constant(2), [&](const Vector3i& p) {
      const Vector3i at = p - Vector3i::Ones();  // also outside
      wrong += runs.at(at) != bits.at(at);
    });
    EXPECT_EQ(wrong, 0) << out_of_8;
    EXPECT_EQ(runs.size(), bits.size());
    EXPECT_TRUE(RunGrid(kSize, {runs.ends().begin(), runs.ends().end()}) == runs);
    EXPECT_TRUE(std::is_sorted(runs.ends().begin(), runs.ends().end(), std::less_equal<>())) << out_of_8;
    if (out_of_8 == 8) {
      EXPECT_EQ(runs.ends().size(), 2U);
    }
  }
  EXPECT_FALSE(RunGrid().at({0, 0, 0}));
  EXPECT_FALSE(RunGrid(BitGrid({0, 3, 2}, true)).at({0, 0, 0}));
}

TEST(BitGrid, OpeningKeepsWhatLiesInAWholeCube) {
  std::mt19937 random(2);
  for (const auto& cube : {std::pair(2, 1), std::pair(2, 2), std::pair(3, 1), std::pair(3, 3)}) {
    const int edge = cube.first, lattice = cube.second;
    const BitGrid bits = random_bits(random, 7), result = opened(bits, edge, lattice);
    int wrong = 0;
    std::size_t kept = 0;
    for_each_voxel(kSize, [&](const Vector3i& p) {
      bool in_cube = false;
      for_each_voxel(Vector3i::Constant(edge), [&](const Vector3i& offset) {
        const Vector3i low = p - offset;
        if ((low.unaryExpr([&](int v) { return v % lattice; }).array() != 0).any()) return;
        bool whole = true;
        for_each_voxel(Vector3i::Constant(edge), [&](const Vector3i& q) { whole &= bits.at(low + q); });
        in_cube |= whole;
      });
      wrong += result.at(p) != in_cube ? 1 : 0;
      kept += in_cube ? 1 : 0;
    });
    EXPECT_EQ(wrong, 0) << "cubes of " << edge << ", lattice " << lattice;
    EXPECT_GT(kept, 100U);
  }
}

SparseBitGrid sparse(const BitGrid& bits) {
  std::vector<Vector3i> set;
  bits.for_each_set([&](const Vector3i& p) { set.push_back(p); });
  std::reverse(set.begin(), set.end());
  set.insert(set.end(), {Vector3i(-1, 0, 0), Vector3i(0, kSize.y(), 0), kSize});  // outside: ignored
  return {kSize, set};
}

TEST(SparseBitGrid, HoldsTheVoxelsThatWereSetAndNoOthers) {
  std::mt19937 random(5);
  for (const unsigned out_of_8 : {0U, 1U, 8U}) {
    const BitGrid bits = random_bits(random, out_of_8);
    const SparseBitGrid few = sparse(bits);
    int wrong = 0;
    for_each_voxel(kSize, [&](const Vector3i& p) { wrong += few.at(p) != bits.at(p) ? 1 : 0; });
    EXPECT_EQ(wrong, 0);
    EXPECT_FALSE(few.at({-1, 0, 0}));
    EXPECT_FALSE(few.at(kSize));
  }
  EXPECT_EQ(sparse(BitGrid(kSize, false)).memory_bytes(), 0U);
  EXPECT_EQ(SparseBitGrid(kSize, std::vector<Vector3i>(5, Vector3i(70, 3, 2))).memory_bytes(), 12U);
}

TEST(BitGrid, VoxelsBesideOthersAreThoseWhoseStepIsNotBarred) {
  std::mt19937 random(1);
  const BitGrid bits = random_bits(random, 4), other = random_bits(random, 4), bars = random_bits(random, 2);
  for (int axis = 0; axis < 3; ++axis)
    for (const int step : {-1, 1}) {
      BitGrid visited(kSize, false), expected(kSize, false);
      bits.for_each_set_beside(other, axis, step, sparse(bars), [&](const Vector3i& p) {
        EXPECT_FALSE(visited.at(p));
        visited.set(p, true);
      });
      for_each_voxel(kSize, [&](const Vector3i& p) {
        const Vector3i next = p + step * Vector3i::Unit(axis), lower = step > 0 ? p : next;
        expected.set(p, bits.at(p) && other.at(next) && !bars.at(lower));
      });
      EXPECT_EQ(visited, expected) << "axis " << axis << ", step " << step;
    }
}

// Steps by their definition, voxel by voxel.
BitGrid slowly_spread(const BitGrid& from, const BitGrid& where,
                      const std::array<SparseBitGrid, 3>& blocked) {
  BitGrid to = from;
  for_each_voxel(kSize, [&](const Vector3i& p) {
    if (!from.at(p)) return;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3i up = p + Vector3i::Unit(axis), down = p - Vector3i::Unit(axis);
      const SparseBitGrid& bars = blocked[static_cast<std::size_t>(axis)];
      if (where.at(up) && !bars.at(p)) to.set(up, true);
      if (where.at(down) && !bars.at(down)) to.set(down, true);
    }
  });
  return to;
}

TEST(BitGrid, SpreadingAndFloodingTakeTheStepsThatAreNotBarred) {
  std::mt19937 random(3);
  const BitGrid where = random_bits(random, 6);
  const std::array<SparseBitGrid, 3> blocked = {
      sparse(random_bits(random, 2)), sparse(random_bits(random, 2)), sparse(random_bits(random, 2))};
  BitGrid bits(kSize, false);
  bits.set_box({64, 3, 3}, {67, 5, 5}, true);
  const BitGrid seed = bits;
  BitGrid slow = bits;
  for (int step = 0; step < 5; ++step) {
    bits.spread(where, blocked);
    slow = slowly_spread(slow, where, blocked);
    ASSERT_EQ(bits, slow) << "step " << step;
  }
  for (BitGrid before; !(before == slow);) {
    before = slow;
    slow = slowly_spread(slow, where, blocked);
  }
  bits = seed;
  bits.flood(where, blocked);
  EXPECT_EQ(bits, slow);
  EXPECT_NE(bits, seed);
}

// Every face is in exactly one rectangle, and rectangles contain nothing else.
TEST(VoxelFaces, RectanglesCoverEachFaceOnce) {
  std::mt19937 random(4);
  const CellGrid grid{{-3, 5, 100}, kSize, 0.5};
  for (int axis = 0; axis < 3; ++axis)
    for (const int step : {-1, 1}) {
      const BitGrid cells = random_bits(random, 6);
      VoxelFaceMesher mesher(grid);
      VoxelFaces faces(axis, step);
      cells.for_each_set([&](const Vector3i& p) { faces.add(p); });
      mesher.add(faces);
      const Mesh mesh = mesher.take();
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      BitGrid covered(kSize, false);
      for (std::size_t i = 0; i < mesh.triangles.size(); i += 2) {
        // Two triangles, a b c and a c d: a rectangle from its lowest to its highest corner.
        Eigen::AlignedBox3d bounds;
        Vector3d area = Vector3d::Zero();
        for (const std::size_t t : {i, i + 1}) {
          std::array<Vector3d, 3> p;
          for (std::size_t k = 0; k < 3; ++k) {
            p[k] = (mesh.origin + mesh.vertices[mesh.triangles[t][k]].cast<double>()) / grid.cell_m;
            bounds.extend(p[k]);
          }
          area += 0.5 * (p[1] - p[0]).cross(p[2] - p[0]);
        }
        const auto corner = [&](const Vector3d& p) -> Vector3i {
          return p.array().round().cast<int>().matrix() - grid.first_cell;
        };
        const Vector3i low = corner(bounds.min()), high = corner(bounds.max());
        EXPECT_NEAR(area[axis], step * (high[u] - low[u]) * (high[v] - low[v]), 1e-6);
        for (int b = low[v]; b < high[v]; ++b)
          for (int a = low[u]; a < high[u]; ++a) {
            Vector3i cell;
            cell[axis] = step > 0 ? low[axis] - 1 : low[axis];
            cell[u] = a;
            cell[v] = b;
            ASSERT_FALSE(covered.at(cell)) << cell.transpose();
            covered.set(cell, true);
          }
      }
      EXPECT_EQ(covered, cells);
    }
}

// A ball of triangles, not all of them small.
Mesh ball(double radius_m, int rings) {
  Mesh mesh;
  mesh.origin = Vector3d(3.0, -2.0, 1.0);
  const int columns = 2 * rings;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < columns; ++j) {
      const double polar = std::numbers::pi * i / rings, around = 2.0 * std::numbers::pi * j / columns;
      mesh.vertices.push_back(Vector3d(radius_m * std::sin(polar) * std::cos(around),
                                       radius_m * std::sin(polar) * std::sin(around),
                                       radius_m * std::cos(polar))
                                  .cast<float>());
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * columns + j % columns); };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < columns; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

TEST(BarredSteps, NoWayOfStepsLeadsOutOfAClosedSurface) {
  for (const int rings : {4, 30}) {
    const Mesh mesh = ball(0.5, rings);
    CellGrid grid;
    grid.cell_m = 0.02;
    grid.first_cell = (mesh.origin / grid.cell_m).array().floor().cast<int>() - 30;
    grid.size = Vector3i::Constant(60);
    const BitGrid everywhere(grid.size, true);
    BitGrid inside(grid.size, false);
    inside.set(Vector3i::Constant(30), true);
    inside.flood(everywhere, blocked_neighbours(mesh, grid));
    std::size_t cells = 0;
    inside.for_each_set([&](const Vector3i&) { ++cells; });
    const double volume_cells = 4.0 / 3.0 * std::numbers::pi * std::pow(0.5 / 0.02, 3);
    EXPECT_LT(static_cast<double>(cells), volume_cells);
    if (rings == 30) {
      EXPECT_GT(static_cast<double>(cells), 0.97 * volume_cells);
    }
  }
}

TEST(BarredSteps, OnlyStepsThatMeetTheSurfaceAreBarred) {
  Mesh mesh;  // one triangle across z = 0.1
  mesh.vertices = {{0.05F, 0.05F, 0.1F}, {0.35F, 0.05F, 0.1F}, {0.05F, 0.35F, 0.1F}};
  mesh.triangles = {{0, 1, 2}};
  const CellGrid grid{Vector3i::Zero(), Vector3i(8, 8, 4), 0.05};
  const auto blocked = blocked_neighbours(mesh, grid);
  std::set<std::tuple<int, int, int>> cells;
  const BitGrid everywhere(grid.size, true);
  everywhere.for_each_set([&](const Vector3i& p) {
    if (blocked[2].at(p)) cells.insert({p.x(), p.y(), p.z()});
  });
  // Cell centres are at 0.075, 0.125, ...; those with x + y <= 0.4 are above it.
  std::set<std::tuple<int, int, int>> expected;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      if (x >= 1 && y >= 1 && 0.05 * (x + y + 1) <= 0.4 + 1e-6) expected.insert({x, y, 1});
  EXPECT_EQ(cells, expected);
  for (const std::size_t axis : {0U, 1U}) EXPECT_EQ(blocked[axis].memory_bytes(), 0U);
  mesh.vertices[1].x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(blocked_neighbours(mesh, grid)[2].memory_bytes(), 0U);
  mesh.vertices[1].x() = 1e30F;  // far beyond the grid
  mesh.vertices[2].y() = -1e30F;
  EXPECT_NO_THROW(static_cast<void>(blocked_neighbours(mesh, grid)));
}

}  // namespace
}  // namespace roomradar::bit_grid_test
