// depth_pass_test.cpp: the rendered depth equals that of rays cast in double precision.
#include "radar/depth/depth_pass.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "mapping/types/system/error.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar::depth_pass_test {
namespace {

constexpr Intrinsics kCamera{160, 120, 146.25, 146.25, 79.6, 60.3};

struct RayHit {
  double depth_m = std::numeric_limits<double>::infinity();
  double slope_m_per_px = 0.0;  // change of depth per pixel, the larger of both axes
  double margin_px = 0.0;       // distance of the pixel from the triangle's outline
};

/// Depth along the ray of image coordinates (u, v) through one triangle, given in the camera frame.
std::optional<RayHit> ray_hit(const Intrinsics& camera, double u_px, double v_px,
                              const std::array<Eigen::Vector3d, 3>& p_camera) {
  const Eigen::Vector3d normal = (p_camera[1] - p_camera[0]).cross(p_camera[2] - p_camera[0]);
  const Eigen::Vector3d ray = back_project(camera, u_px, v_px, 1.0);
  const double facing = normal.dot(ray);
  if (facing == 0.0) return std::nullopt;
  RayHit hit;
  hit.depth_m = normal.dot(p_camera[0]) / facing;
  if (!(hit.depth_m > 0.0)) return std::nullopt;
  // d depth / d u = -depth * (normal.x / fx) / (normal . ray)
  hit.slope_m_per_px = std::abs(hit.depth_m / facing) *
                       std::max(std::abs(normal.x()) / camera.fx_px, std::abs(normal.y()) / camera.fy_px);
  const Eigen::Vector2d p(u_px, v_px);
  double sign = 0.0;
  hit.margin_px = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector2d a = project(camera, p_camera[i]);
    const Eigen::Vector2d b = project(camera, p_camera[(i + 1) % 3]);
    const Eigen::Vector2d edge = b - a;
    const double across = (edge.x() * (p - a).y() - edge.y() * (p - a).x()) / edge.norm();
    if (sign == 0.0) sign = across < 0.0 ? -1.0 : 1.0;
    if (across * sign < 0.0) return std::nullopt;
    hit.margin_px = std::min(hit.margin_px, std::abs(across));
  }
  return hit;
}

/// Random triangles in front of the camera, in the world frame of T_world_camera.
Mesh random_triangles(std::mt19937& random, int count, const Eigen::Isometry3d& T_world_camera) {
  std::uniform_real_distribution<double> depth_m(0.5, 8.0);
  std::uniform_real_distribution<double> u_px(-20.0, 180.0);
  std::uniform_real_distribution<double> v_px(-20.0, 140.0);
  Mesh mesh;
  mesh.origin = T_world_camera.translation();
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d centre = back_project(kCamera, u_px(random), v_px(random), depth_m(random));
    for (int corner = 0; corner < 3; ++corner) {
      Eigen::Vector3d p_camera = centre + 0.6 * shapes::random_point(random);
      p_camera.z() = std::max(p_camera.z(), 0.2);
      mesh.vertices.push_back((T_world_camera.linear() * p_camera).cast<float>());
    }
    const auto first = static_cast<std::uint32_t>(3 * i);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// Renders and compares every pixel; pixels within 1/64 pixel of an outline may or may not be covered.
void expect_rays_agree(DepthPass& pass, GlContext& context, const Mesh& mesh, const Intrinsics& camera,
                       const Eigen::Isometry3d& T_world_camera) {
  GpuMesh gpu(context);
  gpu.upload(mesh, MeshUsage::kStatic);
  const MeshInstance instance{&gpu, Eigen::Isometry3d::Identity()};
  DepthImage depth_m;
  pass.render({&instance, 1}, camera, T_world_camera, depth_m);
  ASSERT_EQ(depth_m.width, camera.width_px);
  ASSERT_EQ(depth_m.height, camera.height_px);

  std::vector<std::array<Eigen::Vector3d, 3>> triangles;
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  for (const Triangle& t : mesh.triangles) {
    std::array<Eigen::Vector3d, 3> p;
    for (int i = 0; i < 3; ++i) p[i] = T_camera_world * (mesh.origin + mesh.vertices[t[i]].cast<double>());
    triangles.push_back(p);
  }
  int covered = 0, wrong = 0;
  double worst_flat_m = 0.0;
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      RayHit nearest;
      bool near_an_outline = false;
      for (const auto& p : triangles) {
        const std::optional<RayHit> hit = ray_hit(camera, x, y, p);
        if (hit && hit->margin_px < 1.0 / 64.0) near_an_outline = true;
        if (hit && hit->depth_m < nearest.depth_m) nearest = *hit;
        for (const double nudge : {-1.0 / 64.0, 1.0 / 64.0}) {
          if (!hit && (ray_hit(camera, x + nudge, y, p) || ray_hit(camera, x, y + nudge, p)))
            near_an_outline = true;
        }
      }
      if (near_an_outline) continue;
      const double got_m = depth_m.at(x, y);
      const double expected_m = std::isfinite(nearest.depth_m) ? nearest.depth_m : 0.0;
      covered += expected_m > 0.0 ? 1 : 0;
      // 0.1 mm is the guaranteed accuracy at 8 m. Vertices snap to 1/256 pixel, which shifts a slope by up to
      // that.
      if (std::abs(got_m - expected_m) > 1e-4 + nearest.slope_m_per_px / 64.0) ++wrong;
      if (nearest.slope_m_per_px < 0.002) worst_flat_m = std::max(worst_flat_m, std::abs(got_m - expected_m));
    }
  }
  EXPECT_GT(covered, camera.width_px * camera.height_px / 4);
  EXPECT_EQ(wrong, 0) << "of " << covered;
  EXPECT_LT(worst_flat_m, 1e-4);
}

