// gl_radar_test.cpp: known contacts, limits of the parameters, and cases that must not count as contact.
#include "radar/batch/gl_radar.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "mapping/types/system/error.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar::gl_radar_test {
namespace {

const Eigen::Vector3d kDown(0, 0, -1);

Eigen::Isometry3d at(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

Mesh sphere(float radius_m) {
  Mesh mesh;
  constexpr int kRows = 48, kColumns = 96;
  for (int i = 0; i <= kRows; ++i) {
    for (int j = 0; j < kColumns; ++j) {
      const double a = M_PI * i / kRows, b = 2 * M_PI * j / kColumns;
      mesh.vertices.push_back(
          (radius_m * Eigen::Vector3d(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), -std::cos(a)))
              .cast<float>());
    }
  }
  const auto index = [](int i, int j) { return static_cast<std::uint32_t>(i * kColumns + j % kColumns); };
  for (int i = 0; i < kRows; ++i) {
    for (int j = 0; j < kColumns; ++j) {
      mesh.triangles.push_back({index(i, j), index(i, j + 1), index(i + 1, j + 1)});
      mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i + 1, j)});
    }
  }
  return mesh;
}

class GlRadarTest : public testing::Test {
 protected:
  const GpuMesh* uploaded(const Mesh& mesh, MeshUsage usage = MeshUsage::kStatic) {
    meshes.push_back(std::make_unique<GpuMesh>(context));
    meshes.back()->upload(mesh, usage);
    return meshes.back().get();
  }
  GpuSceneMesh scene_mesh(const Mesh& mesh,
                          const Eigen::Isometry3d& T_world_mesh = Eigen::Isometry3d::Identity(),
                          SurfaceKind kind = SurfaceKind::kStatic) {
    return {{uploaded(mesh), T_world_mesh}, kind};
  }

  GlContext context;
  GlRadar radar{context};
  std::vector<std::unique_ptr<GpuMesh>> meshes;
  const GpuMesh* cube = uploaded(shapes::box({0.2F, 0.2F, 0.2F}));
};

TEST_F(GlRadarTest, BallAboveFloorTravelsItsClearance) {
  const GpuSceneMesh floor = scene_mesh(shapes::floor(2.0F, 0.0F));
  const Contact contact = radar.query({uploaded(sphere(0.3F)), at(0.1, 0.2, 1.0)}, kDown, 2.0, {&floor, 1});
  ASSERT_EQ(contact.status, ContactStatus::kContact);
  // The sample nearest to the pole is up to 0.71 pixels away, on facets with a slope of 1 in 30: at most 0.11
  // mm late.
  EXPECT_GE(contact.contact_distance_m, 0.7 - 1e-5);
  EXPECT_LE(contact.contact_distance_m, 0.7 + 0.71 * contact.pixel_m / 30.0);
  EXPECT_NEAR((contact.point_world - Eigen::Vector3d(0.1, 0.2, 0.0)).norm(), 0.0, 1.5 * contact.pixel_m);
  EXPECT_NEAR(contact.point_world.z(), 0.0, 1e-6);
  EXPECT_NEAR((contact.normal_world - Eigen::Vector3d::UnitZ()).norm(), 0.0, 1e-6);
  EXPECT_EQ(contact.touched, SurfaceKind::kStatic);
  EXPECT_NEAR(contact.pixel_m, 0.6 / 128, 1e-6);
}

TEST_F(GlRadarTest, FlatLandingIsReportedInTheMiddle) {
  const GpuSceneMesh floor = scene_mesh(shapes::floor(2.0F, 0.0F));
  const Contact contact = radar.query({cube, at(0.5, -0.5, 0.4)}, kDown, 2.0, {&floor, 1});
  ASSERT_EQ(contact.status, ContactStatus::kContact);
  EXPECT_NEAR(contact.contact_distance_m, 0.3, 1e-6);
  EXPECT_NEAR((contact.point_world - Eigen::Vector3d(0.5, -0.5, 0.0)).norm(), 0.0, contact.pixel_m);
}

