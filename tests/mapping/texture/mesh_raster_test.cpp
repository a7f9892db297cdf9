// mesh_raster_test.cpp: depth and triangle of each pixel, also where a triangle reaches behind the camera.
#include "mapping/texture/mesh_raster.hpp"

#include <gtest/gtest.h>

#include "tests/mapping/texture/texture_scene.hpp"

namespace roomradar::mesh_raster_test {
namespace {

const Intrinsics kCamera{160, 120, 145.0, 145.0, 79.5, 59.5};

TEST(MeshRaster, DepthIsThatOfRays) {
  const Mesh mesh = test::wall_mesh();
  const Eigen::Isometry3d T_world_camera = test::looking_at({0.5, 0.4, 0.3}, {2.0, 0.0, 0.0});
  const Frame exact = test::exact_frame(test::wall_scene(), kCamera, T_world_camera);
  const MeshRaster raster = rasterise(mesh, kCamera, T_world_camera.inverse());
  int seen = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) {
      const double depth_m = double{exact.depth_m.at(x, y)};
      const Eigen::Vector3d p = T_world_camera * back_project(kCamera, x, y, depth_m);
      const bool on_wall = p.tail<2>().cwiseAbs().maxCoeff() < 0.599;
      if (!on_wall && p.tail<2>().cwiseAbs().maxCoeff() < 0.601) continue;
      EXPECT_EQ(raster.depth_m.at(x, y) > 0.0F, on_wall) << x << " " << y;
      EXPECT_EQ(raster.triangle.at(x, y) != kNoTriangle, on_wall);
      if (!on_wall) continue;
      ++seen;
      EXPECT_NEAR(double{raster.depth_m.at(x, y)}, depth_m, 1e-4);
    }
  EXPECT_GT(seen, 3000);
}

TEST(MeshRaster, TheNearerOfTwoSurfacesIsSeenFromEitherSide) {
  Mesh mesh = test::wall_mesh(4.0F, 1);
  for (const float x : {-1.0F, -0.5F}) {  // nearer, and wound the other way round
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Eigen::Vector2f& p : {Eigen::Vector2f(-2, -2), Eigen::Vector2f(2, -2), Eigen::Vector2f(0, 2)})
      mesh.vertices.emplace_back(x, p.x(), p.y());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  const MeshRaster raster = rasterise(mesh, kCamera, test::looking_at({0, 0, 0}, {1, 0, 0}).inverse());
  EXPECT_NEAR(raster.depth_m.at(80, 60), 1.0F, 1e-4F);
  EXPECT_EQ(raster.triangle.at(80, 60), 2U);
}

TEST(MeshRaster, ATriangleThatReachesBehindTheCameraIsClipped) {
  Mesh floor;  // z = 0, far in front and far behind
  floor.vertices = {{-50, -50, 0}, {100, 0, 0}, {-50, 50, 0}};
  floor.triangles = {{0, 1, 2}};
  const Eigen::Isometry3d T_world_camera = test::looking_at({0, 0, 1}, {1, 0, 0.5});
  const MeshRaster raster = rasterise(floor, kCamera, T_world_camera.inverse());
  const Frame exact = test::exact_frame(test::plane(Eigen::Vector3d::UnitZ(), 0.0), kCamera, T_world_camera);
  for (const auto& [x, y] : {std::pair(80, 110), std::pair(20, 100), std::pair(130, 60)})
    EXPECT_NEAR(raster.depth_m.at(x, y), exact.depth_m.at(x, y), 1e-3F * exact.depth_m.at(x, y));
}

TEST(MeshRaster, VerticesThatAreNoNumbersDrawNothing) {
  Mesh mesh = test::wall_mesh(1.0F, 1);
  mesh.vertices[0].y() = std::numeric_limits<float>::quiet_NaN();
  mesh.vertices[3].y() = std::numeric_limits<float>::infinity();
  const MeshRaster raster = rasterise(mesh, kCamera, Eigen::Isometry3d::Identity());
  EXPECT_EQ(raster.depth_m.at(80, 60), 0.0F);
}

}  // namespace
}  // namespace roomradar::mesh_raster_test
