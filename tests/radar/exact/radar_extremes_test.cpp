// radar_extremes_test.cpp: the radar with numbers that are tiny, huge, equal or not finite.
//
// ROOMRADAR_LONG_TESTS=1 also builds trees of 10^7 triangles sorted by position, instead of 10^6.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <deque>
#include <limits>

#include "tests/radar/judged_scene.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar::radar_extremes_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Eigen::Vector3d kDown(0, 0, -1);

Eigen::Isometry3d at(const Eigen::Vector3d& p) { return Eigen::Isometry3d(Eigen::Translation3d(p)); }
Eigen::Isometry3d at(double x, double y, double z) { return at(Eigen::Vector3d(x, y, z)); }

/// Exact at 64 px, sampled at 64 px.
struct Radars {
  CyberRadar exact{RadarConfig{.mode = RadarMode::kExact}};
  CyberRadar sampled{RadarConfig{.mode = RadarMode::kSampled}};

  /// Expects truth_m within error_m from exact mode, and bounds that contain truth_m from sampled mode.
  void expect(const JudgedMesh& object, const Eigen::Vector3d& direction, double distance_m,
              const JudgedScene& scene, std::optional<double> truth_m, double error_m = 1e-9) {
    const Contact got = scene.query(exact, object, direction, distance_m);
    const std::string text = describe(object, direction, distance_m, got, truth_m);
    EXPECT_EQ(got.status, truth_m ? ContactStatus::kContact : ContactStatus::kNoTarget) << text;
    if (truth_m) {
      EXPECT_NEAR(got.contact_distance_m, *truth_m, error_m) << text;
    }
    EXPECT_NEAR(got.lower_m, truth_m.value_or(distance_m), error_m) << text;
    if (truth_m) {
      EXPECT_NEAR(got.upper_m, *truth_m, error_m) << text;
    }
    const Contact rough = scene.query(sampled, object, direction, distance_m);
    EXPECT_TRUE(holds(rough, truth_m, distance_m)) << describe(object, direction, distance_m, rough, truth_m);
  }
  /// Expects the result of the exact reference.
  void expect_judged(const JudgedMesh& object, const Eigen::Vector3d& direction, double distance_m,
                     const JudgedScene& scene) {
    const auto truth_m = scene.contact_distance_m(object, direction, distance_m);
    expect(object, direction, distance_m, scene, truth_m, kExactError_m);
  }
};

JudgedScene scene_of(Mesh mesh, const Eigen::Isometry3d& T_world_mesh = Eigen::Isometry3d::Identity()) {
  JudgedScene scene;
  scene.add(std::move(mesh), T_world_mesh);
  return scene;
}

// Sizes are sums of powers of two in tests with results computed by hand, so float vertices are exact.
Mesh quarter_box() { return shapes::box({0.25F, 0.25F, 0.25F}); }

TEST(RadarExtremes, DistanceOfATenthOfAMillimetre) {
  const JudgedScene scene = scene_of(shapes::floor(1.0F, 0.0F));
  Radars radars;
  radars.expect(JudgedMesh(quarter_box(), at(0, 0, 0.125 + 5e-5)), kDown, 1e-4, scene, 5e-5, 1e-12);
  radars.expect(JudgedMesh(quarter_box(), at(0, 0, 0.125 + 2e-4)), kDown, 1e-4, scene, std::nullopt, 1e-12);
}

TEST(RadarExtremes, DistanceOfAHundredMetres) {
  const JudgedScene scene = scene_of(shapes::floor(1.0F, 0.0F));
  Radars radars;
  radars.expect(JudgedMesh(quarter_box(), at(0.3, 0.2, 99.625)), kDown, 100.0, scene, 99.5);
  radars.expect(JudgedMesh(quarter_box(), at(0.3, 0.2, 100.625)), kDown, 100.0, scene, std::nullopt);
  Eigen::Isometry3d T(Eigen::AngleAxisd(1.0, Eigen::Vector3d(1, 2, 3).normalized()));
  T.pretranslate(Eigen::Vector3d(30, -40, 80));
  radars.expect_judged(JudgedMesh(shapes::torus(30, 20, 0.2F, 0.05F, 0.02F), T), -T.translation(), 100.0,
                       scene_of(shapes::bumpy_ground(20)));
}