TEST_F(GlRadarTest, NothingInTheWayIsNoTarget) {
  const GpuSceneMesh floor = scene_mesh(shapes::floor(2.0F, 0.0F));
  EXPECT_EQ(radar.query({cube, at(0, 0, 1)}, -kDown, 5.0, {&floor, 1}).status, ContactStatus::kNoTarget);
  EXPECT_EQ(radar.query({cube, at(0, 0, 1)}, kDown, 0.5, {&floor, 1}).status, ContactStatus::kNoTarget);
  EXPECT_EQ(radar.query({cube, at(9, 0, 1)}, kDown, 5.0, {&floor, 1}).status, ContactStatus::kNoTarget);
  EXPECT_EQ(radar.query({cube, at(0, 0, 1)}, kDown, 5.0, {}).status, ContactStatus::kNoTarget);
  const GpuSceneMesh empty = scene_mesh({});
  EXPECT_EQ(radar.query({cube, at(0, 0, 1)}, kDown, 5.0, {&empty, 1}).status, ContactStatus::kNoTarget);
  const GpuSceneMesh null;
  EXPECT_EQ(radar.query({cube, at(0, 0, 1)}, kDown, 5.0, {&null, 1}).status, ContactStatus::kNoTarget);
}

TEST_F(GlRadarTest, TouchingIsContactAtZero) {
  const GpuSceneMesh floor = scene_mesh(shapes::floor(2.0F, 0.0F));
  const Contact contact = radar.query({cube, at(0, 0, 0.1)}, kDown, 0.5, {&floor, 1});
  EXPECT_EQ(contact.status, ContactStatus::kContact);
  EXPECT_NEAR(contact.contact_distance_m, 0.0, 1e-6);
}

TEST_F(GlRadarTest, TouchingObjectMayLeaveAndSlide) {
  const GpuSceneMesh floor = scene_mesh(shapes::floor(2.0F, 0.0F));
  EXPECT_EQ(radar.query({cube, at(0, 0, 0.1)}, -kDown, 0.5, {&floor, 1}).status, ContactStatus::kNoTarget);
  EXPECT_EQ(radar.query({cube, at(0, 0, 0.1)}, {1, 0, 0}, 0.5, {&floor, 1}).status, ContactStatus::kNoTarget);
}

TEST_F(GlRadarTest, OverlapIsReportedWithItsDepth) {
  const GpuSceneMesh floor = scene_mesh(shapes::floor(2.0F, 0.0F));
  for (const double depth_m : {0.001, 0.01, 0.02}) {
    const Contact contact = radar.query({cube, at(0, 0, 0.1 - depth_m)}, kDown, 0.5, {&floor, 1});
    EXPECT_EQ(contact.status, ContactStatus::kOverlap);
    EXPECT_NEAR(contact.contact_distance_m, -depth_m, 1e-6);
    EXPECT_NEAR(contact.normal_world.z(), 1.0, 1e-6);
  }
}

TEST_F(GlRadarTest,
       OverlappingPlateLiftsFreely) {  // the surface faces along the motion, so the object leaves it
  const GpuMesh* plate = uploaded(shapes::box({0.3F, 0.3F, 0.01F}));
  const GpuSceneMesh table = scene_mesh(shapes::floor(2.0F, 0.0F));
  EXPECT_EQ(radar.query({plate, at(0, 0, 0.003)}, -kDown, 0.5, {&table, 1}).status, ContactStatus::kNoTarget);
}

