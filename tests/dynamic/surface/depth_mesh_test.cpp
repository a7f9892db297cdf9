// depth_mesh_test.cpp: triangles through depth pixels: position, orientation, gaps at discontinuities.
#include "dynamic/surface/depth_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "mapping/types/depth_noise.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/dynamic/mesh_raster.hpp"

namespace roomradar::depth_mesh_test {
namespace {

constexpr Intrinsics kKinect{640, 480, 585.0, 585.0, 320.0, 240.0};

DepthImage flat(float depth_m) { return {kKinect.width_px, kKinect.height_px, depth_m}; }
MaskImage everything() { return {kKinect.width_px, kKinect.height_px, 255}; }

template <typename Pixel>
void fill_rectangle(Image<Pixel>& image, int x0, int y0, int x1, int y1, Pixel value) {
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) image.at(x, y) = value;
  }
}

Eigen::Isometry3d somewhere() {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized()));
  T_world_camera.pretranslate(Eigen::Vector3d(100.0, -20.0, 3.0));
  return T_world_camera;
}

Mesh masked(const DepthImage& depth_m, const MaskImage& mask, const DepthMeshConfig& config = {},
            const Eigen::Isometry3d& T_world_camera = Eigen::Isometry3d::Identity()) {
  DepthMeshScratch scratch;
  Mesh mesh;
  const DepthImage masked_m = test::masked_depth(depth_m, mask);
  mesh_whole({masked_m, kKinect, T_world_camera}, SurfacePolicy::kHoles, config, scratch, mesh);
  return mesh;
}

Mesh whole(const DepthImage& depth_m, SurfacePolicy policy, const DepthMeshConfig& config = {}) {
  DepthMeshScratch scratch;
  Mesh mesh;
  mesh_whole({depth_m, kKinect, Eigen::Isometry3d::Identity()}, policy, config, scratch, mesh);
  return mesh;
}

// Checks that hold for every mesh made here.
void expect_sound(const Mesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.vertices.size());
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t i : t) {
      ASSERT_LT(i, mesh.vertices.size());
      used[i] = true;
    }
    const Eigen::Vector3f& p = mesh.vertices[t[0]];
    const Eigen::Vector3f normal = (mesh.vertices[t[1]] - p).cross(mesh.vertices[t[2]] - p);
    ASSERT_LT(normal.dot(p), 0.0F) << "faces away from the camera";
  }
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    ASSERT_TRUE(used[i]) << "vertex " << i << " is in no triangle";
    ASSERT_NEAR(mesh.normals[i].norm(), 1.0F, 1e-5F);
  }
}

double area_m2(const Mesh& mesh) {
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3f& p = mesh.vertices[t[0]];
    area += 0.5 * (mesh.vertices[t[1]] - p).cross(mesh.vertices[t[2]] - p).norm();
  }
  return area;
}

// Least and greatest depth of the vertices, for an unrotated camera at the mesh's origin.
std::pair<float, float> depth_extent(const Mesh& mesh) {
  float nearest = 1e9F, farthest = 0.0F;
  for (const Eigen::Vector3f& p : mesh.vertices) {
    nearest = std::min(nearest, p.z());
    farthest = std::max(farthest, p.z());
  }
  return {nearest, farthest};
}

TEST(DepthMesh, EmptyMaskGivesAnEmptyMesh) {
  const Mesh mesh = masked(flat(1.0F), MaskImage(640, 480, 0));
  EXPECT_TRUE(mesh.vertices.empty());
  EXPECT_TRUE(mesh.triangles.empty());
}

TEST(DepthMesh, UnmeasuredDepthGivesAnEmptyMesh) {
  for (const SurfacePolicy policy : {SurfacePolicy::kHoles, SurfacePolicy::kSkirt, SurfacePolicy::kBorder}) {
    EXPECT_TRUE(whole(flat(0.0F), policy).triangles.empty());
  }
  EXPECT_TRUE(masked(flat(0.0F), everything()).vertices.empty());
}

TEST(DepthMesh, FullMaskAtStrideOneCoversEveryPixelOnce) {
  DepthMeshConfig config;
  config.stride_px = 1;
  const Mesh mesh = masked(flat(1.0F), everything(), config);
  expect_sound(mesh);
  EXPECT_EQ(mesh.vertices.size(), 640U * 480U);
  EXPECT_EQ(mesh.triangles.size(), 2U * 639U * 479U);
  EXPECT_NEAR(area_m2(mesh), 639.0 * 479.0 / (585.0 * 585.0), 1e-3);
}