TEST(RadarExtremes, ObjectOfAMillimetreAndOfFiftyMetres) {
  Radars radars;
  std::mt19937 random(1);
  for (const float size_m : {0.001F, 50.0F}) {
    Mesh object = shapes::torus(30, 20, 0.4F * size_m, 0.1F * size_m, 0.03F * size_m);
    for (int i = 0; i < 20; ++i) {
      Eigen::Isometry3d T(shapes::random_rotation(random));
      T.pretranslate(Eigen::Vector3d(0, 0, 0.6 * static_cast<double>(size_m) + 0.1));
      radars.expect_judged(JudgedMesh(object, T), kDown + 0.5 * shapes::random_point(random), 0.5,
                           scene_of(shapes::bumpy_ground(30)));
    }
    // On a box of the other size.
    const float other_m = 0.05F / size_m;
    const JudgedScene box = scene_of(shapes::box({other_m, other_m, other_m}));
    const double path_length_m = static_cast<double>(size_m);
    radars.expect_judged(
        JudgedMesh(object, at(0.4 * path_length_m, 0, path_length_m + static_cast<double>(other_m))), kDown,
        2.0 * path_length_m + static_cast<double>(other_m), box);
  }
}

TEST(RadarExtremes, AMillionMetresFromTheOrigin) {
  Radars radars;
  std::mt19937 random(2);
  for (const double sx : {-1e6, 1e6}) {
    for (const double sz : {-1e6, 1e6}) {
      const Eigen::Vector3d place(sx, -sx, sz);
      Mesh ground = shapes::bumpy_ground(30);
      ground.origin = place;  // one scene is far away by its origin, the other by its pose
      JudgedScene scene = scene_of(ground);
      scene.add(shapes::torus(30, 20, 0.3F, 0.1F, 0.03F), at(place + Eigen::Vector3d(0.3, 0, 0)));
      for (int i = 0; i < 15; ++i) {
        Eigen::Isometry3d T(shapes::random_rotation(random));
        T.pretranslate(place + Eigen::Vector3d(0, 0, 0.7) + 0.3 * shapes::random_point(random));
        Mesh object = shapes::torus(30, 20, 0.1F, 0.04F, 0.01F);
        object.origin = i % 2 == 0 ? Eigen::Vector3d(0, 0, 0) : Eigen::Vector3d(1e6, 1e6, -1e6);
        if (i % 2 != 0) T = T * at(-object.origin);
        radars.expect_judged(JudgedMesh(object, T), kDown + 0.6 * shapes::random_point(random), 1.0, scene);
      }
    }
  }
}

TEST(RadarExtremes, DirectionAlongEachAxisAndAHairOff) {
  Radars radars;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      for (const double hair : {0.0, 1e-300, 1e-16, 1e-12, 1e-9, 1e-6, 1e-3}) {
        Eigen::Vector3d direction = Eigen::Vector3d::Zero();
        direction[axis] = sign;
        // Boxes 0.5 apart along the axis, shifted so no edges coincide.
        const Eigen::Vector3d aside = Eigen::Vector3d(0.03, 0.07, 0.11) - 0.75 * direction -
                                      direction.cwiseAbs().cwiseProduct(Eigen::Vector3d(0.03, 0.07, 0.11));
        direction[(axis + 1) % 3] = hair;
        direction[(axis + 2) % 3] = -0.7 * hair;
        const double truth_m = 0.5 * direction.norm();
        radars.expect(JudgedMesh(quarter_box(), at(aside)), direction, 0.75, scene_of(quarter_box()),
                      truth_m);
        radars.expect(JudgedMesh(quarter_box(), at(aside)), -direction, 0.75, scene_of(quarter_box()),
                      std::nullopt);
        radars.expect_judged(JudgedMesh(shapes::cup(0.125F, 0.25F, 0.03125F, 12), at(aside)), direction, 0.75,
                             scene_of(shapes::chair(), at(-0.2, 0, -0.5)));
        // The length of the direction does not matter.
        radars.expect(JudgedMesh(quarter_box(), at(aside)), 1e-200 * direction, 0.75, scene_of(quarter_box()),
                      truth_m);
        radars.expect(JudgedMesh(quarter_box(), at(aside)), 1e200 * direction, 0.75, scene_of(quarter_box()),
                      truth_m);
      }
    }
  }
}