TEST_F(GlRadarTest, SurfaceFarInsideDoesNotHideWhatIsAhead) {
  // A shelf that cuts through the cube 10 cm behind its front, and the floor ahead.
  const GpuSceneMesh scene[] = {scene_mesh(shapes::floor(2.0F, 0.5F)), scene_mesh(shapes::floor(2.0F, 0.0F))};
  const Contact contact = radar.query({cube, at(0, 0, 0.5)}, kDown, 1.0, scene);
  EXPECT_EQ(contact.status, ContactStatus::kContact);
  EXPECT_NEAR(contact.contact_distance_m, 0.4, 1e-6);
}

TEST_F(GlRadarTest,
       SurfaceSeenFromBehindStopsTheObject) {  // a hand's mesh faces the camera, not the object
  Mesh ceiling_seen_from_above = shapes::floor(2.0F, 1.0F);
  const GpuSceneMesh scene =
      scene_mesh(ceiling_seen_from_above, Eigen::Isometry3d::Identity(), SurfaceKind::kDynamic);
  const Contact contact = radar.query({cube, at(0, 0, 0.5)}, -kDown, 1.0, {&scene, 1});
  ASSERT_EQ(contact.status, ContactStatus::kContact);
  EXPECT_NEAR(contact.contact_distance_m, 0.4, 1e-6);
  EXPECT_NEAR(contact.normal_world.z(), -1.0, 1e-6) << "turned to face the object";
  EXPECT_EQ(contact.touched, SurfaceKind::kDynamic);
}

TEST_F(GlRadarTest, SceneInAHollowIsNotAnOverlap) {
  // An upright ring (its axis along y) with a thin shelf through its hole, just above the lower arc.
  const Mesh ring = shapes::torus(96, 32, 0.1F, 0.02F, 0.0F);
  Eigen::Isometry3d T_world_ring(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitX()));
  T_world_ring.pretranslate(Eigen::Vector3d(0, 0, 0.5));
  // The lower arc spans z 0.38 to 0.42 at x = 0; the shelf is at 0.43: 1 cm above the arc, 5 cm behind the
  // front.
  GlRadar deep(context, {.resolution_px = 128, .overlap_tolerance_m = 0.06});
  Mesh shelf;
  shapes::add_quad(shelf, {-0.02F, -1, 0.43F}, {0.02F, -1, 0.43F}, {0.02F, 1, 0.43F}, {-0.02F, 1, 0.43F});
  const GpuSceneMesh scene[] = {scene_mesh(shelf), scene_mesh(shapes::floor(2.0F, 0.0F))};
  const Contact contact = deep.query({uploaded(ring), T_world_ring}, kDown, 1.0, scene);
  EXPECT_EQ(contact.status, ContactStatus::kContact);
  EXPECT_NEAR(contact.contact_distance_m, 0.38, 2e-4);  // pixels of 1.9 mm on facets with a slope of 1 in 10
  // The same shelf inside the lower arc's tube is an overlap.
  const GpuSceneMesh inside[] = {scene_mesh(shelf, at(0, 0, -0.03)), scene[1]};
  const Contact overlap = deep.query({uploaded(ring), T_world_ring}, kDown, 1.0, inside);
  EXPECT_EQ(overlap.status, ContactStatus::kOverlap);
  EXPECT_NEAR(overlap.contact_distance_m, -0.02, 1e-3);
}

TEST_F(GlRadarTest, PixelOutsideTheMaskSaysNothing) {
  // A pillar beside the ball, inside the square around its outline, ends higher than the floor: the ball
  // misses the pillar.
  const Mesh ball = sphere(0.1F);
  Mesh pillar = shapes::box({0.02F, 0.02F, 1.0F});
  const GpuSceneMesh scene[] = {scene_mesh(pillar, at(0.095, 0.095, -0.2)),
                                scene_mesh(shapes::floor(2.0F, 0.0F))};
  const Contact contact = radar.query({uploaded(ball), at(0, 0, 0.6)}, kDown, 1.0, scene);
  ASSERT_EQ(contact.status, ContactStatus::kContact);
  EXPECT_NEAR(contact.contact_distance_m, 0.5, 1e-4);
}

