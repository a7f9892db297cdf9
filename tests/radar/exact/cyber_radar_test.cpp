// cyber_radar_test.cpp: exact results, valid bounds, overlap, hollows, and every kind of invalid query.
#include "radar/exact/cyber_radar.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "mapping/types/system/error.hpp"
#include "tests/radar/judged_scene.hpp"
#include "tests/radar/shapes.hpp"
#include "tests/support/exact_travel.hpp"

namespace roomradar::cyber_radar_test {
namespace {

using shapes::add_quad;
using shapes::random_point;
using shapes::random_rotation;

constexpr double kExact_m = 1e-6;
const Eigen::Vector3d kDown = -Eigen::Vector3d::UnitZ();
const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

TriangleTree tree_of(const Mesh& mesh) {
  TriangleTree tree;
  tree.build_by_place(mesh);
  return tree;
}

Eigen::Isometry3d at(const Eigen::Vector3d& p) { return Eigen::Isometry3d(Eigen::Translation3d(p)); }

/// Queries the contact of a tree that moves from `pose` along a direction with another tree at the world's
/// origin.
Contact ask(CyberRadar& radar, const TriangleTree& object, const Eigen::Isometry3d& pose,
            const Eigen::Vector3d& direction, double distance_m, const TriangleTree& scene) {
  const SceneTree s{{&scene, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic};
  return radar.query({{&object, pose}, direction, distance_m}, {{&s, 1}, {}});
}

/// A bumpy floor: every triangle is slanted, no two are alike.
Mesh bumpy_floor(int cells, float half_size_m, float bump_m, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> bump(-bump_m, bump_m);
  Mesh mesh;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const float x = half_size_m * (2.0F * static_cast<float>(i) / static_cast<float>(cells) - 1.0F);
      const float y = half_size_m * (2.0F * static_cast<float>(j) / static_cast<float>(cells) - 1.0F);
      mesh.vertices.emplace_back(x, y, bump(random));
    }
  }
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const auto a = static_cast<std::uint32_t>(j * (cells + 1) + i);
      const auto b = a + 1, c = a + static_cast<std::uint32_t>(cells) + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  }
  return mesh;
}

/// Depth image of a camera that looks along z at a bumpy wall 1 m ahead; some pixels are invalid.
DepthImage bumpy_depth(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> noise(-0.01F, 0.01F);
  DepthImage depth_m(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float step = x > width / 2 ? 0.3F : 0.0F;
      depth_m.at(x, y) = 1.0F + step + 0.1F * std::sin(0.1F * static_cast<float>(x + y)) + noise(random);
      if ((x * 7 + y * 13) % 50 == 0) depth_m.at(x, y) = 0.0F;
    }
  }
  return depth_m;
}

TEST(CyberRadar, ABoxAboveAFloorTravelsItsClearance) {
  CyberRadar radar;
  const TriangleTree object = tree_of(shapes::box({0.2F, 0.3F, 0.4F})),
                     scene = tree_of(shapes::floor(2.0F, 0.0F));
  const Contact contact = ask(radar, object, at({0.1, 0.2, 1.0}), 3.0 * kDown, 2.0, scene);
  ASSERT_EQ(contact.status, ContactStatus::kContact);
  EXPECT_NEAR(contact.contact_distance_m, 0.8, kExact_m);
  EXPECT_EQ(contact.lower_m, contact.contact_distance_m);
  EXPECT_EQ(contact.upper_m, contact.contact_distance_m);
  EXPECT_EQ(contact.touched, SurfaceKind::kStatic);
  // A face that lands flat: the contact point is the face's centre.
  EXPECT_NEAR((contact.point_world - Eigen::Vector3d(0.1, 0.2, 0.0)).norm(), 0.0, kExact_m);
  EXPECT_NEAR((contact.normal_world - kUp).norm(), 0.0, kExact_m);
  EXPECT_NEAR(contact.pixel_m, 0.3 / 64, 1e-6);
}