TEST(RadarExtremes, WhatIsNoQuestionIsRefused) {
  const JudgedMesh box(quarter_box(), at(0, 0, 1));
  const JudgedScene scene = scene_of(shapes::floor(1.0F, 0.0F));
  for (const RadarMode mode : {RadarMode::kExact, RadarMode::kSampled}) {
    CyberRadar radar({.mode = mode});
    const auto status = [&](const JudgedMesh& object, const Eigen::Vector3d& direction, double distance_m,
                            double margin_m = 0.0) {
      const Contact got = scene.query(radar, object, direction, distance_m, margin_m);
      EXPECT_FALSE(got);
      EXPECT_EQ(got.lower_m, 0.0);  // nothing is known to be free
      return got.status;
    };
    EXPECT_EQ(status(box, {0, 0, 0}, 1.0), ContactStatus::kInvalidInput);
    EXPECT_EQ(status(box, {0, kNaN, -1}, 1.0), ContactStatus::kInvalidInput);
    EXPECT_EQ(status(box, {0, 0, -kInfinity}, 1.0), ContactStatus::kInvalidInput);
    EXPECT_EQ(status(box, kDown, 0.0), ContactStatus::kInvalidInput);
    EXPECT_EQ(status(box, kDown, -1.0), ContactStatus::kInvalidInput);
    EXPECT_EQ(status(box, kDown, kNaN), ContactStatus::kInvalidInput);
    EXPECT_EQ(status(box, kDown, kInfinity), ContactStatus::kInvalidInput);
    EXPECT_EQ(status(box, kDown, 1.0, kNaN), ContactStatus::kInvalidInput);
    EXPECT_EQ(status(box, kDown, 1.0, -0.1), ContactStatus::kInvalidInput);
    EXPECT_EQ(status(JudgedMesh(Mesh{}), kDown, 1.0), ContactStatus::kInvalidInput);
    EXPECT_EQ(status(JudgedMesh(quarter_box(), at(0, kNaN, 1)), kDown, 1.0), ContactStatus::kInvalidInput);
    Mesh no_numbers = quarter_box();
    for (Eigen::Vector3f& p : no_numbers.vertices) p.x() = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(status(JudgedMesh(no_numbers), kDown, 1.0), ContactStatus::kInvalidInput);
    EXPECT_EQ(radar.query({.object = {}, .direction_world = kDown, .distance_m = 1.0}, {}).status,
              ContactStatus::kInvalidInput);
  }
}

TEST(RadarExtremes, AnEmptySceneIsFree) {
  Radars radars;
  radars.expect(JudgedMesh(quarter_box()), kDown, 2.0, JudgedScene(), std::nullopt);
  radars.expect(JudgedMesh(quarter_box()), kDown, 2.0, scene_of(Mesh{}), std::nullopt);
  const DepthImage nothing(64, 48);
  JudgedScene blind;
  blind.add({.depth_m = &nothing, .camera = {64, 48, 60.0, 60.0, 31.5, 23.5}});
  radars.expect(JudgedMesh(quarter_box()), kDown, 2.0, blind, std::nullopt);
}