TEST_F(GlRadarTest, SurfaceEdgeOnIsNotInTheWayButItsRimIs) {
  // A vertical wall, perpendicular to the object's lower face: the cube comes down on its upper rim.
  Mesh wall;
  shapes::add_quad(wall, {0, -1, -1}, {0, 1, -1}, {0, 1, 0}, {0, -1, 0});
  const GpuSceneMesh sheet = scene_mesh(wall);
  // A sheet without thickness has no pixel from above, so the sampled radar misses it.
  EXPECT_EQ(radar.query({cube, at(0, 0, 0.5)}, kDown, 1.0, {&sheet, 1}).status, ContactStatus::kNoTarget);
  // A slab two pixels thick is found.
  const GpuSceneMesh slab = scene_mesh(shapes::box({0.004F, 2.0F, 1.0F}), at(0, 0, -0.5));
  const Contact contact = radar.query({cube, at(0, 0, 0.5)}, kDown, 1.0, {&slab, 1});
  ASSERT_EQ(contact.status, ContactStatus::kContact);
  EXPECT_NEAR(contact.contact_distance_m, 0.4, 1e-6);
  // Along the wall nothing blocks the cube.
  EXPECT_EQ(radar.query({cube, at(0.11, 0, -0.5)}, {0, 1, 0}, 0.5, {&slab, 1}).status,
            ContactStatus::kNoTarget);
}

TEST_F(GlRadarTest, DistancesFromATenthOfAMillimetreTo100Metres) {
  const GpuSceneMesh floor = scene_mesh(shapes::floor(2.0F, 0.0F));
  const Contact near = radar.query({cube, at(0, 0, 0.10005)}, kDown, 1e-4, {&floor, 1});
  ASSERT_EQ(near.status, ContactStatus::kContact);
  EXPECT_NEAR(near.contact_distance_m, 5e-5, 1e-6);
  EXPECT_EQ(radar.query({cube, at(0, 0, 0.1003)}, kDown, 1e-4, {&floor, 1}).status, ContactStatus::kNoTarget);
  const Contact far = radar.query({cube, at(0, 0, 90.1)}, kDown, 100.0, {&floor, 1});
  ASSERT_EQ(far.status, ContactStatus::kContact);
  EXPECT_NEAR(far.contact_distance_m, 90.0, 1e-4);  // depth resolution 6 um
}

TEST_F(GlRadarTest, LosesNothingAThousandKilometresFromZero) {
  for (const Eigen::Vector3d& place : {Eigen::Vector3d(1e6, 1e6, 1e6), Eigen::Vector3d(-1e6, 1e6, -1e6)}) {
    Mesh floor = shapes::floor(2.0F, 0.0F);
    floor.origin = place;
    const GpuSceneMesh scene = scene_mesh(floor);
    Eigen::Isometry3d T_world_cube = at(0.3, 0.2, 0.8);
    T_world_cube.pretranslate(place);
    const Contact contact = radar.query({cube, T_world_cube}, kDown, 2.0, {&scene, 1});
    ASSERT_EQ(contact.status, ContactStatus::kContact);
    EXPECT_NEAR(contact.contact_distance_m, 0.7, 1e-6);
    EXPECT_NEAR((contact.point_world - place - Eigen::Vector3d(0.3, 0.2, 0.0)).norm(), 0.0, contact.pixel_m);
    EXPECT_NEAR(contact.normal_world.z(), 1.0, 1e-6);
  }
}