class DepthPassTest : public testing::TestWithParam<DepthRenderer> {
 protected:
  GlContext context;
  DepthPass pass{context, {.renderer = GetParam()}};
};

INSTANTIATE_TEST_SUITE_P(EachRenderer, DepthPassTest,
                         testing::Values(DepthRenderer::kOpenGl, DepthRenderer::kProcessor),
                         [](const auto& renderer) {
                           return renderer.param == DepthRenderer::kOpenGl ? "OpenGl" : "Processor";
                         });

TEST_P(DepthPassTest, AgreesWithRaysOnRandomTriangles) {
  std::mt19937 random(1);
  for (int round = 0; round < 3; ++round) {
    Eigen::Isometry3d T_world_camera(shapes::random_rotation(random));
    T_world_camera.pretranslate(3.0 * shapes::random_point(random));
    const Mesh mesh = random_triangles(random, 120, T_world_camera);
    expect_rays_agree(pass, context, mesh, kCamera, T_world_camera);
  }
}

TEST_P(DepthPassTest, FollowsThePrincipalPointThroughSubPixelShifts) {
  std::mt19937 random(2);
  const Mesh mesh = random_triangles(random, 60, Eigen::Isometry3d::Identity());
  for (const double shift_px : {-0.75, -0.5, -0.25, 0.1, 0.37, 0.5}) {
    Intrinsics camera = kCamera;
    camera.cx_px += shift_px;
    camera.cy_px -= 0.5 * shift_px;
    expect_rays_agree(pass, context, mesh, camera, Eigen::Isometry3d::Identity());
  }
}

TEST_P(DepthPassTest, LosesNothingAThousandKilometresFromZero) {
  std::mt19937 random(3);
  Eigen::Isometry3d T_world_camera(shapes::random_rotation(random));
  T_world_camera.pretranslate(Eigen::Vector3d(1e6, -1e6, 1e6));
  const Mesh mesh = random_triangles(random, 60, T_world_camera);
  expect_rays_agree(pass, context, mesh, kCamera, T_world_camera);
}

TEST_P(DepthPassTest, WallAt8MetresIsThereToATenthOfAMillimetre) {
  Mesh wall = shapes::floor(20.0F, 8.0F);
  std::swap(wall.triangles[0][1], wall.triangles[0][2]);
  GpuMesh gpu(context);
  gpu.upload(wall, MeshUsage::kStatic);
  const MeshInstance instance{&gpu, Eigen::Isometry3d::Identity()};
  DepthImage depth_m;
  pass.render({&instance, 1}, kCamera, Eigen::Isometry3d::Identity(), depth_m);
  for (const float z_m : depth_m.pixels)
    EXPECT_NEAR(z_m, 8.0F, 1e-5F);  // a flat wall, so only the depth resolution: 0.5 um
}

