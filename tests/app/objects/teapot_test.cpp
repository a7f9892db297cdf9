// teapot_test.cpp: the built-in teapot is the published one, complete, facing outwards and upright.
#include "app/objects/teapot.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "mapping/types/system/error.hpp"
#include "tests/support/recordings.hpp"

namespace roomradar::teapot_test {
namespace {

Eigen::AlignedBox3f bounds(const Mesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : mesh.vertices) box.extend(p);
  return box;
}

/// Number of triangles on each edge, per direction.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed_edges(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> count;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++count[{t[i], t[(i + 1) % 3]}];
  }
  return count;
}

/// Connected component of each vertex, by shared triangles.
std::vector<std::uint32_t> components(const Mesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const Triangle& t : mesh.triangles) {
    parent[root(t[0])] = root(t[1]);
    parent[root(t[1])] = root(t[2]);
  }
  for (std::uint32_t v = 0; v < parent.size(); ++v) parent[v] = root(v);
  return parent;
}

TEST(Teapot, StandsOnZeroWithThePublishedProportions) {
  const Eigen::AlignedBox3f box = bounds(utah_teapot(16, 0.315));
  EXPECT_NEAR(box.min().z(), 0.0F, 1e-6F);
  EXPECT_NEAR(box.max().z(), 0.315F, 1e-6F);
  // Body 4.0 wide; handle out to -3.0, spout to 3.434 (the curve stays inside its control points at 3.525).
  EXPECT_NEAR(box.min().y(), -0.2F, 5e-4F);
  EXPECT_NEAR(box.max().y(), 0.2F, 5e-4F);
  EXPECT_NEAR(box.min().x(), -0.3F, 2e-3F);
  EXPECT_NEAR(box.max().x(), 0.3434F, 2e-3F);
}

TEST(Teapot, HasTheTrianglesThatItSays) {
  for (const int n : {2, 5, 10, 32}) {
    const Mesh mesh = utah_teapot(n, 0.2);
    // 32 patches of 2 n^2, minus n for each of the 8 patches that end in a pole. With one segment per patch
    // the knob would be flat.
    EXPECT_EQ(mesh.triangles.size(), static_cast<std::size_t>(64 * n * n - 8 * n)) << n;
    EXPECT_EQ(mesh.normals.size(), mesh.vertices.size());
  }
}

TEST(Teapot, EveryEdgeIsSharedExceptTheOpenRims) {
  const int n = 8;
  const Mesh mesh = utah_teapot(n, 0.2);
  const auto edges = directed_edges(mesh);
  int open = 0;
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1) << "two triangles run the same way along an edge: one of them is inside out";
    if (!edges.contains({edge.second, edge.first})) ++open;
  }
  // Open: the rim's inside and the lid's border (4 n each), both ends of handle and spout (2 n each).
  EXPECT_EQ(open, 4 * n + 4 * n + 4 * 2 * n);
}

TEST(Teapot, NeighbouringPatchesMeet) {
  // If a seam had a gap larger than the welding distance, there would be more components.
  const std::vector<std::uint32_t> parts = components(utah_teapot(6, 0.2));
  EXPECT_EQ(std::set<std::uint32_t>(parts.begin(), parts.end()).size(), 4U)
      << "body with rim and bottom, lid with knob, handle, spout";
}

TEST(Teapot, IsAsSmoothAsPublishedAcrossPatches) {
  // With a fine tessellation, adjacent facets differ little, except at the teapot's creases: the lip of the
  // rim and the spout, the foot, and the pinch of the knob.
  const Mesh mesh = utah_teapot(32, 1.0);
  std::map<std::pair<std::uint32_t, std::uint32_t>, Eigen::Vector3f> facet;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3f n =
        (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    for (std::size_t i = 0; i < 3; ++i) facet[{t[i], t[(i + 1) % 3]}] = n.normalized();
  }
  int sharp = 0, all = 0;
  for (const auto& [edge, n] : facet) {
    const auto other = facet.find({edge.second, edge.first});
    if (other == facet.end()) continue;
    ++all;
    sharp += n.dot(other->second) < 0.7F ? 1 : 0;
  }
  EXPECT_LT(sharp, all / 100);
}