TEST_F(GlRadarTest, EveryAxisAndAHairOffIt) {
  const Mesh wall = shapes::floor(2.0F, 0.0F);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      for (const double hair : {0.0, 1e-15, 1e-9, 1e-4}) {
        Eigen::Vector3d direction = Eigen::Vector3d::Constant(hair);
        direction[axis] = sign;
        const Eigen::Vector3d towards = sign * Eigen::Vector3d::Unit(axis);
        // A wall 0.5 m ahead of the cube's centre that faces it.
        Eigen::Isometry3d T_world_wall(
            Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), -towards));
        T_world_wall.pretranslate(0.5 * towards);
        const GpuSceneMesh scene = scene_mesh(wall, T_world_wall);
        const Contact contact = radar.query({cube, at(0, 0, 0)}, direction, 1.0, {&scene, 1});
        ASSERT_EQ(contact.status, ContactStatus::kContact) << direction.transpose();
        EXPECT_NEAR(contact.contact_distance_m, 0.4, 1e-6 + hair) << direction.transpose();
        EXPECT_NEAR(contact.normal_world.dot(towards), -1.0, 1e-6) << direction.transpose();
      }
    }
  }
}

TEST_F(GlRadarTest, NanTrianglesInAStreamedSceneAreLeftOut) {
  Mesh scene_cpu = shapes::floor(2.0F, 0.0F);
  scene_cpu.vertices.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.5F);
  scene_cpu.triangles.push_back({0, 1, 4});
  scene_cpu.triangles.push_back({0, 1, 77});
  const GpuSceneMesh scene{{uploaded(scene_cpu, MeshUsage::kStreamed)}, SurfaceKind::kDynamic};
  const Contact contact = radar.query({cube, at(0, 0, 0.8)}, kDown, 2.0, {&scene, 1});
  ASSERT_EQ(contact.status, ContactStatus::kContact);
  EXPECT_NEAR(contact.contact_distance_m, 0.7, 1e-6);
}

TEST_F(GlRadarTest, OneTriangleLargerThanTheVolume) {
  Mesh huge;
  huge.vertices = {{-1000, -900, 0}, {1100, -1000, 0}, {0, 1300, 0}};
  huge.triangles = {{0, 1, 2}};
  const GpuSceneMesh scene = scene_mesh(huge);
  const Contact contact = radar.query({cube, at(3.3, 1.7, 0.8)}, kDown, 2.0, {&scene, 1});
  ASSERT_EQ(contact.status, ContactStatus::kContact);
  EXPECT_NEAR(contact.contact_distance_m, 0.7, 5e-6);
}

TEST_F(GlRadarTest, InvalidInputIsSaid) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const GpuSceneMesh floor = scene_mesh(shapes::floor(2.0F, 0.0F));
  const auto status = [&](const MeshInstance& object, const Eigen::Vector3d& direction, double distance_m) {
    return radar.query(object, direction, distance_m, {&floor, 1}).status;
  };
  const MeshInstance object{cube, at(0, 0, 1)};
  EXPECT_EQ(status(object, {0, 0, 0}, 1.0), ContactStatus::kInvalidInput);
  EXPECT_EQ(status(object, {0, kNan, 1}, 1.0), ContactStatus::kInvalidInput);
  EXPECT_EQ(status(object, {0, kInfinity, 1}, 1.0), ContactStatus::kInvalidInput);
  for (const double distance_m : {0.0, -1.0, kNan, kInfinity, 1e30}) {
    EXPECT_EQ(status(object, kDown, distance_m), ContactStatus::kInvalidInput) << distance_m;
  }
  EXPECT_EQ(status({nullptr, at(0, 0, 1)}, kDown, 1.0), ContactStatus::kInvalidInput);
  EXPECT_EQ(status({uploaded({}), at(0, 0, 1)}, kDown, 1.0), ContactStatus::kInvalidInput);
  EXPECT_EQ(status({cube, at(0, kNan, 1)}, kDown, 1.0), ContactStatus::kInvalidInput);
  EXPECT_TRUE(radar.pictures().range_m.empty());
  EXPECT_EQ(status(object, {0, 0, -1e-200}, 1.0), ContactStatus::kContact) << "any length but 0";
}