TEST(RadarExtremes, TouchingExactlyIsContactAtZero) {
  Radars radars;
  const JudgedScene floor = scene_of(shapes::floor(1.0F, 0.0F)), box = scene_of(quarter_box());
  radars.expect(JudgedMesh(quarter_box(), at(0, 0, 0.125)), kDown, 1.0, floor, 0.0, 1e-12);
  radars.expect(JudgedMesh(quarter_box(), at(0.1, 0.05, 0.25)), kDown, 1.0, box, 0.0, 1e-12);
  radars.expect(JudgedMesh(quarter_box(), at(0.1, 0.05, 0.25)), {0.1, 0.2, -0.5}, 1.0, box, 0.0, 1e-12);
}

TEST(RadarExtremes, ATenthOfAMicrometreBeforeOrPastTouching) {
  const JudgedScene floor = scene_of(shapes::floor(1.0F, 0.0F));
  Radars radars;
  radars.expect(JudgedMesh(quarter_box(), at(0.2, 0, 0.125 + 1e-7)), kDown, 1.0, floor, 1e-7, 1e-12);
  for (CyberRadar* radar : {&radars.exact, &radars.sampled}) {
    const JudgedMesh past(quarter_box(), at(0.2, 0, 0.125 - 1e-7));
    const Contact got = floor.query(*radar, past, kDown, 1.0);
    EXPECT_TRUE(got) << describe(past, kDown, 1.0, got, -1e-7);  // contact or overlap
    EXPECT_LE(got.lower_m, 0.0);
    EXPECT_NEAR(got.contact_distance_m, -1e-7, kExactError_m);
  }
}

TEST(RadarExtremes, WhatTouchesMayLeaveAndSlide) {
  const JudgedScene floor = scene_of(shapes::floor(1.0F, 0.0F));
  Radars radars;
  for (const double gap_m : {0.0, 1e-7, -1e-9}) {
    const JudgedMesh resting(quarter_box(), at(0, 0, 0.125 + gap_m));
    for (const Eigen::Vector3d& direction :
         {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0.3, -1, 1e-3)}) {
      radars.expect(resting, direction, 0.5, floor, std::nullopt);
    }
  }
}

TEST(RadarExtremes, FacesParallelAndPerpendicularToTheDirection) {
  Radars radars;
  const JudgedScene box = scene_of(quarter_box());
  // Face onto face, every vertex and edge above another.
  radars.expect(JudgedMesh(quarter_box(), at(0, 0, 1)), kDown, 1.0, box, 0.75);
  // Sides flush over half an edge.
  radars.expect(JudgedMesh(quarter_box(), at(0.125, 0, 1)), kDown, 1.0, box, 0.75);
  // Passing with 1e-7 m between the sides, and touching with 1e-7 m of common outline.
  radars.expect(JudgedMesh(quarter_box(), at(0.25 + 1e-7, 0.1, 1)), kDown, 2.0, box, std::nullopt);
  radars.expect(JudgedMesh(quarter_box(), at(0.25 - 1e-7, 0.1, 1)), kDown, 2.0, box, 0.75);
  // A vertical sheet onto the edge of another one: in the same plane, and crossing it.
  Mesh sheet;
  shapes::add_quad(sheet, {-0.25F, 0, -0.25F}, {0.25F, 0, -0.25F}, {0.25F, 0, 0.25F}, {-0.25F, 0, 0.25F});
  radars.expect(JudgedMesh(sheet, at(0.1, 0, 1) * Eigen::Isometry3d(
                                                      Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()))),
                kDown, 1.0, scene_of(sheet), 0.5);
}

