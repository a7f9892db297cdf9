// triangle_tree_test.cpp: boxes contain their subtrees, no triangle is lost, closed and open meshes are
// distinguished.
#include "radar/geometry/triangle_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include "tests/radar/shapes.hpp"

namespace roomradar::triangle_tree_test {
namespace {

/// Expects every vertex of every triangle in the box of its leaf and of all nodes above, and each triangle
/// once.
void expect_sound(const TriangleTree& tree) {
  std::vector<int> seen(tree.triangle_count(), 0);
  struct Pending {
    std::uint32_t node;
    std::vector<Eigen::AlignedBox3d> boxes;
  };
  std::vector<Pending> pending;
  if (!tree.empty()) pending.push_back({0, {}});
  while (!pending.empty()) {
    const Pending next = pending.back();
    pending.pop_back();
    const TreeNode& node = tree.nodes()[next.node];
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      const Eigen::Vector3d centre =
          tree.centre() + Eigen::Vector3d(node.centre_x[i], node.centre_y[i], node.centre_z[i]);
      const Eigen::Vector3d half(node.half_x[i], node.half_y[i], node.half_z[i]);
      std::vector<Eigen::AlignedBox3d> boxes = next.boxes;
      boxes.emplace_back(centre - half, centre + half);
      if (node.count[i] == 0) {
        pending.push_back({node.first[i], boxes});
        continue;
      }
      for (std::uint32_t t = node.first[i]; t < node.first[i] + node.count[i]; ++t) {
        ++seen[t];
        for (const std::uint32_t v : tree.triangles()[t]) {
          for (const Eigen::AlignedBox3d& box : boxes) {
            ASSERT_TRUE(box.contains(tree.vertices()[v].cast<double>()));
          }
        }
      }
    }
  }
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
}

TEST(TriangleTree, BoxesHoldTheirTrianglesInBothOrders) {
  for (const int around : {3, 7, 40, 100}) {
    Mesh mesh = shapes::torus(around, 9, 0.2F, 0.06F, 0.02F);
    for (Eigen::Vector3f& v : mesh.vertices) v += Eigen::Vector3f(100.0F, -3.0F, 7.0F);
    TriangleTree tree;
    tree.build_by_place(mesh);
    EXPECT_EQ(tree.triangle_count(), mesh.triangles.size());
    expect_sound(tree);
    tree.build_in_order(mesh);
    EXPECT_EQ(tree.triangle_count(), mesh.triangles.size());
    EXPECT_TRUE(std::equal(tree.triangles().begin(), tree.triangles().end(), mesh.triangles.begin()));
    expect_sound(tree);
  }
}

TEST(TriangleTree, UnusableTrianglesAreLeftOutAndDegenerateOnesStay) {
  Mesh mesh = shapes::box({1.0F, 1.0F, 1.0F});
  mesh.vertices.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F);
  const auto nan = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  mesh.triangles.push_back({0, 1, nan});
  mesh.triangles.push_back({0, 1, nan + 1});
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({2, 2, 2});
  mesh.triangles.push_back({0, 1, 2});
  for (const bool by_key : {true, false}) {
    TriangleTree tree;
    by_key ? tree.build_by_place(mesh) : tree.build_in_order(mesh);
    EXPECT_EQ(tree.triangle_count(), 15U);
    EXPECT_EQ(tree.dropped_triangles(), 2U);
    expect_sound(tree);
  }
}

TEST(TriangleTree, ThousandsOfTrianglesAtOnePlaceAreStillATree) {
  Mesh mesh;
  mesh.vertices.assign(3, Eigen::Vector3f(1.0F, 2.0F, 3.0F));
  mesh.triangles.assign(5000, {0, 1, 2});
  TriangleTree tree;
  tree.build_by_place(mesh);
  expect_sound(tree);
}

TEST(TriangleTree, NothingIsEmpty) {
  TriangleTree tree;
  EXPECT_TRUE(tree.empty());
  EXPECT_EQ(tree.revision(), 0U);
  tree.build_by_place(Mesh{});
  EXPECT_TRUE(tree.empty());
  EXPECT_TRUE(tree.nodes().empty());
  EXPECT_FALSE(tree.is_closed());
}