TEST(DepthMesh, VerticesLieWhereThePixelsBackProjectTo) {
  const Eigen::Isometry3d T_world_camera = somewhere();
  MaskImage mask(640, 480, 0);
  fill_rectangle<std::uint8_t>(mask, 10, 20, 13, 23, 255);
  DepthMeshConfig config;
  config.stride_px = 2;  // pixels (10, 20) to (12, 22)
  const Mesh mesh = masked(flat(2.5F), mask, config, T_world_camera);
  ASSERT_EQ(mesh.vertices.size(), 4U);
  const Eigen::Vector3d expected = T_world_camera * back_project(kKinect, 10, 20, 2.5);
  double nearest_m = 1e9;
  for (const Eigen::Vector3f& p : mesh.vertices) {
    nearest_m = std::min(nearest_m, (mesh.origin + p.cast<double>() - expected).norm());
  }
  EXPECT_LT(nearest_m, 1e-6);  // float at its own origin; the camera is 100 m from the world's
  EXPECT_EQ(mesh.origin, T_world_camera.translation());
  for (const Eigen::Vector3f& normal : mesh.normals) {
    EXPECT_NEAR(normal.dot(-T_world_camera.linear().col(2).cast<float>()), 1.0F, 1e-5F);  // faces the camera
  }
  expect_sound(mesh);
}

TEST(DepthMesh, NothingSpansADepthJump) {
  DepthImage depth_m = flat(2.0F);
  fill_rectangle(depth_m, 200, 100, 301, 301, 1.0F);
  const Mesh mesh = whole(depth_m, SurfacePolicy::kHoles);
  expect_sound(mesh);
  for (const Triangle& t : mesh.triangles) {
    const float first = mesh.vertices[t[0]].z();
    for (const std::uint32_t i : t) ASSERT_EQ(mesh.vertices[i].z(), first);
  }
}

TEST(DepthMesh, OneSurfaceStaysOneInNoiseAndAtGrazingAngles) {
  DepthMeshConfig config;
  config.stride_px = 2;
  for (const float tangent : {0.0F, 1.0F, 4.0F}) {  // up to 76 degrees
    DepthImage depth_m = flat(0.0F);
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    for (int y = 0; y < 480; ++y) {
      for (int x = 0; x < 640; ++x) {
        const float z =
            2.0F / (1.0F - tangent * (static_cast<float>(x) - 640.0F) / 585.0F);  // z = 2 + tangent X
        depth_m.at(x, y) = z + depth_sigma_m(DepthNoise{}, z) * normal(random);
      }
    }
    const Mesh mesh = whole(depth_m, SurfacePolicy::kHoles, config);
    EXPECT_GT(static_cast<double>(mesh.triangles.size()), 0.99 * 2 * 319 * 239) << tangent;
  }
}

TEST(DepthMesh, SkirtJoinsTheSidesOfAJumpAndOfAShadow) {
  DepthImage depth_m = flat(2.0F);
  fill_rectangle(depth_m, 200, 100, 301, 301, 1.0F);
  const Mesh holes = whole(depth_m, SurfacePolicy::kHoles);
  const Mesh skirt = whole(depth_m, SurfacePolicy::kSkirt);
  expect_sound(skirt);
  EXPECT_EQ(skirt.triangles.size(), 2U * 319U * 239U) << "no gap is left";
  EXPECT_LT(holes.triangles.size(), skirt.triangles.size());

  fill_rectangle(depth_m, 301, 100, 331, 301, 0.0F);  // the projector's shadow beside it
  EXPECT_EQ(whole(depth_m, SurfacePolicy::kSkirt).triangles.size(), 2U * 319U * 239U);
  DepthMeshConfig config;
  config.skirt_gap_px = 29;
  EXPECT_LT(whole(depth_m, SurfacePolicy::kSkirt, config).triangles.size(), 2U * 319U * 239U);
}

