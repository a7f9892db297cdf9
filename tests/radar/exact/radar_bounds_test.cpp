// radar_bounds_test.cpp: the radar's results against the exact reference on random poses, convex and concave
// objects.
//
// ROOMRADAR_LONG_TESTS=1 tests ten times as many poses, a build with the address sanitizer a tenth as many.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "radar/exact/cyber_radar.hpp"
#include "tests/radar/judged_scene.hpp"
#include "tests/radar/shapes.hpp"
#include "tests/support/exact_clearance.hpp"

namespace roomradar::radar_bounds_test {
namespace {

constexpr std::array<int, 3> kSampled_px = {16, 64, 128};

int poses(int count) {
  if (std::getenv("ROOMRADAR_LONG_TESTS") != nullptr) return 10 * count;
#ifdef __SANITIZE_ADDRESS__
  return count / 10;
#else
  return count;
#endif
}

Eigen::Isometry3d at(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

Eigen::Isometry3d random_pose(std::mt19937& random, const Eigen::Vector3d& centre,
                              const Eigen::Vector3d& spread) {
  Eigen::Isometry3d T(shapes::random_rotation(random));
  T.pretranslate(centre + spread.cwiseProduct(shapes::random_point(random)));
  return T;
}

/// One radar in exact mode, and one in sampled mode per resolution.
class Radars {
 public:
  Radars() {
    for (const int resolution_px : kSampled_px) {
      sampled_.emplace_back(RadarConfig{.mode = RadarMode::kSampled, .resolution_px = resolution_px});
    }
  }
  /// Checks the results of all radars for a pose that is free now; returns true if there is a contact.
  bool expect_right(const JudgedMesh& object, const Eigen::Vector3d& direction, double distance_m,
                    const JudgedScene& scene, const std::string& what) {
    const auto truth_m = scene.contact_distance_m(object, direction, distance_m);
    const Contact exact = scene.query(exact_, object, direction, distance_m);
    EXPECT_TRUE(is_exact(exact, truth_m, distance_m))
        << what << ", exact: " << describe(object, direction, distance_m, exact, truth_m);
    if (exact && truth_m) worst_m_ = std::max(worst_m_, std::abs(exact.contact_distance_m - *truth_m));
    for (std::size_t i = 0; i < sampled_.size(); ++i) {
      const Contact sampled = scene.query(sampled_[i], object, direction, distance_m);
      EXPECT_TRUE(holds(sampled, truth_m, distance_m))
          << what << ", sampled at " << kSampled_px[i]
          << " px: " << describe(object, direction, distance_m, sampled, truth_m);
      if (sampled) widths_m_[i].push_back(sampled.upper_m - sampled.lower_m);
    }
    return truth_m.has_value();
  }
  void report() {
    std::printf("exact: worst error %.2g m; sampled: upper - lower median (p95, worst)", worst_m_);
    for (std::size_t i = 0; i < sampled_.size(); ++i) {
      std::vector<double>& widths_m = widths_m_[i];
      if (widths_m.empty()) continue;
      std::sort(widths_m.begin(), widths_m.end());
      std::printf(" %d px %.3f (%.3f, %.3f) mm", kSampled_px[i], 1e3 * widths_m[widths_m.size() / 2],
                  1e3 * widths_m[widths_m.size() * 95 / 100], 1e3 * widths_m.back());
    }
    std::printf("\n");
  }

 private:
  double worst_m_ = 0.0;
  std::array<std::vector<double>, kSampled_px.size()> widths_m_;
  CyberRadar exact_{RadarConfig{.mode = RadarMode::kExact, .resolution_px = 64}};
  std::deque<CyberRadar> sampled_;
};

/// Half a bumpy torus, open at the cut.
Mesh open_shell() {
  Mesh mesh = shapes::torus(32, 16, 0.12F, 0.05F, 0.015F);
  mesh.triangles.resize(mesh.triangles.size() / 2);
  return mesh;
}

struct Named {
  std::string name;
  JudgedMesh mesh;
  double radius_m;
};

std::deque<Named> objects() {
  std::deque<Named> result;
  const auto add = [&](const char* name, const Mesh& mesh) {
    double radius_m = 0.0;
    for (const Eigen::Vector3f& p : mesh.vertices) radius_m = std::max(radius_m, double{p.norm()});
    result.push_back({name, JudgedMesh(mesh), radius_m});
  };
  add("box", shapes::box({0.25F, 0.15F, 0.1F}));
  add("ball", shapes::ball(0.12F, 12, 16));
  add("bumpy torus", shapes::torus(48, 24, 0.1F, 0.04F, 0.015F));
  add("cup", shapes::cup(0.1F, 0.2F, 0.01F, 24));
  add("chair", shapes::chair());
  add("needle", shapes::box({0.3F, 0.0002F, 0.0001F}));
  add("sheet", shapes::floor(0.15F, 0.0F));
  add("open shell", open_shell());
  return result;
}

/// Throws every object at the scene from above, in directions up to about 60 degrees off straight down. The
/// whole world is rotated and moved for each throw.
void throw_all(JudgedScene scene, double top_m, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Radars radars;
  std::deque<Named> things = objects();
  int contacts = 0;
  Eigen::Isometry3d T_world_now = Eigen::Isometry3d::Identity();
  for (int i = 0; i < count && !testing::Test::HasFailure(); ++i) {
    Named& thing = things[static_cast<std::size_t>(i) % things.size()];
    const Eigen::Isometry3d T_world = random_pose(random, {0, 0, 0}, {9, 9, 9});
    scene.move(T_world * T_world_now.inverse());
    T_world_now = T_world;
    const double height_m = top_m + thing.radius_m + 0.01 + 0.3 * uniform(random);
    thing.mesh.T_world_mesh = T_world * random_pose(random, {0, 0, height_m}, {0.4, 0.4, 0});
    const Eigen::Vector3d direction =
        T_world.linear() * (Eigen::Vector3d(0, 0, -1) + 0.9 * shapes::random_point(random));
    const double distance_m = 0.1 + 1.2 * uniform(random);
    contacts +=
        radars.expect_right(thing.mesh, direction, distance_m, scene,
                            thing.name + " of seed " + std::to_string(seed) + " pose " + std::to_string(i))
            ? 1
            : 0;
  }
  std::printf("%d contacts in %d poses\n", contacts, count);
  radars.report();
  EXPECT_GT(contacts, count / 4);
}

TEST(RadarBounds, HoldOverBumpyGround) {
  JudgedScene scene;
  scene.add(shapes::bumpy_ground(40));
  throw_all(std::move(scene), 0.065, poses(3600), 1);
}

TEST(RadarBounds, HoldOverConcaveThings) {
  std::mt19937 random(11);
  JudgedScene scene;
  for (int i = 0; i < 3; ++i) {
    scene.add(shapes::cup(0.2F, 0.3F, 0.02F, 16), random_pose(random, {0, 0, -0.4}, {0.5, 0.5, 0}));
    scene.add(shapes::torus(24, 12, 0.25F, 0.07F, 0.02F), random_pose(random, {0, 0, -0.4}, {0.5, 0.5, 0}),
              SurfaceKind::kObject);
    scene.add(shapes::chair(), random_pose(random, {0, 0, -1.0}, {0.5, 0.5, 0}));
  }
  throw_all(std::move(scene), 0.0, poses(3200), 2);
}

/// A table with a step and a ball, seen from 1.5 m above its centre, with noise and holes.
DepthImage depth_of_table(const Intrinsics& camera) {
  DepthImage depth_m(camera.width_px, camera.height_px);
  std::mt19937 random(12);
  std::normal_distribution<double> noise(0.0, 0.002);
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      const Eigen::Vector3d p = back_project(camera, u, v, 1.5);
      double z_m = p.x() > 0.1 ? 1.38 : 1.5 + 0.1 * p.y();
      const double height2 = 0.15 * 0.15 - (p.head<2>() - Eigen::Vector2d(-0.3, 0.1)).squaredNorm();
      if (height2 > 0.0) z_m -= std::sqrt(height2);
      depth_m.at(u, v) = static_cast<float>(z_m + noise(random));
      if (random() % 40 == 0) depth_m.at(u, v) = 0.0F;
    }
  }
  return depth_m;
}

TEST(RadarBounds, HoldOverDepthImages) {
  const Intrinsics camera{120, 90, 100.0, 100.0, 59.5, 44.5};
  const DepthImage depth_m = depth_of_table(camera);
  MaskImage mask(camera.width_px, camera.height_px, 255);
  for (int v = 30; v < 50; ++v) std::fill(mask.row(v) + 50, mask.row(v) + 70, std::uint8_t{0});
  // The camera looks down at the world's floor: its z is the world's -z.
  Eigen::Isometry3d T_world_camera(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  T_world_camera.pretranslate(Eigen::Vector3d(0, 0, 1.5));
  JudgedScene fine, coarse;
  fine.add({.depth_m = &depth_m, .camera = camera, .T_world_camera = T_world_camera});
  coarse.add({.depth_m = &depth_m,
              .mask = &mask,
              .camera = camera,
              .T_world_camera = T_world_camera,
              .stride_px = 4,
              .max_jump_m = 0.02F,
              .max_jump_slope = 0.01F});
  coarse.add(shapes::torus(24, 12, 0.25F, 0.07F, 0.02F), at(0.1, 0.2, 0.1), SurfaceKind::kObject);
  throw_all(std::move(fine), 0.26, poses(600), 3);
  throw_all(std::move(coarse), 0.45, poses(200), 4);
}

/// Free poses with scene in a hollow of the object, or the object in a hollow of the scene.
struct Hollow {
  std::string name;
  Mesh object;
  Eigen::Vector3d centre, spread;
  double turn;  // max angle from upright, rad
  Mesh scene;
};

TEST(RadarBounds, SceneInAHollowIsNeitherContactNorOverlap) {
  const std::pair<Mesh, Eigen::Vector3f> ball = {shapes::ball(0.05F, 10, 14), {0.0F, 0.0F, 0.0F}};
  const std::pair<Mesh, Eigen::Vector3f> block = {shapes::box({0.1F, 0.08F, 0.2F}), {0.12F, -0.02F, 0.0F}};
  const std::array<std::pair<Mesh, Eigen::Vector3f>, 2> things = {ball, block};
  const std::array<Hollow, 6> hollows = {
      Hollow{"post through a bumpy torus",
             shapes::torus(36, 16, 0.1F, 0.035F, 0.012F),
             {0, 0, 0},
             {0.04, 0.04, 0.3},
             0.5,
             shapes::box({0.03F, 0.03F, 1.0F})},
      Hollow{"ball in a cup",
             shapes::cup(0.15F, 0.25F, 0.01F, 20),
             {0, 0, -0.13},
             {0.08, 0.08, 0.1},
             0.3,
             ball.first},
      Hollow{"ball thrown in a standing cup",
             ball.first,
             {0, 0, 0.13},
             {0.08, 0.08, 0.1},
             3.0,
             shapes::cup(0.15F, 0.25F, 0.01F, 20)},
      Hollow{"things under a chair",
             shapes::chair(),
             {-0.06, 0, -0.25},
             {0.08, 0.1, 0.12},
             0.15,
             shapes::together(things)},
      Hollow{"torus round a ball",
             shapes::torus(36, 16, 0.12F, 0.04F, 0.012F),
             {0, 0, 0},
             {0.02, 0.02, 0.05},
             3.0,
             ball.first},
      Hollow{
          "shell over bumps", open_shell(), {0, 0, 0.12}, {0.3, 0.3, 0.06}, 3.0, shapes::bumpy_ground(20)}};
  Radars radars;
  int free = 0, contacts = 0;
  for (std::size_t h = 0; h < hollows.size(); ++h) {
    const Hollow& hollow = hollows[h];
    JudgedMesh object(hollow.object);
    JudgedScene scene;
    scene.add(hollow.scene);
    const bool is_closed = hollow.name != "shell over bumps";
    std::mt19937 random(100 + static_cast<unsigned>(h));
    int kept = 0;
    for (int tried = 0; kept < poses(520) && tried < poses(20000) && !HasFailure(); ++tried) {
      const Eigen::Vector3d axis = shapes::random_point(random).normalized();
      object.T_world_mesh = Eigen::AngleAxisd(hollow.turn * shapes::random_point(random).x(), axis);
      object.T_world_mesh.pretranslate(hollow.centre +
                                       hollow.spread.cwiseProduct(shapes::random_point(random)));
      const JudgedMesh& rest = scene.meshes().front();
      if (exact_clearance(object.mesh, object.T_world_mesh, rest.mesh, rest.T_world_mesh, 2e-6) < 2e-6) {
        continue;
      }
      if (is_closed && exact_holds_inside(object.mesh, object.T_world_mesh, rest.mesh, rest.T_world_mesh)) {
        continue;
      }
      ++kept;
      contacts += radars.expect_right(object, shapes::random_point(random), 0.3, scene,
                                      hollow.name + ", pose " + std::to_string(tried))
                      ? 1
                      : 0;
    }
    EXPECT_GE(kept, HasFailure() ? 0 : poses(520)) << hollow.name;
    free += kept;
  }
  std::printf("%d free poses with scene in a hollow, %d contacts\n", free, contacts);
  radars.report();
  EXPECT_GE(free, HasFailure() ? 0 : poses(3000));
}

/// Returns the triangles that do not face along the motion, the only ones that the moving object can hit.
Mesh opposing(const Mesh& scene, const Eigen::Vector3d& direction) {
  Mesh result = scene;
  std::erase_if(result.triangles, [&](const Triangle& t) {
    const Eigen::Vector3d a = scene.vertices[t[0]].cast<double>(), b = scene.vertices[t[1]].cast<double>(),
                          c = scene.vertices[t[2]].cast<double>();
    return (b - a).cross(c - a).dot(direction) > 0.0;
  });
  return result;
}

/// Returns true if a result depends on less than twenty times the touching tolerance.
bool is_close(std::span<const TravelSpan> crossings, const std::optional<TravelSpan>& overlap) {
  constexpr double kClose_m = 2e-5;
  return std::any_of(crossings.begin(), crossings.end(), [&](const TravelSpan& span) {
    const bool ends_now = std::abs(span.from_m) < kClose_m || std::abs(span.to_m) < kClose_m;
    const double between_m = overlap ? overlap->from_m - span.to_m : 1.0;  // one overlap or two?
    return ends_now || (between_m > 0.0 && between_m < kClose_m);
  });
}

/// Returns true if a triangle of the scene may be inside the object, without crossing its surface, at the
/// given distance along the motion: the judge sees surfaces only.
bool may_enclose(const Named& object, const Mesh& scene, const Eigen::Vector3d& direction, double moved_m) {
  const Eigen::Vector3d centre = object.mesh.T_world_mesh.translation() + moved_m * direction.normalized();
  return std::any_of(scene.triangles.begin(), scene.triangles.end(), [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t corner) {
      return (scene.vertices[corner].cast<double>() - centre).norm() < object.radius_m;
    });
  });
}

