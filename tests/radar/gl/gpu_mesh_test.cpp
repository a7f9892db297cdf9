// gpu_mesh_test.cpp: invalid meshes are rejected, invalid triangles dropped, and an upload replaces the
// previous mesh.
#include "radar/gl/gpu_mesh.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "mapping/types/system/error.hpp"
#include "radar/depth/depth_pass.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar::gpu_mesh_test {
namespace {

class GpuMeshTest : public testing::Test {
 protected:
  GlContext context;
  GpuMesh gpu{context};
};

TEST_F(GpuMeshTest, StaticMeshWithANanVertexIsRefusedAndTheOldOneStays) {
  gpu.upload(shapes::box({1.0F, 1.0F, 1.0F}), MeshUsage::kStatic);
  Mesh broken = shapes::box({2.0F, 2.0F, 2.0F});
  broken.vertices[3].y() = std::numeric_limits<float>::quiet_NaN();
  try {
    gpu.upload(broken, MeshUsage::kStatic);
    FAIL() << "a NaN vertex was taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("not finite"), std::string::npos);
  }
  EXPECT_EQ(gpu.triangle_count(), 12U);
  EXPECT_NEAR(gpu.bounds().sizes().x(), 1.0, 1e-6);
}

TEST_F(GpuMeshTest, StaticMeshWithAnIndexPastTheEndIsRefused) {
  Mesh broken = shapes::box({2.0F, 2.0F, 2.0F});
  broken.triangles[0][2] = 24;
  EXPECT_THROW(gpu.upload(broken, MeshUsage::kStatic), Error);
}

TEST_F(GpuMeshTest, StreamedMeshDropsUnusableTriangles) {
  Mesh broken = shapes::box({2.0F, 2.0F, 2.0F});
  broken.vertices[3].y() = std::numeric_limits<float>::quiet_NaN();  // in one or two triangles per face
  broken.triangles.push_back({0, 1, 99});
  gpu.upload(broken, MeshUsage::kStreamed);
  EXPECT_EQ(gpu.triangle_count() + gpu.dropped_triangles(), 13U);
  EXPECT_GE(gpu.dropped_triangles(), 2U);
}

TEST_F(GpuMeshTest, NormalsAndColoursMustBeOneAVertex) {
  Mesh mesh = shapes::box({1.0F, 1.0F, 1.0F});
  mesh.normals.assign(3, Eigen::Vector3f::UnitZ());
  EXPECT_THROW(gpu.upload(mesh, MeshUsage::kStreamed), Error);
  mesh.normals.clear();
  mesh.colours.assign(25, Rgb{});
  EXPECT_THROW(gpu.upload(mesh, MeshUsage::kStreamed), Error);
}

TEST_F(GpuMeshTest, BoundsHoldTheOrigin) {
  Mesh mesh = shapes::box({1.0F, 2.0F, 3.0F});
  mesh.origin = {1e6, 0.0, -1e6};
  gpu.upload(mesh, MeshUsage::kStatic);
  EXPECT_EQ(gpu.bounds().min(), Eigen::Vector3d(1e6 - 0.5, -1.0, -1e6 - 1.5));
}

TEST_F(GpuMeshTest, StreamedUploadsReplaceEachOther) {
  constexpr Intrinsics camera{64, 48, 60.0, 60.0, 31.5, 23.5};
  DepthPass pass(context), by_gl(context, {.renderer = DepthRenderer::kOpenGl});
  DepthImage depth_m;
  const MeshInstance instance{&gpu, Eigen::Isometry3d::Identity()};
  // Larger, smaller, empty: always the latest mesh is drawn.
  for (const float z_m : {2.0F, 3.0F, 1.5F, 4.0F}) {
    Mesh mesh = shapes::torus(static_cast<int>(100 * z_m), 20, 1.0F, 0.1F, 0.0F);
    for (Eigen::Vector3f& p : mesh.vertices) p.z() -= 50.0F;  // behind the camera
    shapes::add_quad(mesh, {-9, -9, z_m}, {9, -9, z_m}, {9, 9, z_m}, {-9, 9, z_m});
    gpu.upload(mesh, MeshUsage::kStreamed);
    pass.render({&instance, 1}, camera, Eigen::Isometry3d::Identity(), depth_m);
    EXPECT_NEAR(depth_m.at(32, 24), z_m, 1e-5F);
    by_gl.render({&instance, 1}, camera, Eigen::Isometry3d::Identity(), depth_m);
    EXPECT_NEAR(depth_m.at(32, 24), z_m, 1e-5F);
  }
  gpu.upload({}, MeshUsage::kStreamed);
  for (DepthPass* each : {&pass, &by_gl}) {
    each->render({&instance, 1}, camera, Eigen::Isometry3d::Identity(), depth_m);
    EXPECT_EQ(depth_m.at(32, 24), 0.0F);
  }
  EXPECT_TRUE(gpu.bounds().isEmpty());
}

TEST_F(GpuMeshTest, SharesATreeInsteadOfHoldingACopy) {
  const Mesh torus = shapes::torus(24, 12, 0.1F, 0.03F, 0.0F);
  TriangleTree tree;
  tree.build_by_place(torus);
  GpuMesh mesh(context);
  mesh.upload(torus, MeshUsage::kStatic, tree);
  EXPECT_EQ(mesh.tree(), &tree);
  EXPECT_EQ(mesh.vertices().data(), tree.vertices().data());
  EXPECT_EQ(mesh.triangles().data(), tree.triangles().data());
  EXPECT_EQ(mesh.triangle_count(), torus.triangles.size());
  GpuMesh alone(context);
  alone.upload(torus, MeshUsage::kStatic);
  EXPECT_EQ(alone.tree(), nullptr);
  EXPECT_TRUE(mesh.bounds().isApprox(alone.bounds()));
  EXPECT_NE(mesh.revision(), alone.revision());
  // The runs contain all triangles.
  std::size_t visited = 0;
  mesh.visit_runs([](const Eigen::AlignedBox3d&) { return true; },
                  [&](std::uint32_t first, std::uint32_t count) {
                    visited += first < torus.triangles.size() ? count : 0;
                  });
  EXPECT_EQ(visited, torus.triangles.size());
  Mesh larger = torus;
  larger.triangles.push_back({0, 1, 2});
  EXPECT_THROW(mesh.upload(larger, MeshUsage::kStatic, tree), Error);
  EXPECT_EQ(mesh.tree(), &tree) << "keeps what was there";
}

}  // namespace
}  // namespace roomradar::gpu_mesh_test