TEST(RadarExtremes, DegenerateDuplicateAndNaNTrianglesChangeNothing) {
  Radars radars;
  std::mt19937 random(3);
  const Mesh torus = shapes::torus(20, 12, 0.2F, 0.05F, 0.02F), ground = shapes::bumpy_ground(20);
  for (int i = 0; i < 20; ++i) {
    Eigen::Isometry3d T(shapes::random_rotation(random));
    T.pretranslate(Eigen::Vector3d(0, 0, 0.5));
    const Eigen::Vector3d direction = kDown + 0.5 * shapes::random_point(random);
    const auto truth_m = scene_of(ground).contact_distance_m(JudgedMesh(torus, T), direction, 1.0);
    radars.expect(JudgedMesh(shapes::spoilt(torus), T), direction, 1.0, scene_of(shapes::spoilt(ground)),
                  truth_m, 1e-9);
  }
}

TEST(RadarExtremes, PointsAndLinesTouchLikeTriangles) {
  Radars radars;
  Mesh point, line;
  point.vertices = {{0, 0, 0}};
  point.triangles = {{0, 0, 0}};
  line.vertices = {{-0.5F, 0, 0}, {0.5F, 0, 0.25F}};
  line.triangles = {{0, 1, 1}};
  radars.expect(JudgedMesh(point, at(0.1, 0.2, 0.5)), kDown, 1.0, scene_of(shapes::floor(1.0F, 0.0F)), 0.5);
  radars.expect(JudgedMesh(line, at(0.1, 0.2, 0.5)), kDown, 1.0, scene_of(shapes::floor(1.0F, 0.0F)), 0.5);
  radars.expect(JudgedMesh(quarter_box(), at(0, 0, 0.5)), kDown, 1.0, scene_of(point), 0.375);
}

TEST(RadarExtremes, OneTriangleLargerThanTheVolume) {
  Radars radars;
  Mesh plane;  // kilometres wide, with a slope of 1 in 4
  plane.vertices = {{-4096, -4096, -1024}, {8192, -4096, 2048}, {-4096, 8192, -1024}};
  plane.triangles = {{0, 1, 2}};
  const JudgedScene scene = scene_of(plane);
  radars.expect(JudgedMesh(quarter_box(), at(0, 0, 1)), kDown, 2.0, scene, 1.0 - 0.125 - 0.03125);
  radars.expect_judged(JudgedMesh(shapes::torus(30, 20, 0.2F, 0.05F, 0.02F), at(100, 200, 26)),
                       {0.3, 0.1, -1}, 2.0, scene);
  radars.expect(JudgedMesh(quarter_box(), at(0, 0, 1)), -kDown, 2.0, scene, std::nullopt);
  // An object that is one huge triangle, onto a small box.
  radars.expect(JudgedMesh(plane, at(0, 0, 1)), kDown, 2.0, scene_of(quarter_box()), 1.0 - 0.125 - 0.03125);
}