TEST(RadarBounds, OverlapIsToldWithItsDepth) {
  const Mesh ground = shapes::bumpy_ground(16);
  JudgedScene scene;
  scene.add(ground);
  CyberRadar radar({.mode = RadarMode::kExact});
  CyberRadar sampled({.mode = RadarMode::kSampled, .resolution_px = 64});
  std::deque<Named> things = objects();
  std::mt19937 random(21);
  int into = 0, other = 0;
  for (int i = 0; i < poses(500) && !HasFailure(); ++i) {
    Named& thing = things[static_cast<std::size_t>(i) % things.size()];
    if (thing.name == "needle") continue;
    thing.mesh.T_world_mesh = random_pose(random, {0, 0, 0}, {0.4, 0.4, std::min(0.12, thing.radius_m)});
    const Eigen::Vector3d direction = shapes::random_point(random);
    const Mesh facing = opposing(ground, direction);
    const auto crossings =
        exact_crossings(thing.mesh.mesh, thing.mesh.T_world_mesh, direction, facing, at(0, 0, 0));
    const auto overlap = exact_overlap(crossings);
    if (is_close(crossings, overlap)) continue;
    constexpr double kClear_m = 1e-4;  // moved back this much farther than the overlap
    const bool may_join_earlier =
        overlap && may_enclose(thing, facing, direction, overlap->from_m - kClear_m);
    const double depth_m = overlap ? -overlap->from_m : 0.0;
    const auto is_start = [&](double moved_m) {  // of the overlap, or of one that is joined to it
      return std::any_of(crossings.begin(), crossings.end(), [&](const TravelSpan& span) {
        const bool is_joined = span.from_m == -depth_m || (may_join_earlier && span.from_m < -depth_m);
        return is_joined && std::abs(moved_m - span.from_m) <= kExactError_m;
      });
    };
    for (CyberRadar* r : {&radar, &sampled}) {
      const Contact got = scene.query(*r, thing.mesh, direction, 0.5);
      const std::string text = thing.name + " pose " + std::to_string(i) + ": " +
                               describe(thing.mesh, direction, 0.5, got, -depth_m);
      if (!overlap) {
        EXPECT_NE(got.status, ContactStatus::kOverlap) << text;
        continue;
      }
      ASSERT_EQ(got.status, ContactStatus::kOverlap) << text;
      EXPECT_EQ(got.contact_distance_m, got.lower_m) << text;
      EXPECT_EQ(got.contact_distance_m, got.upper_m) << text;
      EXPECT_TRUE(is_start(got.contact_distance_m)) << text;
      EXPECT_NEAR(got.normal_world.norm(), 1.0, 1e-6);
    }
    ++(overlap ? into : other);
  }
  std::printf("%d overlaps, %d free or leaving\n", into, other);
  EXPECT_GT(into, HasFailure() ? 0 : poses(100));
  EXPECT_GT(other, HasFailure() ? 0 : poses(50));
}