TEST(DepthMesh, SkirtOverAGapIsStraightInTheWorld) {
  DepthImage depth_m = flat(0.0F);
  fill_rectangle(depth_m, 0, 0, 301, 480, 1.0F);
  fill_rectangle(depth_m, 330, 0, 640, 480, 2.0F);
  DepthMeshConfig config;
  config.stride_px = 1;
  const Mesh mesh = whole(depth_m, SurfacePolicy::kSkirt, config);
  const Eigen::Vector3f a = back_project(kKinect, 300, 0, 1.0).cast<float>();
  const Eigen::Vector3f b = back_project(kKinect, 330, 0, 2.0).cast<float>();
  int between = 0;
  for (const Eigen::Vector3f& p : mesh.vertices) {
    if (p.z() <= 1.0F || p.z() >= 2.0F) continue;
    ++between;
    const float t = (p.z() - a.z()) / (b.z() - a.z());
    EXPECT_NEAR(p.x(), a.x() + t * (b.x() - a.x()), 1e-5F);
  }
  EXPECT_EQ(between, 29 * 480);
}

TEST(DepthMesh, BorderIsASkirtWhoseOutermostVerticesArePushedOutAndNearer) {
  DepthMeshConfig config;
  config.stride_px = 2;
  config.border_push_m = 0.5F;
  const Mesh skirt = whole(flat(2.0F), SurfacePolicy::kSkirt, config);
  const Mesh border = whole(flat(2.0F), SurfacePolicy::kBorder, config);
  ASSERT_EQ(border.vertices.size(), skirt.vertices.size());
  EXPECT_EQ(border.triangles, skirt.triangles);
  const float left = -320.0F / 585.0F * 2.0F, right = 318.0F / 585.0F * 2.0F;
  const float top = -240.0F / 585.0F * 2.0F, bottom = 238.0F / 585.0F * 2.0F;
  int pushed = 0;
  for (std::size_t i = 0; i < skirt.vertices.size(); ++i) {
    const Eigen::Vector3f& p = skirt.vertices[i];
    const float x = p.x() < left + 1e-4F ? -0.5F : p.x() > right - 1e-4F ? 0.5F : 0.0F;
    const float y = p.y() < top + 1e-4F ? -0.5F : p.y() > bottom - 1e-4F ? 0.5F : 0.0F;
    const bool outermost = x != 0.0F || y != 0.0F;
    pushed += outermost;
    EXPECT_TRUE(border.vertices[i].isApprox(p + Eigen::Vector3f(x, y, outermost ? -0.5F : 0.0F), 1e-5F));
  }
  EXPECT_EQ(pushed, 2 * 320 + 2 * 238);
}

TEST(DepthMesh, BorderReachesTheImagesEdgeWhereNothingIsMeasuredAndStaysBeforeTheCamera) {
  DepthImage depth_m = flat(0.4F);
  fill_rectangle(depth_m, 0, 0, 100, 480, 0.0F);
  fill_rectangle(depth_m, 500, 0, 640, 480, 0.0F);
  const Mesh mesh = whole(depth_m, SurfacePolicy::kBorder);
  EXPECT_EQ(mesh.triangles.size(), 2U * 319U * 239U);
  EXPECT_EQ(depth_extent(mesh).first, 0.1F);
  EXPECT_TRUE(whole(flat(0.0F), SurfacePolicy::kBorder).triangles.empty());
}

TEST(DepthMesh, OpenPoliciesAreAlike) {
  DepthImage depth_m = flat(2.0F);
  fill_rectangle(depth_m, 200, 100, 301, 301, 1.0F);
  EXPECT_EQ(whole(depth_m, SurfacePolicy::kHoles).triangles, whole(depth_m, SurfacePolicy::kMap).triangles);
}

TEST(DepthMesh, HoleInTheMiddleOfAHandStaysOpen) {
  DepthImage depth_m = flat(0.7F);
  fill_rectangle(depth_m, 310, 230, 330, 250, 0.0F);
  MaskImage mask(640, 480, 0);
  fill_rectangle<std::uint8_t>(mask, 250, 180, 390, 300, 255);
  const Mesh mesh = masked(depth_m, mask);
  expect_sound(mesh);
  const Mesh closed = masked(flat(0.7F), mask);
  // The hole and its rim, minus the corners.
  EXPECT_NEAR(area_m2(closed) - area_m2(mesh), (22.0 * 22.0 - 8.0) * 0.49 / (585.0 * 585.0), 1e-6);
}

