// gl_extremes_test.cpp: the GL radar on surfaces that touch or are flush, on broken and open meshes, on very
// many triangles.
#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <limits>
#include <optional>

#include "radar/batch/gl_radar.hpp"
#include "tests/radar/judged_scene.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar::gl_extremes_test {
namespace {

const Eigen::Vector3d kDown(0, 0, -1);

Eigen::Isometry3d at(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}
// Sizes are sums of powers of two, so that float vertices are exact.
Mesh quarter_box() { return shapes::box({0.25F, 0.25F, 0.25F}); }

/// One object and one mesh in its path.
class GlExtremes : public testing::Test {
 protected:
  Contact ask(const Mesh& object, const Eigen::Isometry3d& T_world_object, const Eigen::Vector3d& direction,
              double distance_m, const Mesh& scene) {
    GpuMesh object_gpu(context), scene_gpu(context);
    object_gpu.upload(object, MeshUsage::kStreamed);  // drops invalid triangles
    scene_gpu.upload(scene, MeshUsage::kStreamed);
    const GpuSceneMesh target{{&scene_gpu, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic};
    return radar.query({&object_gpu, T_world_object}, direction, distance_m, {&target, 1});
  }
  void expect_holds(const Mesh& object, const Eigen::Isometry3d& T_world_object,
                    const Eigen::Vector3d& direction, double distance_m, const Mesh& scene,
                    std::optional<double> truth_m) {
    const Contact got = ask(object, T_world_object, direction, distance_m, scene);
    EXPECT_TRUE(holds(got, truth_m, distance_m))
        << describe(JudgedMesh(object, T_world_object), direction, distance_m, got, truth_m);
  }

  GlContext context;
  GlRadar radar{context, {.resolution_px = 64}};
};

TEST_F(GlExtremes, ATenthOfAMicrometreBeforeOrPastTouchingIsTouching) {
  for (const double gap_m : {1e-7, 0.0, -1e-7}) {
    const Contact got = ask(quarter_box(), at(0.2, 0, 0.125 + gap_m), kDown, 1.0, shapes::floor(1.0F, 0.0F));
    EXPECT_EQ(got.status, ContactStatus::kContact) << gap_m;
    EXPECT_NEAR(got.contact_distance_m, gap_m, 2e-6);  // float over a volume of 1.25 m
    EXPECT_LE(got.lower_m, std::max(gap_m, 0.0) + kBoundRounding_m);
    EXPECT_GE(got.upper_m, gap_m);
  }
}

TEST_F(GlExtremes, FacesParallelAndPerpendicularToTheDirection) {
  const Mesh box = quarter_box();
  expect_holds(box, at(0, 0, 1), kDown, 1.0, box, 0.75);      // face onto face, vertices above vertices
  expect_holds(box, at(0.125, 0, 1), kDown, 1.0, box, 0.75);  // sides flush over half an edge
  // Passing with 1e-7 m between the sides, and touching with 1e-7 m of common outline: less than a pixel, so
  // only the bounds distinguish the two.
  expect_holds(box, at(0.25 + 1e-7, 0.1, 1), kDown, 2.0, box, std::nullopt);
  expect_holds(box, at(0.25 - 1e-7, 0.1, 1), kDown, 2.0, box, 0.75);
  // A sheet without thickness onto the edge of another one that crosses it.
  Mesh sheet;
  shapes::add_quad(sheet, {-0.25F, 0, -0.25F}, {0.25F, 0, -0.25F}, {0.25F, 0, 0.25F}, {-0.25F, 0, 0.25F});
  const Eigen::Isometry3d across =
      at(0.1, 0, 1) * Eigen::Isometry3d(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  expect_holds(sheet, across, kDown, 1.0, sheet, 0.5);
}

TEST_F(GlExtremes, DegenerateDuplicateAndNaNTrianglesChangeNothing) {
  std::mt19937 random(3);
  const Mesh torus = shapes::torus(20, 12, 0.2F, 0.05F, 0.02F), ground = shapes::bumpy_ground(20);
  for (int i = 0; i < 10; ++i) {
    Eigen::Isometry3d T(shapes::random_rotation(random));
    T.pretranslate(Eigen::Vector3d(0, 0, 0.5));
    const Eigen::Vector3d direction = kDown + 0.5 * shapes::random_point(random);
    const Contact clean = ask(torus, T, direction, 1.0, ground);
    const Contact got = ask(shapes::spoilt(torus), T, direction, 1.0, shapes::spoilt(ground));
    EXPECT_EQ(got.status, clean.status);
    EXPECT_NEAR(got.contact_distance_m, clean.contact_distance_m, 1e-6);
    EXPECT_NEAR(got.upper_m, clean.upper_m, 1e-6);
    JudgedScene judged;
    judged.add(ground);
    expect_holds(shapes::spoilt(torus), T, direction, 1.0, shapes::spoilt(ground),
                 judged.contact_distance_m(JudgedMesh(torus, T), direction, 1.0));
  }
}

TEST_F(GlExtremes, AnOpenMeshTouchesWithItsSurfaceAndHoldsNothingInside) {
  Mesh bowl = shapes::ball(0.5F, 24, 36);  // upper half, open at the bottom
  std::erase_if(bowl.triangles, [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(), [&](std::uint32_t i) { return bowl.vertices[i].z() < -1e-6F; });
  });
  const Mesh pebble = shapes::ball(0.125F, 24, 36);
  expect_holds(bowl, at(0, 0, 1), kDown, 2.0, pebble, 1.375);
  expect_holds(bowl, at(0, 0, 0), kDown, 2.0, pebble, 0.375);
  expect_holds(bowl, at(0, 0, 0), -kDown, 2.0, pebble, std::nullopt);
}

TEST_F(GlExtremes, TenMillionTinyTriangles) {
  constexpr int kCells = 2240;
  const Mesh grid = shapes::thorny_grid(kCells);
  ASSERT_GT(grid.triangles.size(), 10'000'000U);
  GpuMesh box_gpu(context), grid_gpu(context);
  box_gpu.upload(quarter_box(), MeshUsage::kStatic);
  grid_gpu.upload(grid, MeshUsage::kStreamed);
  const GpuSceneMesh target{{&grid_gpu, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic};
  const auto ask_at = [&](const Eigen::Isometry3d& T) {
    return radar.query({&box_gpu, T}, kDown, 2.0, {&target, 1});
  };
  const Contact beside = ask_at(at(0.5, 0.4, 1));
  EXPECT_EQ(beside.status, ContactStatus::kContact);
  EXPECT_TRUE(holds(beside, 0.875, 2.0)) << beside.lower_m << " " << beside.upper_m;
  // The thorn is a quarter of a pixel wide: pixels may miss it, but the bounds must not.
  EXPECT_TRUE(holds(ask_at(at(0.01, 0.02, 1)), 0.875 - shapes::kThorn_m, 2.0));
}

}  // namespace
}  // namespace roomradar::gl_extremes_test