TEST(RadarBounds, WhatIsSunkMayLeave) {
  const Mesh ground = shapes::bumpy_ground(16);
  JudgedScene scene;
  scene.add(ground);
  CyberRadar exact({.mode = RadarMode::kExact});
  CyberRadar sampled({.mode = RadarMode::kSampled, .resolution_px = 64});
  std::deque<Named> things = objects();
  std::mt19937 random(22);
  int leaving = 0;
  for (int i = 0; i < poses(400); ++i) {
    Named& thing = things[static_cast<std::size_t>(i) % things.size()];
    thing.mesh.T_world_mesh = random_pose(random, {0, 0, 0}, {0.4, 0.4, 0});
    // All of the ground faces against a motion up to 25 degrees off the vertical.
    const Eigen::Vector3d up = Eigen::Vector3d(0, 0, 1) + 0.3 * shapes::random_point(random);
    // Moves it up until it is free, then back in.
    const auto crossings = exact_crossings(thing.mesh.mesh, thing.mesh.T_world_mesh, up, ground, at(0, 0, 0));
    if (crossings.empty()) continue;
    const double sunk_m = std::pow(10.0, -4.0 + 0.015 * (i % 200));  // 0.1 mm to 0.1 m
    // A needle that is sunk below the ground, or between two bumps, meets the ground again.
    const double moved_m = crossings.back().to_m - sunk_m;
    if (thing.name == "needle" && crossings.back().from_m >= moved_m) continue;
    thing.mesh.T_world_mesh.pretranslate(moved_m * up.normalized());
    ++leaving;
    for (CyberRadar* radar : {&exact, &sampled}) {
      const Contact got = scene.query(*radar, thing.mesh, up, 0.5);
      EXPECT_EQ(got.status, ContactStatus::kNoTarget)
          << thing.name << " pose " << i << " sunk " << sunk_m << ": "
          << describe(thing.mesh, up, 0.5, got, std::nullopt);
    }
  }
  EXPECT_GT(leaving, poses(200));
}