TEST(TriangleTree, ClosedMeansEveryEdgeIsSharedAndTheVolumePositive) {
  TriangleTree tree;
  Mesh box = shapes::box({1.0F, 1.0F, 1.0F});  // faces do not share vertices: they are matched by position
  tree.build_by_place(box);
  EXPECT_TRUE(tree.is_closed());
  tree.build_by_place(shapes::torus(20, 10, 0.2F, 0.06F, 0.02F));
  EXPECT_TRUE(tree.is_closed());
  tree.build_by_place(shapes::floor(1.0F, 0.0F));
  EXPECT_FALSE(tree.is_closed());
  Mesh inside_out = box;
  for (Triangle& t : inside_out.triangles) std::swap(t[0], t[1]);
  tree.build_by_place(inside_out);
  EXPECT_FALSE(tree.is_closed());
  Mesh with_a_point = box;
  with_a_point.vertices.emplace_back(3.0F, 0.0F, 0.0F);
  const auto point = static_cast<std::uint32_t>(with_a_point.vertices.size() - 1);
  with_a_point.triangles.push_back({point, point, point});
  tree.build_by_place(with_a_point);
  EXPECT_TRUE(tree.is_closed());
  with_a_point.triangles = {{point, point, point}};
  tree.build_by_place(with_a_point);
  EXPECT_FALSE(tree.is_closed());
  for (std::size_t i = 0; i < box.triangles.size(); ++i) {
    Mesh open = box, turned = box, twice = box;
    open.triangles.erase(open.triangles.begin() + static_cast<std::ptrdiff_t>(i));
    std::swap(turned.triangles[i][0], turned.triangles[i][1]);
    twice.triangles.push_back(box.triangles[i]);
    for (const Mesh& mesh : {open, turned, twice}) {
      tree.build_by_place(mesh);
      EXPECT_FALSE(tree.is_closed()) << i;
    }
  }
}

TEST(TriangleTree, ZeroAndMinusZeroAreOnePosition) {
  Mesh box = shapes::box({1.0F, 1.0F, 1.0F});
  std::size_t negated = 0;
  for (std::size_t v = 0; v < box.vertices.size(); ++v) {
    box.vertices[v] -= Eigen::Vector3f::Constant(0.5F);  // a corner at zero
    for (float& coordinate : box.vertices[v])
      if (coordinate == 0.0F && v % 2 == 0) coordinate = -0.0F, ++negated;
  }
  ASSERT_GT(negated, 0U);
  TriangleTree tree;
  tree.build_by_place(box);
  EXPECT_TRUE(tree.is_closed());
}

TEST(TriangleTree, APartThatIsInsideOutIsNotHiddenByALargerOne) {
  Mesh inside_out = shapes::box({0.1F, 0.1F, 0.1F});
  for (Triangle& t : inside_out.triangles) std::swap(t[1], t[2]);
  const std::pair<Mesh, Eigen::Vector3f> sound[] = {{shapes::box({1.0F, 1.0F, 1.0F}), {0.0F, 0.0F, 0.0F}},
                                                    {shapes::box({0.1F, 0.1F, 0.1F}), {2.0F, 0.0F, 0.0F}}};
  const std::pair<Mesh, Eigen::Vector3f> unsound[] = {sound[0], {inside_out, {2.0F, 0.0F, 0.0F}}};
  TriangleTree tree;
  tree.build_by_place(shapes::together(sound));
  EXPECT_TRUE(tree.is_closed());
  tree.build_by_place(shapes::together(unsound));
  EXPECT_FALSE(tree.is_closed());
}