TEST(Teapot, TrianglesAndNormalsPointOutward) {
  const Mesh mesh = utah_teapot(12, 0.315);
  int along = 0, outward = 0, on_body = 0;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3f a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    const Eigen::Vector3f facet = (b - a).cross(c - a).normalized();
    const Eigen::Vector3f smooth = mesh.normals[t[0]] + mesh.normals[t[1]] + mesh.normals[t[2]];
    along += facet.dot(smooth) > 0.0F ? 1 : 0;
    // The body below the rim is star-shaped about its centre.
    const Eigen::Vector3f centre = (a + b + c) / 3.0F;
    if (centre.z() < 0.235F && centre.head<2>().norm() < 0.199F && std::abs(centre.x()) < 0.15F) {
      ++on_body;
      outward += facet.dot(centre - Eigen::Vector3f(0, 0, 0.1F)) > 0.0F ? 1 : 0;
    }
  }
  EXPECT_EQ(along, static_cast<int>(mesh.triangles.size()));
  EXPECT_GT(on_body, 500);
  EXPECT_EQ(outward, on_body);
  for (const Eigen::Vector3f& n : mesh.normals) EXPECT_NEAR(n.norm(), 1.0F, 1e-5F);
}

TEST(Teapot, VolumeByTheDivergenceTheoremIsThatOfEachPart) {
  // Handle and spout are open tubes; closed by the plane of their rims they must have positive volume, since
  // an inside-out part has a negative one. The rims of a part are nearly flat, so the sum about the part's
  // own centre gives the sign.
  const Mesh mesh = utah_teapot(12, 0.315);
  const std::vector<std::uint32_t> parts = components(mesh);
  std::map<std::uint32_t, std::pair<Eigen::Vector3d, int>> centres;
  for (std::size_t v = 0; v < parts.size(); ++v) {
    auto& [sum, count] = centres.try_emplace(parts[v], Eigen::Vector3d::Zero(), 0).first->second;
    sum += mesh.vertices[v].cast<double>();
    ++count;
  }
  std::map<std::uint32_t, double> volume_m3;
  for (const Triangle& t : mesh.triangles) {
    const auto& [sum, count] = centres.at(parts[t[0]]);
    std::array<Eigen::Vector3d, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = mesh.vertices[t[i]].cast<double>() - sum / count;
    volume_m3[parts[t[0]]] += p[0].dot(p[1].cross(p[2])) / 6.0;
  }
  for (const auto& [part, volume] : volume_m3) EXPECT_GT(volume, 0.0) << part;
}

TEST(Teapot, MatchesTheOneThatOthersTessellated) {
  ROOMRADAR_RECORDING_OR_SKIP(folder, "meshes");
  std::ifstream file(folder / "teapot.obj");
  ASSERT_TRUE(file);
  // The file has y up and the published units.
  std::vector<Eigen::Vector3f> theirs;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string kind;
    float x = 0, y = 0, z = 0;
    if (words >> kind >> x >> y >> z && kind == "v") theirs.emplace_back(x, -z, y);
  }
  ASSERT_GT(theirs.size(), 1000U);
  const Mesh mesh = utah_teapot(48, 3.15);
  double worst = 0.0, sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < theirs.size(); i += 7) {
    float nearest2 = std::numeric_limits<float>::infinity();
    for (const Eigen::Vector3f& p : mesh.vertices)
      nearest2 = std::min(nearest2, (p - theirs[i]).squaredNorm());
    const double distance = std::sqrt(nearest2);
    worst = std::max(worst, distance);
    sum += distance;
    ++count;
  }
  // Half a cell of our tessellation is up to 0.05 units on the body.
  EXPECT_LT(worst, 0.06);
  EXPECT_LT(sum / count, 0.02);
}

TEST(Teapot, BadArgumentsAreNamed) {
  EXPECT_THROW(utah_teapot(0, 0.2), Error);
  EXPECT_THROW(utah_teapot(257, 0.2), Error);
  EXPECT_THROW(utah_teapot(8, 0.0), Error);
  EXPECT_THROW(utah_teapot(8, std::numeric_limits<double>::quiet_NaN()), Error);
}

}  // namespace
}  // namespace roomradar::teapot_test