TEST(RadarExtremes, TenMillionTinyTriangles) {
  // Sorting by position is slow: a million triangles, or all in long tests.
  const bool is_long = std::getenv("ROOMRADAR_LONG_TESTS") != nullptr;
  TriangleTree in_order, by_key;
  {
    const Mesh all = shapes::thorny_grid(2240);
    ASSERT_GT(all.triangles.size(), 10'000'000U);
    in_order.build_in_order(all);
    by_key.build_by_place(is_long ? all : shapes::thorny_grid(710));
  }
  const JudgedMesh over(quarter_box(), at(0.01, 0.02, 1)), beside(quarter_box(), at(0.5, 0.4, 1));
  for (const TriangleTree* tree : {&by_key, &in_order}) {
    const SceneTree scene_tree{{tree, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic};
    const RadarScene scene{{&scene_tree, 1}, {}};
    for (const RadarMode mode : {RadarMode::kExact, RadarMode::kSampled}) {
      CyberRadar radar({.mode = mode});
      for (const auto& [object, truth_m] :
           {std::pair(&over, 0.875 - shapes::kThorn_m), std::pair(&beside, 0.875)}) {
        const Contact got = radar.query(
            {.object = {&object->tree, object->T_world_mesh}, .direction_world = kDown, .distance_m = 2.0},
            scene);
        EXPECT_TRUE(holds(got, truth_m, 2.0)) << describe(*object, kDown, 2.0, got, truth_m);
        if (mode == RadarMode::kExact) {
          EXPECT_NEAR(got.contact_distance_m, truth_m, 1e-9);
        }
      }
    }
  }
}

TEST(RadarExtremes, ResolutionOfOnePixelAndOf4096) {
  std::mt19937 random(4);
  const Mesh torus = shapes::torus(30, 20, 0.2F, 0.05F, 0.02F);
  const JudgedScene scene = scene_of(shapes::bumpy_ground(20));
  for (const int resolution_px : {1, 4096}) {
    CyberRadar exact({.mode = RadarMode::kExact, .resolution_px = resolution_px});
    CyberRadar sampled({.mode = RadarMode::kSampled, .resolution_px = resolution_px});
    for (int i = 0; i < 3; ++i) {
      Eigen::Isometry3d T(shapes::random_rotation(random));
      T.pretranslate(Eigen::Vector3d(0, 0, 0.5));
      const JudgedMesh object(torus, T);
      const Eigen::Vector3d direction = kDown + 0.5 * shapes::random_point(random);
      const auto truth_m = scene.contact_distance_m(object, direction, 1.0);
      const Contact got = scene.query(exact, object, direction, 1.0);
      EXPECT_TRUE(is_exact(got, truth_m, 1.0)) << describe(object, direction, 1.0, got, truth_m);
      for (int kept = 0; kept < 4; ++kept) {  // M has its full resolution from the third query on
        const Contact rough = scene.query(sampled, object, direction, 1.0);
        EXPECT_TRUE(holds(rough, truth_m, 1.0)) << describe(object, direction, 1.0, rough, truth_m);
      }
    }
  }
}

TEST(RadarExtremes, AnOpenMeshTouchesWithItsSurfaceAndHoldsNothingInside) {
  Mesh bowl = shapes::ball(0.5F, 24, 36);  // upper half, open at the bottom
  std::erase_if(bowl.triangles, [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(), [&](std::uint32_t i) { return bowl.vertices[i].z() < -1e-6F; });
  });
  Radars radars;
  const JudgedScene pebble = scene_of(shapes::ball(0.125F, 24, 36));
  // Above the pebble, then around it: the pebble is under the bowl but not inside its surface.
  radars.expect(JudgedMesh(bowl, at(0, 0, 1)), kDown, 2.0, pebble, 1.375);
  radars.expect(JudgedMesh(bowl, at(0, 0, 0)), kDown, 2.0, pebble, 0.375);
  radars.expect(JudgedMesh(bowl, at(0, 0, 0)), -kDown, 2.0, pebble, std::nullopt);
}

TEST(RadarExtremes, SaysWhatKindOfThingIsTouched) {
  CyberRadar radar;
  for (const SurfaceKind kind :
       {SurfaceKind::kStatic, SurfaceKind::kDynamic, SurfaceKind::kObject, SurfaceKind::kUnknownFrontier}) {
    JudgedScene scene;
    scene.add(shapes::floor(1.0F, -0.5F), at(0, 0, 0), SurfaceKind::kStatic);
    scene.add(shapes::floor(0.5F, 0.0F), at(0, 0, 0), kind);
    const Contact got = scene.query(radar, JudgedMesh(quarter_box(), at(0, 0, 1)), kDown, 2.0);
    EXPECT_EQ(got.touched, kind);
    EXPECT_NEAR(got.point_world.z(), 0.0, 1e-9);
    EXPECT_LE(got.point_world.head<2>().lpNorm<Eigen::Infinity>(), 0.125 + 1e-9);
    EXPECT_NEAR((got.normal_world - Eigen::Vector3d::UnitZ()).norm(), 0.0, 1e-6);
  }
}

}  // namespace
}  // namespace roomradar::radar_extremes_test