TEST(RadarBounds, MarginHoldsForTheThickenedObject) {
  JudgedScene scene;
  scene.add(shapes::bumpy_ground(16));
  const JudgedMesh& ground = scene.meshes().front();
  CyberRadar exact({.mode = RadarMode::kExact});
  CyberRadar sampled({.mode = RadarMode::kSampled, .resolution_px = 32});
  std::deque<JudgedMesh> things;
  for (const Mesh& mesh : {shapes::box({0.25F, 0.15F, 0.1F}), shapes::cup(0.1F, 0.2F, 0.01F, 10),
                           shapes::torus(10, 6, 0.12F, 0.04F, 0.01F)}) {
    things.emplace_back(mesh);
  }
  std::mt19937 random(41);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<double> timid_margins;
  int stopped = 0;
  for (int i = 0; i < poses(120) && !HasFailure(); ++i) {
    JudgedMesh& thing = things[static_cast<std::size_t>(i) % things.size()];
    thing.T_world_mesh = random_pose(random, {0, 0, 0.3 + 0.2 * uniform(random)}, {0.4, 0.4, 0});
    const Eigen::Vector3d direction = Eigen::Vector3d(0, 0, -1) + 0.9 * shapes::random_point(random);
    const double margin_m = std::pow(10.0, -3.0 + 2.0 * uniform(random)), distance_m = 0.6;
    const auto clearance_m = [&](double contact_distance_m) {
      Eigen::Isometry3d T = thing.T_world_mesh;
      T.pretranslate(contact_distance_m * direction.normalized());
      return exact_clearance(thing.mesh, T, ground.mesh, ground.T_world_mesh);
    };
    // Advances by the certain clearance: approaches the inflated object's distance to contact from below.
    double truth_m = 0.0;
    for (int step = 0; step < 60 && truth_m < distance_m; ++step) {
      truth_m += std::max(clearance_m(truth_m) - margin_m, 0.0);
    }
    truth_m = std::min(truth_m, distance_m);
    for (CyberRadar* radar : {&exact, &sampled}) {
      const Contact got = scene.query(*radar, thing, direction, distance_m, margin_m);
      const std::string text = "pose " + std::to_string(i) + " margin " + std::to_string(margin_m) + ": " +
                               describe(thing, direction, distance_m, got, truth_m);
      // A result beyond the reference's stop is allowed only if nothing comes within the margin up to there.
      for (double contact_distance_m = std::max(got.lower_m, 0.0); contact_distance_m > truth_m;
           contact_distance_m -= 1e-3) {
        ASSERT_GT(clearance_m(contact_distance_m), margin_m - kExactError_m) << text;
      }
      timid_margins.push_back((truth_m - got.lower_m) / margin_m);
    }
    stopped += truth_m < distance_m ? 1 : 0;
  }
  EXPECT_GT(stopped, HasFailure() ? 0 : poses(60));
  // The bound must be useful: equal to the truth in exact mode except for grazes, about a pixel below it in
  // sampled mode.
  std::sort(timid_margins.begin(), timid_margins.end());
  std::printf("timid by median %.2f, p90 %.2f, worst %.2f margins\n", timid_margins[timid_margins.size() / 2],
              timid_margins[timid_margins.size() * 9 / 10], timid_margins.back());
  EXPECT_LT(timid_margins[timid_margins.size() / 2], 0.1);
  EXPECT_LT(timid_margins[timid_margins.size() * 9 / 10], 1.0);
}

