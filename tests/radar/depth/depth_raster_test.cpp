// depth_raster_test.cpp: the CPU rasteriser draws what OpenGL draws, without gaps, and always the same.
#include "radar/depth/depth_raster.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "radar/depth/depth_canvas.hpp"
#include "radar/depth/depth_pass.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar::depth_raster_test {
namespace {

constexpr Intrinsics kCamera{320, 240, 292.5, 292.5, 160.0, 120.0};

/// Hilly ground of triangles between a hundredth of a pixel and some pixels in size, 4 m wide, 1.5 to 3 m
/// away.
Mesh hills(int cells) {
  Mesh mesh;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> aside(-0.4F, 0.4F);
  const float cell_m = 4.0F / static_cast<float>(cells);
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const float x = (static_cast<float>(i) + aside(random)) * cell_m - 2.0F;
      const float y = (static_cast<float>(j) + aside(random)) * cell_m - 2.0F;
      mesh.vertices.push_back({x, y, 2.2F + 0.5F * std::sin(3.0F * x) * std::cos(4.0F * y)});
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (cells + 1) + i); };
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      mesh.triangles.push_back({at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
    }
  }
  return mesh;
}

class DepthRasterTest : public testing::Test {
 protected:
  GlContext context;
  DepthPass with_gl{context, {.renderer = DepthRenderer::kOpenGl}};
  DepthPass by_processor{context, {.renderer = DepthRenderer::kProcessor}};

  DepthImage draw(DepthPass& pass, const GpuMesh& mesh, const Eigen::Isometry3d& T_world_camera) {
    const MeshInstance instance{&mesh, Eigen::Isometry3d::Identity()};
    DepthImage depth_m;
    pass.render({&instance, 1}, kCamera, T_world_camera, depth_m);
    return depth_m;
  }
};

/// Counts pixels at which one image is outside the range of the other's depths at the pixel and its
/// neighbours by more than tolerance_m. An outline or a fold may fall on either side of a pixel's centre.
int pixels_apart(const DepthImage& one_m, const DepthImage& other_m, float tolerance_m) {
  int apart = 0;
  for (int y = 1; y + 1 < one_m.height; ++y) {
    for (int x = 1; x + 1 < one_m.width; ++x) {
      float low_m = 1e9F, high_m = 0.0F;
      for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
          low_m = std::min(low_m, other_m.at(x + i, y + j));
          high_m = std::max(high_m, other_m.at(x + i, y + j));
        }
      }
      apart += one_m.at(x, y) < low_m - tolerance_m || one_m.at(x, y) > high_m + tolerance_m;
    }
  }
  return apart;
}