TEST_P(DepthPassTest, FirstPixelIsCentredAtZeroZero) {
  // A wall from image coordinates (9.9, 4.9) to (30.1, 20.1): an offset of half a pixel would add or remove a
  // row.
  const Eigen::Vector3f a = back_project(kCamera, 9.9, 4.9, 2.0).cast<float>();
  const Eigen::Vector3f b = back_project(kCamera, 30.1, 20.1, 2.0).cast<float>();
  Mesh mesh;
  shapes::add_quad(mesh, a, {a.x(), b.y(), 2.0F}, b, {b.x(), a.y(), 2.0F});
  GpuMesh gpu(context);
  gpu.upload(mesh, MeshUsage::kStatic);
  const MeshInstance instance{&gpu, Eigen::Isometry3d::Identity()};
  DepthImage depth_m;
  pass.render({&instance, 1}, kCamera, Eigen::Isometry3d::Identity(), depth_m);
  for (int v = 0; v < kCamera.height_px; ++v) {
    for (int u = 0; u < kCamera.width_px; ++u) {
      EXPECT_EQ(depth_m.at(u, v) > 0.0F, u >= 10 && u <= 30 && v >= 5 && v <= 20) << u << " " << v;
    }
  }
}

TEST_P(DepthPassTest, RectangleGivesTheSamePixelsAndLeavesTheRestAlone) {
  std::mt19937 random(4);
  const Mesh mesh = random_triangles(random, 200, Eigen::Isometry3d::Identity());
  GpuMesh gpu(context);
  gpu.upload(mesh, MeshUsage::kStatic);
  const MeshInstance instance{&gpu, Eigen::Isometry3d::Identity()};
  DepthImage whole_m;
  pass.render({&instance, 1}, kCamera, Eigen::Isometry3d::Identity(), whole_m);
  const PixelRect rect{37, 22, 50, 31};
  DepthImage part_m(kCamera.width_px, kCamera.height_px, -7.0F);
  pass.render({&instance, 1}, kCamera, Eigen::Isometry3d::Identity(), rect, part_m);
  int differing = 0;
  for (int v = 0; v < kCamera.height_px; ++v) {
    for (int u = 0; u < kCamera.width_px; ++u) {
      const bool inside = u >= 37 && u < 87 && v >= 22 && v < 53;
      if (!inside) {
        EXPECT_EQ(part_m.at(u, v), -7.0F);
      } else if (std::abs(part_m.at(u, v) - whole_m.at(u, v)) > 1e-4F) {
        ++differing;  // vertices snap to another 1/256 pixel, so an outline may gain or lose a pixel
      }
    }
  }
  EXPECT_LE(differing, 8);
  pass.render({&instance, 1}, kCamera, Eigen::Isometry3d::Identity(), {500, -3, 10, 2},
              part_m);  // wholly outside
  EXPECT_EQ(part_m.at(0, 0), -7.0F);
}