TEST(RadarBounds, ARadarThatAnsweredBeforeAnswersLikeANewOne) {
  JudgedScene ground, things_about;
  ground.add(shapes::bumpy_ground(20));
  things_about.add(shapes::chair(), at(0.2, 0.1, -0.6));
  things_about.add(shapes::cup(0.2F, 0.3F, 0.02F, 16), at(-0.3, 0, 0), SurfaceKind::kObject);
  std::deque<Named> things = objects();
  std::mt19937 random(51);
  for (const RadarMode mode : {RadarMode::kExact, RadarMode::kSampled}) {
    CyberRadar old({.mode = mode});
    for (int i = 0; i < poses(300) && !HasFailure(); ++i) {
      Named& thing = things[random() % things.size()];
      // Often only translated, or only queried in another direction, so cached data is used again.
      if (random() % 3 == 0) thing.mesh.T_world_mesh = random_pose(random, {0, 0, 0.5}, {0.4, 0.4, 0.3});
      thing.mesh.T_world_mesh.pretranslate(0.05 * shapes::random_point(random));
      const Eigen::Vector3d direction =
          random() % 2 == 0 ? Eigen::Vector3d(0, 0, -1) : shapes::random_point(random);
      const double margin_m = random() % 4 == 0 ? 0.01 : 0.0;
      const JudgedScene& scene = random() % 2 == 0 ? ground : things_about;
      CyberRadar fresh({.mode = mode});
      const Contact a = scene.query(old, thing.mesh, direction, 0.7, margin_m);
      const Contact b = scene.query(fresh, thing.mesh, direction, 0.7, margin_m);
      const std::string text = thing.name + " query " + std::to_string(i) + ": " +
                               describe(thing.mesh, direction, 0.7, a, b.contact_distance_m);
      EXPECT_EQ(a.status, b.status) << text;
      EXPECT_NEAR(a.contact_distance_m, b.contact_distance_m, 1e-9) << text;
      EXPECT_NEAR(a.lower_m, b.lower_m, 1e-6) << text;  // float boxes: sampling may stop elsewhere
      EXPECT_TRUE(a.upper_m == b.upper_m || std::abs(a.upper_m - b.upper_m) < 1e-9) << text;
      EXPECT_EQ(a.touched, b.touched) << text;
    }
  }
}