TEST(DepthMesh, WorksAtFortyCentimetresAndAtEightMetres) {
  MaskImage mask(640, 480, 0);
  fill_rectangle<std::uint8_t>(mask, 250, 180, 391, 301, 255);
  for (const float z : {0.4F, 8.0F}) {
    const Mesh mesh = masked(flat(z), mask);
    expect_sound(mesh);
    EXPECT_NEAR(area_m2(mesh), 140.0 * 120.0 * z * z / (585.0 * 585.0), 1e-3 * z * z);
    EXPECT_EQ(depth_extent(mesh), std::make_pair(z, z));
  }
}

TEST(DepthMesh, ObjectThinnerThanTheGridHasNoSurface) {
  MaskImage mask(640, 480, 0);
  fill_rectangle<std::uint8_t>(mask, 300, 100, 301, 300, 255);
  EXPECT_TRUE(masked(flat(1.0F), mask).triangles.empty());
}

TEST(DepthMesh, ReachesTheBorderOfTheImage) {
  MaskImage mask(640, 480, 0);
  fill_rectangle<std::uint8_t>(mask, 620, 0, 640, 480, 255);
  DepthMeshConfig config;
  config.stride_px = 1;
  const Mesh mesh = masked(flat(1.0F), mask, config);
  expect_sound(mesh);
  EXPECT_EQ(mesh.triangles.size(), 2U * 19U * 479U);
}

TEST(DepthMesh, CoarserGridsStayWithinNoiseOfTheSurface) {
  // A ball of 10 cm radius at 0.8 m: the coarse mesh's vertices are on it, its triangles at most a sagitta
  // inside.
  DepthImage depth_m = flat(0.0F);
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 640; ++x) {
      const Eigen::Vector3d ray = back_project(kKinect, x, y, 1.0);
      const Eigen::Vector3d centre(0.0, 0.0, 0.8);
      const double b = ray.dot(centre), c = centre.squaredNorm() - 0.01, a = ray.squaredNorm();
      if (b * b > a * c) depth_m.at(x, y) = static_cast<float>((b - std::sqrt(b * b - a * c)) / a);
    }
  }
  for (const int stride_px : {1, 2, 4}) {
    DepthMeshConfig config;
    config.stride_px = stride_px;
    const Mesh mesh = whole(depth_m, SurfacePolicy::kHoles, config);
    expect_sound(mesh);
    double worst_m = 0.0;
    for (const Triangle& t : mesh.triangles) {
      const Eigen::Vector3f middle = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0F;
      worst_m = std::max(worst_m, std::abs((middle - Eigen::Vector3f(0, 0, 0.8F)).norm() - 0.1));
    }
    EXPECT_LT(worst_m, 0.0015) << stride_px;  // sigma at 0.8 m
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      const Eigen::Vector3f outward = (mesh.vertices[i] - Eigen::Vector3f(0, 0, 0.8F)).normalized();
      if (outward.dot(mesh.vertices[i].normalized()) > -0.5F) continue;  // the rim's triangles are one-sided
      EXPECT_GT(mesh.normals[i].dot(outward), 0.99F);
    }
  }
}

TEST(DepthMesh, NoFrameAfterTheFirstReallocates) {
  DepthMeshScratch scratch;
  Mesh mesh;
  const DepthImage nothing = flat(0.0F), depth_m = flat(1.0F);
  const Eigen::Isometry3d T_world_camera = somewhere();
  mesh_whole({nothing, kKinect, T_world_camera}, SurfacePolicy::kHoles, {}, scratch, mesh);
  const void* before[] = {mesh.vertices.data(), mesh.normals.data(), mesh.triangles.data()};
  mesh_whole({depth_m, kKinect, T_world_camera}, SurfacePolicy::kHoles, {}, scratch, mesh);
  const void* after[] = {mesh.vertices.data(), mesh.normals.data(), mesh.triangles.data()};
  for (std::size_t i = 0; i < std::size(before); ++i) EXPECT_EQ(before[i], after[i]);
  EXPECT_FALSE(mesh.triangles.empty());
}

TEST(DepthMesh, ImpossibleSettingsAreNamed) {
  DepthMeshConfig config;
  EXPECT_NO_THROW(require_valid(config));
  config.stride_px = 0;
  try {
    require_valid(config);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("depth_mesh.stride_px = 0"), std::string::npos) << error.what();
  }
  config = {};
  config.jump_incidence_deg = 90.0F;
  EXPECT_THROW(require_valid(config), Error);
}

}  // namespace
}  // namespace roomradar::depth_mesh_test