TEST_P(DepthPassTest, BackFacesAreSeenUnlessCulled) {
  const Mesh floor_up = shapes::floor(1.0F, 0.0F);
  GpuMesh gpu(context);
  gpu.upload(floor_up, MeshUsage::kStatic);
  const MeshInstance instance{&gpu, Eigen::Isometry3d::Identity()};
  // The camera above looks down and sees the front; the camera below looks up and sees the back.
  Eigen::Isometry3d T_world_above(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  T_world_above.pretranslate(Eigen::Vector3d(0, 0, 2));
  Eigen::Isometry3d T_world_below = Eigen::Isometry3d::Identity();
  T_world_below.pretranslate(Eigen::Vector3d(0, 0, -2));
  DepthPass culling(context, {.renderer = GetParam(), .cull_back_faces = true});
  DepthImage depth_m;
  pass.render({&instance, 1}, kCamera, T_world_above, depth_m);
  EXPECT_NEAR(depth_m.at(80, 60), 2.0F, 1e-5F);
  pass.render({&instance, 1}, kCamera, T_world_below, depth_m);
  EXPECT_NEAR(depth_m.at(80, 60), 2.0F, 1e-5F);
  culling.render({&instance, 1}, kCamera, T_world_above, depth_m);
  EXPECT_NEAR(depth_m.at(80, 60), 2.0F, 1e-5F);
  culling.render({&instance, 1}, kCamera, T_world_below, depth_m);
  EXPECT_EQ(depth_m.at(80, 60), 0.0F);
}

TEST_P(DepthPassTest, NothingNearerThanTheNearPlaneAndNothingBehind) {
  GpuMesh gpu(context);
  gpu.upload(shapes::floor(5.0F, 0.0F), MeshUsage::kStatic);
  DepthImage depth_m;
  for (const double z_m : {0.05, -1.0}) {
    const MeshInstance instance{&gpu, Eigen::Isometry3d(Eigen::Translation3d(0, 0, z_m))};
    pass.render({&instance, 1}, kCamera, Eigen::Isometry3d::Identity(), depth_m);
    EXPECT_EQ(*std::max_element(depth_m.pixels.begin(), depth_m.pixels.end()), 0.0F) << z_m;
  }
}

TEST_P(DepthPassTest, EmptySceneIsAllZero) {
  DepthImage depth_m(kCamera.width_px, kCamera.height_px, 5.0F);
  pass.render({}, kCamera, Eigen::Isometry3d::Identity(), depth_m);
  EXPECT_EQ(*std::max_element(depth_m.pixels.begin(), depth_m.pixels.end()), 0.0F);
}

TEST_P(DepthPassTest, UnusableCameraGivesAnEmptyImage) {
  DepthImage depth_m(3, 3, 5.0F);
  Intrinsics camera = kCamera;
  camera.fx_px = std::numeric_limits<double>::quiet_NaN();
  pass.render({}, camera, Eigen::Isometry3d::Identity(), depth_m);
  EXPECT_TRUE(depth_m.empty());
}

TEST_P(DepthPassTest, ChunksOutOfSightAreNotDrawn) {
  // A ring of ground around the camera, of which about an eighth is in view.
  GpuMesh gpu(context);
  gpu.upload(shapes::torus(600, 60, 4.0F, 0.5F, 0.0F), MeshUsage::kStatic);
  const MeshInstance instance{&gpu, Eigen::Isometry3d::Identity()};
  Eigen::Isometry3d T_world_camera(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitY()));
  DepthImage depth_m;
  const std::size_t drawn = pass.render({&instance, 1}, kCamera, T_world_camera, depth_m);
  EXPECT_GT(drawn, 0U);
  EXPECT_LT(drawn, gpu.triangle_count() / 3);
}

TEST_P(DepthPassTest, PixelsOfAnInstanceHoldAllItsDepths) {
  std::mt19937 random(6);
  GpuMesh gpu(context);
  gpu.upload(shapes::box({0.3F, 0.2F, 0.4F}), MeshUsage::kStatic);
  for (int round = 0; round < 50; ++round) {
    Eigen::Isometry3d T_world_mesh(shapes::random_rotation(random));
    T_world_mesh.pretranslate(Eigen::Vector3d(0, 0, 1.5) + shapes::random_point(random));
    const MeshInstance instance{&gpu, T_world_mesh};
    DepthImage depth_m;
    pass.render({&instance, 1}, kCamera, Eigen::Isometry3d::Identity(), depth_m);
    const PixelRect rect = pixels_of(instance, kCamera, Eigen::Isometry3d::Identity(), 0.1);
    for (int v = 0; v < depth_m.height; ++v) {
      for (int u = 0; u < depth_m.width; ++u) {
        const bool inside = u >= rect.x && u < rect.x + rect.width && v >= rect.y && v < rect.y + rect.height;
        EXPECT_TRUE(inside || depth_m.at(u, v) == 0.0F) << round << ": " << u << " " << v;
      }
    }
  }
  const MeshInstance behind{&gpu, Eigen::Isometry3d(Eigen::Translation3d(0, 0, -2))};
  EXPECT_EQ(pixels_of(behind, kCamera, Eigen::Isometry3d::Identity(), 0.1).width, 0);
  const MeshInstance around{&gpu, Eigen::Isometry3d::Identity()};
  EXPECT_EQ(pixels_of(around, kCamera, Eigen::Isometry3d::Identity(), 0.1), (PixelRect{0, 0, 160, 120}));
}

TEST_P(DepthPassTest, NearPlaneMustBePositive) { EXPECT_THROW(DepthPass(context, {.near_m = 0.0}), Error); }

}  // namespace
}  // namespace roomradar::depth_pass_test