TEST(RadarBounds, WhatIsThinnerThanAPixelIsMissedInNeitherBound) {
  const Mesh needle = shapes::box({0.0001F, 0.0001F, 0.5F}), sheet = shapes::box({0.5F, 0.00005F, 0.5F});
  Mesh edge_on;  // no thickness at all, in the plane y = 0
  shapes::add_quad(edge_on, {-0.25F, 0, -0.25F}, {0.25F, 0, -0.25F}, {0.25F, 0, 0.25F}, {-0.25F, 0, 0.25F});
  const Mesh box = shapes::box({0.4F, 0.3F, 0.2F}), ball = shapes::ball(0.15F, 20, 30);
  Radars radars;
  std::mt19937 random(31);
  for (const Mesh& thin : {needle, sheet, edge_on}) {
    for (const Mesh& thick : {box, ball}) {
      for (int i = 0; i < 25; ++i) {
        JudgedMesh object(thick, at(0, 0, 1));
        object.T_world_mesh.pretranslate(0.1 * shapes::random_point(random));
        JudgedScene scene;
        scene.add(thin);
        const Eigen::Vector3d hair = (i % 5) * 1e-7 * shapes::random_point(random);
        const Eigen::Vector3d down = Eigen::Vector3d(0, 0, -1) + Eigen::Vector3d(hair.x(), 0, 0);
        EXPECT_TRUE(radars.expect_right(object, down, 1.5, scene, "onto a thin thing"));
        JudgedMesh thin_object(thin, at(0, 0, 1));
        thin_object.T_world_mesh.pretranslate(0.1 * shapes::random_point(random));
        JudgedScene thick_scene;
        thick_scene.add(thick);
        EXPECT_TRUE(radars.expect_right(thin_object, down, 1.5, thick_scene, "a thin thing"));
        // Two crossed needles: only two edges touch.
        if (thin.vertices.size() == needle.vertices.size() && thin.triangles.size() > 2) {
          JudgedMesh across(shapes::box({0.5F, 0.0001F, 0.0001F}),
                            at(0.1 * shapes::random_point(random).x(), 0, 1));
          JudgedScene lying;
          lying.add(shapes::box({0.0001F, 0.5F, 0.0001F}), at(0, 0, 0.3));
          EXPECT_TRUE(radars.expect_right(across, down, 1.5, lying, "thin on thin"));
        }
        if (HasFailure()) return;
      }
    }
  }
}

}  // namespace
}  // namespace roomradar::radar_bounds_test