TEST(TriangleTree, VerticesAsFarApartAsFloatGoesAreATree) {
  Mesh mesh;
  for (int i = 0; i < 30; ++i) {
    const float far = (i % 2 == 0 ? 1.0F : -1.0F) * std::numeric_limits<float>::max();
    mesh.vertices.insert(mesh.vertices.end(), {{far, 0.0F, 0.0F}, {far, 1.0F, 0.0F}, {far, 0.0F, 1.0F}});
    const auto first = static_cast<std::uint32_t>(3 * i);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  TriangleTree tree;
  tree.build_by_place(mesh);
  EXPECT_EQ(tree.triangle_count(), 30U);
}

/// Indices, in the tree's order, of the triangles under boxes that are marked as within flat faces.
std::set<std::uint32_t> within_faces(const TriangleTree& tree) {
  std::set<std::uint32_t> within;
  for (const TreeNode& node : tree.nodes())
    for (std::uint32_t i = 0; i < node.child_count; ++i)
      if ((node.within_faces >> i & 1U) != 0)
        for (std::uint32_t t = 0; t < node.count[i]; ++t) within.insert(node.first[i] + t);
  return within;
}

TEST(TriangleTree, NoEdgeOfTheShapeIsWithinAFlatFace) {
  const Eigen::Vector3f half(0.15F, 0.1F, 0.05F);
  const Mesh straight = shapes::box_of_cells(2.0F * half, 10);
  std::mt19937 random(3);
  for (int turn = 0; turn < 20; ++turn) {
    Eigen::Matrix3f R = Eigen::Matrix3f::Identity();
    if (turn > 0) R = shapes::random_rotation(random).toRotationMatrix().cast<float>();
    Mesh box = straight;
    for (Eigen::Vector3f& p : box.vertices) p = R * p;
    TriangleTree tree;
    tree.build_by_place(box);
    ASSERT_TRUE(tree.is_closed());
    const std::set<std::uint32_t> within = within_faces(tree);
    EXPECT_GT(within.size(), tree.triangle_count() * 6 / 10) << turn;
    for (const std::uint32_t t : within) {
      for (std::size_t i = 0; i < 3; ++i) {
        const Eigen::Vector3f a = tree.vertices()[tree.triangles()[t][i]],
                              b = tree.vertices()[tree.triangles()[t][(i + 1) % 3]];
        const Eigen::Array3f middle = (R.transpose() * (0.5F * (a + b))).cwiseAbs().array();
        EXPECT_LE(((middle - half.array()).abs() < 1e-5F).count(), 1) << turn;  // on one side of the box only
      }
    }
  }
}

TEST(TriangleTree, ADentIsAShape) {
  Mesh box = shapes::box_of_cells({0.3F, 0.2F, 0.1F}, 10);
  Eigen::Vector3f dent = Eigen::Vector3f::Zero();
  for (const Eigen::Vector3f& p : box.vertices)
    if ((p - Eigen::Vector3f(0.0F, 0.0F, 0.05F)).norm() < 1e-6F) dent = p;
  ASSERT_GT(dent.z(), 0.0F);
  for (const float depth_m : {0.0F, 1e-6F, 1e-3F}) {
    Mesh dented = box;
    for (Eigen::Vector3f& p : dented.vertices)
      if (p == dent) p.z() -= depth_m;
    TriangleTree tree;
    tree.build_by_place(dented);
    ASSERT_TRUE(tree.is_closed());
    int at_dent = 0;
    for (const std::uint32_t t : within_faces(tree))
      for (const std::uint32_t v : tree.triangles()[t]) at_dent += (tree.vertices()[v] - dent).norm() < 2e-3F;
    EXPECT_EQ(at_dent > 0, depth_m == 0.0F) << depth_m;
  }
}

TEST(TriangleTree, WhatIsCurvedOrOpenHasNothingWithinFlatFaces) {
  TriangleTree tree;
  tree.build_by_place(shapes::torus(64, 32, 0.1F, 0.03F, 0.0F));
  EXPECT_TRUE(tree.is_closed());
  EXPECT_TRUE(within_faces(tree).empty());
  Mesh open = shapes::box_of_cells({0.3F, 0.2F, 0.1F}, 10);
  open.triangles.pop_back();
  tree.build_by_place(open);
  EXPECT_TRUE(within_faces(tree).empty());
  tree.build_in_order(shapes::box_of_cells({0.3F, 0.2F, 0.1F}, 10));
  EXPECT_TRUE(within_faces(tree).empty());
}

TEST(TriangleTree, EveryBuildHasARevisionOfItsOwn) {
  std::set<std::uint64_t> revisions;
  TriangleTree a, b;
  const Mesh mesh = shapes::floor(1.0F, 0.0F);
  for (TriangleTree* tree : {&a, &b, &a}) {
    tree->build_in_order(mesh);
    revisions.insert(tree->revision());
  }
  EXPECT_EQ(revisions.size(), 3U);
  EXPECT_EQ(revisions.count(0), 0U);
}

}  // namespace
}  // namespace roomradar::triangle_tree_test