TEST_F(GlRadarTest, NearestOfSeveralMeshesIsTouched) {
  const GpuSceneMesh scene[] = {
      scene_mesh(shapes::floor(2.0F, 0.0F)),
      scene_mesh(shapes::box({0.1F, 0.1F, 0.1F}), at(0, 0, 0.05), SurfaceKind::kObject),
      scene_mesh(shapes::floor(2.0F, -0.5F), at(0, 0, 0), SurfaceKind::kDynamic)};
  const Contact contact = radar.query({cube, at(0, 0, 0.8)}, kDown, 2.0, scene);
  ASSERT_EQ(contact.status, ContactStatus::kContact);
  EXPECT_NEAR(contact.contact_distance_m, 0.6, 1e-6);
  EXPECT_EQ(contact.touched, SurfaceKind::kObject);
}

TEST_F(GlRadarTest, ImagesObeyTheirDefinition) {
  const GpuSceneMesh scene[] = {scene_mesh(shapes::torus(80, 40, 0.15F, 0.05F, 0.01F), at(0, 0, 0.1)),
                                scene_mesh(shapes::floor(0.05F, 0.0F))};
  const Contact contact = radar.query({uploaded(sphere(0.2F)), at(0.03, 0, 0.8)}, kDown, 1.0, scene);
  ASSERT_EQ(contact.status, ContactStatus::kContact);
  const RadarPictures pictures = radar.pictures();
  const auto d = static_cast<float>(pictures.volume.depth_m);
  float least_m = d;
  int undefined = 0;
  for (std::size_t i = 0; i < pictures.lookat_m.pixels.size(); ++i) {
    const float r = pictures.range_m.pixels[i], m = pictures.mask_m.pixels[i],
                l = pictures.lookat_m.pixels[i];
    EXPECT_EQ(std::isnan(l), !(m < d && r < d));
    if (std::isnan(l)) {
      ++undefined;
      continue;
    }
    EXPECT_NEAR(l, r + m - d, 1e-6F);
    least_m = std::min(least_m, l);
  }
  EXPECT_GT(undefined, 0);
  EXPECT_NEAR(contact.contact_distance_m, least_m, 1e-7);
}

TEST_F(GlRadarTest, ResolutionsFrom1To4096) {
  const GpuSceneMesh floor = scene_mesh(shapes::floor(2.0F, 0.0F));
  for (const int resolution_px : {1, 2, 3, 17, 512, 4096}) {
    GlRadar other(context, {.resolution_px = resolution_px});
    const Contact contact = other.query({cube, at(0, 0, 0.8)}, kDown, 2.0, {&floor, 1});
    ASSERT_EQ(contact.status, ContactStatus::kContact) << resolution_px;
    EXPECT_NEAR(contact.contact_distance_m, 0.7, 1e-6) << resolution_px;
    EXPECT_NEAR(contact.pixel_m, 0.2 / resolution_px, 1e-6);
  }
  EXPECT_THROW(GlRadar(context, {.resolution_px = 0}), Error);
  EXPECT_THROW(GlRadar(context, {.resolution_px = 4097}), Error);
  EXPECT_THROW(GlRadar(context, {.overlap_tolerance_m = -0.1}), Error);
}

TEST_F(GlRadarTest, LongObjectGetsSquarePixels) {
  const GpuMesh* rod = uploaded(shapes::box({1.0F, 0.05F, 0.05F}));
  const GpuSceneMesh floor = scene_mesh(shapes::floor(2.0F, 0.0F));
  ASSERT_EQ(radar.query({rod, at(0, 0, 0.5)}, kDown, 1.0, {&floor, 1}).status, ContactStatus::kContact);
  EXPECT_EQ(std::max(radar.pictures().volume.width_px, radar.pictures().volume.height_px), 128);
  EXPECT_EQ(std::min(radar.pictures().volume.width_px, radar.pictures().volume.height_px),
            7);  // 0.05 / (1 / 128), rounded up
}

}  // namespace
}  // namespace roomradar::gl_radar_test