TEST_F(DepthRasterTest, AgreesWithOpenGlFromFineToCoarseTriangles) {
  // A fold thinner than OpenGL's 1/256 pixel may appear in only one of the images; a GPU also rounds depth in
  // its own way (NVIDIA H100: up to 16 pixels).
  const int most = context.is_software() ? 3 : 30;
  for (const int cells : {20, 150, 500}) {
    GpuMesh mesh(context);
    mesh.upload(hills(cells), MeshUsage::kStatic);
    for (const double turned : {0.0, 0.3, 0.9}) {
      Eigen::Isometry3d T_world_camera(Eigen::AngleAxisd(turned, Eigen::Vector3d(0.6, 0.8, 0.0)));
      const DepthImage gl_m = draw(with_gl, mesh, T_world_camera);
      const DepthImage processor_m = draw(by_processor, mesh, T_world_camera);
      EXPECT_LE(pixels_apart(processor_m, gl_m, 1e-5F), most) << cells << " " << turned;
      EXPECT_LE(pixels_apart(gl_m, processor_m, 1e-5F), most) << cells << " " << turned;
      int same = 0, both = 0;
      for (std::size_t i = 0; i < gl_m.pixels.size(); ++i) {
        both += gl_m.pixels[i] > 0.0F && processor_m.pixels[i] > 0.0F;
        same += gl_m.pixels[i] > 0.0F && std::abs(gl_m.pixels[i] - processor_m.pixels[i]) < 2e-4F;
      }
      EXPECT_GT(both, 10'000) << cells << " " << turned;
      EXPECT_GT(same, 0.995 * both) << cells << " " << turned;
    }
  }
}

TEST_F(DepthRasterTest, NeighboursLeaveNoGap) {
  // The hills fill the whole image; there is nothing behind them.
  for (const int cells : {7, 33, 200, 700}) {
    GpuMesh mesh(context);
    mesh.upload(hills(cells), MeshUsage::kStatic);
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    for (int k = 0; k < 10; ++k) {
      T_world_camera.translation() = Eigen::Vector3d(0.0137 * k, -0.0091 * k, 0.003 * k);
      const DepthImage depth_m = draw(by_processor, mesh, T_world_camera);
      EXPECT_EQ(std::count(depth_m.pixels.begin(), depth_m.pixels.end(), 0.0F), 0) << cells << " " << k;
    }
  }
}

TEST(DepthCanvas, AnEdgeThatIsAlmostLevelLeavesNoGap) {
  // Two triangles that share an edge. The edge is wider than the image and crosses a row at a very flat
  // angle, far from the rows where the triangles begin.
  constexpr int kWidth = 640, kHeight = 480;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> part(0.0F, 1.0F);
  const auto setup = std::make_unique<TriangleSetup>();
  DepthCanvas canvas;
  for (int i = 0; i < 500; ++i) {
    const float rise = std::pow(10.0F, -4.2F + 3.5F * part(random));
    const auto row = 1 + static_cast<int>(470.0F * part(random));
    const float middle = static_cast<float>(row) + 0.9F * rise * (2.0F * part(random) - 1.0F);
    ProjectedVertices vertices;
    vertices.u_px = {-10.0F - 1000.0F * part(random), 650.0F + 1000.0F * part(random), 320.0F, 320.0F};
    vertices.v_px = {middle - rise, middle + rise, -2000.0F, 2480.0F};
    vertices.inverse_depth_per_m = {1.0F, 1.0F, 1.0F, 1.0F};
    const std::vector<PieceTriangle> triangles = {{0, 1, 2}, {0, 1, 3}};
    canvas.clear(kWidth, kHeight);
    draw_triangles(vertices, triangles, false, *setup, canvas);
    ASSERT_EQ(std::count(canvas.row(row), canvas.row(row) + kWidth, 0.0F), 0)
        << i << " " << row << " " << rise;
  }
}

TEST_F(DepthRasterTest, GivesTheSameBitsEachTimeWhateverTheThreadsDo) {
  GpuMesh mesh(context);
  mesh.upload(hills(300), MeshUsage::kStatic);
  const DepthImage first_m = draw(by_processor, mesh, Eigen::Isometry3d::Identity());
  for (int k = 0; k < 30; ++k)
    ASSERT_EQ(draw(by_processor, mesh, Eigen::Isometry3d::Identity()).pixels, first_m.pixels);
}

TEST_F(DepthRasterTest, CutsWhatReachesBehindTheCameraOrFarAside) {
  // A floor 1.2 m below a camera that looks along it, in two triangles and in many; up to 20 km wide.
  for (const float half_m : {3.0F, 200.0F, 1e4F}) {
    GpuMesh mesh(context);
    mesh.upload(shapes::floor(half_m, 0.0F), MeshUsage::kStatic);
    Eigen::Isometry3d T_world_camera(Eigen::AngleAxisd(-M_PI / 2, Eigen::Vector3d::UnitX()));
    T_world_camera.translation().z() = 1.2;
    const DepthImage depth_m = draw(by_processor, mesh, T_world_camera);
    for (int v = 0; v < kCamera.height_px; ++v) {
      const double exact_m = v > kCamera.cy_px ? 1.2 * kCamera.fy_px / (v - kCamera.cy_px) : 0.0;
      const double expected_m = exact_m <= static_cast<double>(half_m) ? exact_m : 0.0;
      // A pixel's row at the floor's far end may go either way. Inverse depth is 10 / m where the floor is
      // cut.
      if (std::abs(exact_m - static_cast<double>(half_m)) < 0.02 * exact_m) continue;
      EXPECT_NEAR(depth_m.at(160, v), expected_m, 1e-5 * exact_m + 4e-6 * exact_m * exact_m)
          << half_m << " " << v;
    }
  }
}

TEST_F(DepthRasterTest, SeesAMeshThatWasReplacedOrIsAnotherAtTheSamePlace) {
  GpuMesh mesh(context);
  for (const float z_m : {2.0F, 3.0F, 1.0F}) {
    mesh.upload(shapes::floor(9.0F, z_m), MeshUsage::kStreamed);
    EXPECT_FLOAT_EQ(draw(by_processor, mesh, Eigen::Isometry3d::Identity()).at(3, 3), z_m);
  }
  for (int k = 0; k < 40; ++k) {  // more meshes than are cached
    GpuMesh other(context);
    other.upload(shapes::floor(9.0F, 1.0F + 0.1F * static_cast<float>(k)), MeshUsage::kStatic);
    EXPECT_FLOAT_EQ(draw(by_processor, other, Eigen::Isometry3d::Identity()).at(9, 9),
                    1.0F + 0.1F * static_cast<float>(k));
  }
}

TEST_F(DepthRasterTest, TheNearestOfManyInstancesWins) {
  GpuMesh wall(context);
  wall.upload(shapes::floor(9.0F, 0.0F), MeshUsage::kStatic);
  std::vector<MeshInstance> scene(20, {&wall, Eigen::Isometry3d::Identity()});
  for (std::size_t i = 0; i < scene.size(); ++i)
    scene[i].T_world_mesh.translation().z() = 2.0 + 0.1 * static_cast<double>((7 * i + 3) % 20);
  DepthImage depth_m;
  by_processor.render(scene, kCamera, Eigen::Isometry3d::Identity(), depth_m);
  EXPECT_FLOAT_EQ(*std::max_element(depth_m.pixels.begin(), depth_m.pixels.end()), 2.0F);
  EXPECT_FLOAT_EQ(*std::min_element(depth_m.pixels.begin(), depth_m.pixels.end()), 2.0F);
}

}  // namespace
}  // namespace roomradar::depth_raster_test