TEST(CyberRadar, AFlatLandingOnThousandsOfTrianglesIsReportedInTheMiddleOfThemAll) {
  CyberRadar radar;
  const TriangleTree fine = tree_of(bumpy_floor(260, 1.0F, 0.0F, 1));  // cells of 8 mm
  const TriangleTree box = tree_of(shapes::box({0.2F, 0.3F, 0.1F}));   // above 1,900 of its triangles
  const Contact contact = ask(radar, box, at({0.113, 0.207, 0.5}), kDown, 1.0, fine);
  ASSERT_EQ(contact.status, ContactStatus::kContact);
  EXPECT_NEAR(contact.contact_distance_m, 0.45, kExact_m);
  EXPECT_NEAR((contact.point_world - Eigen::Vector3d(0.113, 0.207, 0.0)).norm(), 0.0, kExact_m);
  // Upside down on its rim: the centroid is on no contact, but the reported point is on the rim.
  const TriangleTree cup = tree_of(shapes::cup(0.2F, 0.1F, 0.03F, 60));
  const Eigen::Isometry3d T =
      at({0.1, 0.2, 0.5}) * Eigen::Isometry3d(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  const Contact on_rim = ask(radar, cup, T, kDown, 1.0, fine);
  ASSERT_EQ(on_rim.status, ContactStatus::kContact);
  EXPECT_NEAR(on_rim.contact_distance_m, 0.4, kExact_m);
  EXPECT_NEAR(on_rim.point_world.z(), 0.0, kExact_m);
  const double radius_m = (on_rim.point_world.head<2>() - Eigen::Vector2d(0.1, 0.2)).norm();
  EXPECT_GE(radius_m, 0.169);
  EXPECT_LE(radius_m, 0.2001);
  // More pairs of triangles than are counted: the point is anywhere on the face.
  const TriangleTree slab = tree_of(shapes::box({1.0F, 1.0F, 0.1F}));
  const Contact under_slab = ask(radar, slab, at({0.0, 0.0, 0.5}), kDown, 1.0, fine);
  ASSERT_EQ(under_slab.status, ContactStatus::kContact);
  EXPECT_LE(under_slab.point_world.head<2>().lpNorm<Eigen::Infinity>(), 0.5 + kExact_m);
}

TEST(CyberRadar, BeyondTheDistanceThereIsNoTarget) {
  CyberRadar radar;
  const TriangleTree object = tree_of(shapes::box({0.2F, 0.3F, 0.4F})),
                     scene = tree_of(shapes::floor(2.0F, 0.0F));
  const Contact contact = ask(radar, object, at({0.0, 0.0, 1.0}), kDown, 0.79, scene);
  EXPECT_EQ(contact.status, ContactStatus::kNoTarget);
  EXPECT_EQ(contact.lower_m, 0.79);
  EXPECT_EQ(contact.upper_m, std::numeric_limits<double>::infinity());
  EXPECT_EQ(ask(radar, object, at({0.0, 0.0, 1.0}), kUp, 5.0, scene).status, ContactStatus::kNoTarget);
  EXPECT_EQ(ask(radar, object, at({3.0, 0.0, 1.0}), kDown, 5.0, scene).status, ContactStatus::kNoTarget);
}

TEST(CyberRadar, ExactModeAgreesWithTheJudgeOnRandomPosesOfConvexAndConcaveObjects) {
  std::mt19937 random(7);
  CyberRadar exact;
  CyberRadar sampled({RadarMode::kSampled, 24});
  const Mesh floor = bumpy_floor(40, 1.0F, 0.05F, 3);
  TriangleTree in_order;
  in_order.build_in_order(floor);
  const TriangleTree by_key = tree_of(floor);
  int contacts = 0;
  for (const Mesh& mesh : {shapes::box({0.2F, 0.3F, 0.1F}), shapes::torus(40, 20, 0.2F, 0.06F, 0.02F)}) {
    const TriangleTree object = tree_of(mesh);
    ASSERT_TRUE(object.is_closed());
    for (int i = 0; i < 150; ++i) {
      Eigen::Isometry3d pose(random_rotation(random));
      pose.translation() = 0.4 * random_point(random) + Eigen::Vector3d(0.0, 0.0, 0.8);
      const Eigen::Vector3d direction = kDown + 0.8 * random_point(random);
      const auto truth_m = exact_travel(mesh, pose, direction, 2.0, floor, Eigen::Isometry3d::Identity());
      for (const TriangleTree* scene : std::initializer_list<const TriangleTree*>{&by_key, &in_order}) {
        const Contact contact = ask(exact, object, pose, direction, 2.0, *scene);
        const Contact rough = ask(sampled, object, pose, direction, 2.0, *scene);
        ASSERT_EQ(contact.status, truth_m ? ContactStatus::kContact : ContactStatus::kNoTarget) << i;
        ASSERT_EQ(rough.status, contact.status) << i;
        if (!truth_m) continue;
        ++contacts;
        ASSERT_NEAR(contact.contact_distance_m, *truth_m, 1e-9) << i;
        ASSERT_EQ(contact.lower_m, contact.upper_m);
        ASSERT_LE(rough.lower_m, *truth_m + 1e-9) << i;
        ASSERT_GE(rough.upper_m, *truth_m - 1e-9) << i;
      }
    }
  }
  EXPECT_GT(contacts, 500);
}

TEST(CyberRadar, ADepthImageIsTouchedLikeItsMesh) {
  std::mt19937 random(11);
  CyberRadar radar;
  const DepthImage depth_m = bumpy_depth(160, 120, 5);
  MaskImage mask(160, 120, 255);
  for (int y = 30; y < 60; ++y) {
    for (int x = 20; x < 70; ++x) mask.at(x, y) = 0;
  }
  SceneDepth scene;
  scene.depth_m = &depth_m;
  scene.camera = {160, 120, 130.0, 131.0, 79.3, 60.2};
  scene.T_world_camera = Eigen::Isometry3d(random_rotation(random));
  scene.T_world_camera.translation() = Eigen::Vector3d(3.0, -2.0, 1.0);
  scene.max_jump_m = 0.2F;
  scene.kind = SurfaceKind::kDynamic;
  const Mesh torus = shapes::torus(40, 20, 0.1F, 0.03F, 0.01F);
  const TriangleTree object = tree_of(torus);
  int contacts = 0;
  for (int i = 0; i < 400; ++i) {
    scene.stride_px = 1 + i % 4;
    scene.mask = i % 3 == 0 ? &mask : nullptr;
    const Mesh mesh = mesh_of(scene);
    Eigen::Isometry3d in_camera(random_rotation(random));
    in_camera.translation() = Eigen::Vector3d(0.0, 0.0, 0.3) + 0.5 * random_point(random);
    const Eigen::Isometry3d pose = scene.T_world_camera * in_camera;
    const Eigen::Vector3d direction =
        scene.T_world_camera.linear() * (Eigen::Vector3d(0.0, 0.0, 1.0) + random_point(random));
    if (exact_travel(torus, pose, direction, 0.001, mesh, scene.T_world_camera, ExactMethod::kGrid, 0.1)) {
      continue;  // possibly overlapping
    }
    const auto truth_m = exact_travel(torus, pose, direction, 1.5, mesh, scene.T_world_camera);
    const Contact contact = radar.query({{&object, pose}, direction, 1.5}, {{}, {&scene, 1}});
    ASSERT_EQ(contact.status, truth_m ? ContactStatus::kContact : ContactStatus::kNoTarget) << i;
    if (!truth_m) continue;
    ++contacts;
    ASSERT_NEAR(contact.contact_distance_m, *truth_m, 1e-9) << i;
    ASSERT_EQ(contact.touched, SurfaceKind::kDynamic);
  }
  EXPECT_GT(contacts, 150);
}

TEST(CyberRadar, AnOverlapIsAsDeepAsTheWayBack) {
  CyberRadar radar;
  const TriangleTree object = tree_of(shapes::box({0.2F, 0.3F, 0.4F})),
                     scene = tree_of(shapes::floor(2.0F, 0.0F));
  const Contact contact = ask(radar, object, at({0.1, 0.2, 0.15}), kDown, 2.0, scene);
  ASSERT_EQ(contact.status, ContactStatus::kOverlap);
  EXPECT_NEAR(contact.contact_distance_m, -0.05, kExact_m);
  EXPECT_EQ(contact.lower_m, contact.contact_distance_m);
  EXPECT_EQ(contact.upper_m, contact.contact_distance_m);
  EXPECT_NEAR((contact.normal_world - kUp).norm(), 0.0, kExact_m);
  // Moving upwards, the object leaves the floor.
  EXPECT_EQ(ask(radar, object, at({0.1, 0.2, 0.15}), kUp, 2.0, scene).status, ContactStatus::kNoTarget);
}

TEST(CyberRadar, SceneInsideAClosedObjectIsAnOverlapAndInsideAnOpenOneAContact) {
  CyberRadar radar;
  const Mesh box = shapes::box({0.4F, 0.4F, 0.4F});
  const TriangleTree speck = tree_of(shapes::floor(0.05F, 0.1F));
  const Contact contact = ask(radar, tree_of(box), at({0.0, 0.0, 0.0}), kDown, 2.0, speck);
  ASSERT_EQ(contact.status, ContactStatus::kOverlap);
  EXPECT_NEAR(contact.contact_distance_m, -0.3, kExact_m);
  Mesh open = box;
  open.triangles.pop_back();  // one triangle of the +z face
  const Contact surface = ask(radar, tree_of(open), at({0.0, 0.0, 0.0}), kDown, 2.0, speck);
  ASSERT_EQ(surface.status, ContactStatus::kContact);
  EXPECT_NEAR(surface.contact_distance_m, 0.1, kExact_m);
}

TEST(CyberRadar, SceneInAHollowIsMetByTheLayerBehindIt) {
  CyberRadar radar;
  // A ring, rotated so the motion runs along its plane, with a peg in its hole.
  const Mesh torus = shapes::torus(64, 24, 0.2F, 0.04F, 0.0F);
  const TriangleTree object = tree_of(torus);
  const TriangleTree peg = tree_of(shapes::box({0.05F, 0.05F, 0.3F}));
  const Contact contact = ask(radar, object, at({0.0, 0.0, 0.0}), Eigen::Vector3d::UnitX(), 1.0, peg);
  const auto truth_m = exact_travel(torus, at({0.0, 0.0, 0.0}), Eigen::Vector3d::UnitX(), 1.0,
                                    shapes::box({0.05F, 0.05F, 0.3F}), Eigen::Isometry3d::Identity());
  ASSERT_EQ(contact.status, ContactStatus::kContact);
  ASSERT_TRUE(truth_m);
  EXPECT_NEAR(contact.contact_distance_m, *truth_m, 1e-9);
  EXPECT_NEAR(contact.contact_distance_m, std::sqrt(0.16 * 0.16 - 0.025 * 0.025) - 0.025, 0.001);
}

TEST(CyberRadar, TouchingIsZeroAndWhatIsLeftOrSlidAlongIsNothing) {
  CyberRadar radar;
  const TriangleTree object = tree_of(shapes::box({0.5F, 0.5F, 0.5F})),
                     scene = tree_of(shapes::floor(2.0F, 0.0F));
  for (const double gap_m : {0.0, 1e-7, -1e-7}) {
    SCOPED_TRACE(gap_m);
    const Eigen::Isometry3d pose = at({0.0, 0.0, 0.25 + gap_m});
    const Contact contact = ask(radar, object, pose, kDown, 1.0, scene);
    ASSERT_EQ(contact.status, ContactStatus::kContact);
    EXPECT_NEAR(contact.contact_distance_m, std::max(gap_m, 0.0), 1e-9);
    EXPECT_EQ(ask(radar, object, pose, kUp, 1.0, scene).status, ContactStatus::kNoTarget);
    const Contact sliding = ask(radar, object, pose, Eigen::Vector3d::UnitX(), 1.0, scene);
    EXPECT_EQ(sliding.status, ContactStatus::kNoTarget) << sliding.contact_distance_m;
  }
}

TEST(CyberRadar, AskingWronglyIsSaidSo) {
  CyberRadar radar;
  const TriangleTree object = tree_of(shapes::box({0.5F, 0.5F, 0.5F})),
                     scene = tree_of(shapes::floor(2.0F, 0.0F));
  const TriangleTree empty = tree_of(Mesh{});
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const SceneTree s{{&scene, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic};
  const RadarScene scenes{{&s, 1}, {}};
  const auto status = [&](const RadarQuery& query) { return radar.query(query, scenes).status; };
  const Eigen::Isometry3d pose = at({0.0, 0.0, 1.0});
  EXPECT_EQ(status({{&object, pose}, kDown, 1.0}), ContactStatus::kContact);
  EXPECT_EQ(status({{&object, pose}, Eigen::Vector3d::Zero(), 1.0}), ContactStatus::kInvalidInput);
  EXPECT_EQ(status({{&object, pose}, {kNan, 0.0, 1.0}, 1.0}), ContactStatus::kInvalidInput);
  EXPECT_EQ(status({{&object, pose}, kDown, 0.0}), ContactStatus::kInvalidInput);
  EXPECT_EQ(status({{&object, pose}, kDown, kNan}), ContactStatus::kInvalidInput);
  EXPECT_EQ(status({{&object, pose}, kDown, 1.0, -1.0}), ContactStatus::kInvalidInput);
  EXPECT_EQ(status({{&object, at({kNan, 0.0, 0.0})}, kDown, 1.0}), ContactStatus::kInvalidInput);
  EXPECT_EQ(status({{nullptr, pose}, kDown, 1.0}), ContactStatus::kInvalidInput);
  EXPECT_EQ(status({{&empty, pose}, kDown, 1.0}), ContactStatus::kInvalidInput);
  EXPECT_EQ(radar.query({{&object, pose}, kDown, 1.0}, {}).status, ContactStatus::kNoTarget);
  SceneDepth bad_camera;
  const DepthImage depth_m(4, 4, 1.0F);
  bad_camera.depth_m = &depth_m;
  EXPECT_EQ(radar.query({{&object, pose}, kDown, 1.0}, {{}, {&bad_camera, 1}}).status,
            ContactStatus::kInvalidInput);
  for (const float jump_m : {-0.01F, std::numeric_limits<float>::quiet_NaN()}) {
    SceneDepth bad_jump;
    bad_jump.depth_m = &depth_m;
    bad_jump.camera = {4, 4, 4.0, 4.0, 1.5, 1.5};
    EXPECT_NE(radar.query({{&object, pose}, kDown, 1.0}, {{}, {&bad_jump, 1}}).status,
              ContactStatus::kInvalidInput);
    bad_jump.max_jump_m = jump_m;
    EXPECT_EQ(radar.query({{&object, pose}, kDown, 1.0}, {{}, {&bad_jump, 1}}).status,
              ContactStatus::kInvalidInput);
  }
  EXPECT_THROW(CyberRadar({RadarMode::kExact, 0}), Error);
  EXPECT_THROW(CyberRadar({RadarMode::kExact, 4097}), Error);
}

TEST(CyberRadar, AMarginLowersTheLowerBoundByWhatItThickens) {
  CyberRadar radar;
  const TriangleTree object = tree_of(shapes::box({0.2F, 0.3F, 0.4F})),
                     scene = tree_of(shapes::floor(2.0F, 0.0F));
  const SceneTree s{{&scene, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic};
  const Contact contact = radar.query({{&object, at({0.1, 0.2, 1.0})}, kDown, 2.0, 0.01}, {{&s, 1}, {}});
  ASSERT_EQ(contact.status, ContactStatus::kContact);
  EXPECT_NEAR(contact.lower_m, 0.79, kExact_m);
  EXPECT_EQ(contact.upper_m, std::numeric_limits<double>::infinity());
}

TEST(CyberRadar, ASpeckInsideIsAnOverlapThickenedOrInSeveralSolidsAtOnce) {
  CyberRadar radar;
  const TriangleTree speck = tree_of(shapes::box({0.001F, 0.001F, 0.001F}));
  const SceneTree s{{&speck, Eigen::Isometry3d::Identity()}, SurfaceKind::kObject};
  const std::pair<Mesh, Eigen::Vector3f> two[] = {{shapes::box({0.4F, 0.4F, 0.4F}), {0.01F, 0.02F, 0.0F}},
                                                  {shapes::box({0.3F, 0.3F, 0.3F}), {0.02F, 0.01F, 0.05F}}};
  for (const TriangleTree& object :
       {tree_of(shapes::box({0.4F, 0.4F, 0.4F})), tree_of(shapes::together(two))}) {
    ASSERT_TRUE(object.is_closed());
    EXPECT_EQ(radar.query({{&object, at({0.03, 0.05, 0.02})}, kDown, 1.0}, {{&s, 1}, {}}).status,
              ContactStatus::kOverlap);
    EXPECT_EQ(radar.query({{&object, at({0.03, 0.05, 0.02})}, kDown, 1.0, 0.001}, {{&s, 1}, {}}).lower_m,
              0.0);
  }
}

TEST(CyberRadar, OneSidedSurfacesAreMetFromTheirOutsideOnly) {
  CyberRadar radar;
  const TriangleTree ball = tree_of(shapes::ball(0.1F, 12, 24));
  const TriangleTree hull = tree_of(shapes::box({1.0F, 1.0F, 1.0F}));
  for (const SurfaceKind kind :
       {SurfaceKind::kInferredBack, SurfaceKind::kUnknownFrontier, SurfaceKind::kDynamic}) {
    const SceneTree scene{{&hull, Eigen::Isometry3d::Identity()}, kind};
    const auto ask_at = [&](double height_m, const Eigen::Vector3d& direction) {
      return radar.query({{&ball, at({0.01, 0.02, height_m})}, direction, 2.0}, {{&scene, 1}, {}});
    };
    const Contact from_outside = ask_at(1.0, kDown);
    ASSERT_EQ(from_outside.status, ContactStatus::kContact);
    EXPECT_EQ(from_outside.touched, kind);
    const bool is_left = kind != SurfaceKind::kDynamic;
    EXPECT_EQ(ask_at(0.0, kUp).status, is_left ? ContactStatus::kNoTarget : ContactStatus::kContact);
    EXPECT_EQ(ask_at(0.47, kUp).status, ContactStatus::kNoTarget) << "half out of it";
    EXPECT_EQ(ask_at(0.47, kDown).status, ContactStatus::kOverlap);
  }
}

}  // namespace
}  // namespace roomradar::cyber_radar_test
