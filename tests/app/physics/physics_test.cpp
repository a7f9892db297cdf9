// physics_test.cpp: bodies among planes and boxes with exactly known contacts.
#include "app/physics/physics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "app/physics/depenetration.hpp"
#include "mapping/types/system/error.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar::physics_test {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kFrame_s = 1.0 / 30.0;
constexpr double kHalf_m = 0.1;  // the body is a cube with this half side
struct Plane {
  Vec3 normal = Vec3::UnitZ();
  double offset_m = 0.0;
  SurfaceKind kind = SurfaceKind::kStatic;
};
struct Box {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  SurfaceKind kind = SurfaceKind::kStatic;
};

/// Planes and boxes for the radar, meshed again for each step.
struct Room {
  std::vector<Plane> planes;
  std::vector<Box> boxes;
  double noise_m = 0.0;  // uniform error of the surfaces along their normal, drawn per step
  mutable std::mt19937 random{7};
};

Mesh cube_mesh() { return shapes::box(Eigen::Vector3f::Constant(2.0F * static_cast<float>(kHalf_m))); }

Mesh mesh_of(const Plane& plane) {
  Mesh mesh;
  const Vec3 x = 20.0 * plane.normal.unitOrthogonal(), y = plane.normal.cross(x);
  mesh.origin = plane.offset_m * plane.normal;
  const auto corner = [](const Vec3& p) -> Eigen::Vector3f { return p.cast<float>(); };
  shapes::add_quad(mesh, corner(-x - y), corner(x - y), corner(x + y), corner(y - x));
  return mesh;
}
Mesh mesh_of(const Box& box) {
  Mesh mesh = shapes::box((box.high - box.low).cast<float>());
  mesh.origin = 0.5 * (box.low + box.high);
  return mesh;
}

/// The room's meshes for the radar, and a cube's collision queries on them.
class Surfaces {
 public:
  explicit Surfaces(const Room& room) : trees_(room.planes.size() + room.boxes.size()) {
    cube_.build_by_place(cube_mesh());
    std::size_t i = 0;
    std::uniform_real_distribution<double> noise(-room.noise_m, room.noise_m);
    const auto add = [&](Mesh mesh, SurfaceKind kind) {
      if (room.noise_m > 0.0) mesh.origin.z() += noise(room.random);
      trees_[i].build_by_place(mesh);
      scene_.push_back({{&trees_[i], Eigen::Isometry3d::Identity()}, kind});
      ++i;
    };
    for (const Plane& plane : room.planes) add(mesh_of(plane), plane.kind);
    for (const Box& box : room.boxes) add(mesh_of(box), box.kind);
    radar_scene_.trees = scene_;
  }
  CollisionQueries probe() { return make_collision_queries(radar_, cube_, radar_scene_); }

 private:
  CyberRadar radar_;
  TriangleTree cube_;
  std::vector<TriangleTree> trees_;
  std::vector<SceneTree> scene_;
  RadarScene radar_scene_;
};

StepReport step(Body& body, double dt_s, const Room& room, const PhysicsConfig& config,
                std::span<const Vec3> push = {}) {
  Surfaces surfaces(room);
  return advance(body, dt_s, surfaces.probe(), config, push);
}

Body body_at(const Vec3& centre) {
  Body body;
  body.name = "cube";
  body.T_world_object.translation() = centre;
  body.mass = mass_properties(cube_mesh(), true);
  return body;
}
double height(const Body& body) { return body.T_world_object.translation().z() - kHalf_m; }

StepReport run(Body& body, const Room& room, double seconds, const PhysicsConfig& config = {},
               double dt_s = kFrame_s) {
  StepReport last;
  for (double t = 0.0; t < seconds; t += dt_s) last = step(body, dt_s, room, config);
  return last;
}

const Room kFloor{.planes = {Plane{}}, .boxes = {}};

TEST(Physics, FallsWithGravityWhereNothingIs) {
  Body body = body_at({0, 0, 10});
  (void)run(body, Room{}, 1.0 - 1e-9, {}, 1e-3);
  EXPECT_NEAR(body.velocity_world_mps.z(), -9.81, 1e-6);
  // g dt / 2: first-order steps.
  EXPECT_NEAR(body.T_world_object.translation().z(), 10.0 - 9.81 / 2.0, 0.006);
  EXPECT_FALSE(body.asleep);
}

TEST(Physics, ComesToRestAMarginAboveTheFloor) {
  Body body = body_at({0.3, -0.2, 1.0});
  (void)run(body, kFloor, 2.0);
  EXPECT_TRUE(body.asleep);
  EXPECT_NEAR(height(body), PhysicsConfig{}.contact_margin_m, 1e-4);
  EXPECT_EQ(body.velocity_world_mps, Vec3::Zero());
  EXPECT_NEAR(body.T_world_object.translation().x(), 0.3, 1e-6);
}

TEST(Physics, DoesNotTunnelThroughAThinSheetAtTenMetresASecond) {
  const Room sheet{.planes = {}, .boxes = {{{-1, -1, 0}, {1, 1, 1e-4}}}};
  for (const double dt_s : {1e-3, 1.0 / 60.0, 1.0 / 30.0, 0.2, 10.0}) {
    Body body = body_at({0, 0, 1.234});
    body.velocity_world_mps = {0, 0, -10};
    for (int i = 0; i < 1200 && !body.asleep; ++i) (void)step(body, dt_s, sheet, {});
    EXPECT_TRUE(body.asleep) << dt_s;
    EXPECT_NEAR(height(body), 1e-4 + 0.001, 1e-4) << dt_s;
  }
}

TEST(Physics, SticksOnAGentleSlopeAndSlidesDownASteepOne) {
  const auto slope = [](double tilt_deg) {
    const double tilt = tilt_deg * M_PI / 180.0;
    return Room{.planes = {{Vec3(std::sin(tilt), 0, std::cos(tilt)), 0.0}}, .boxes = {}};
  };
  PhysicsConfig config;
  config.friction = std::tan(25.0 * M_PI / 180.0);
  Body gentle = body_at({0, 0, 0.3});
  (void)run(gentle, slope(20.0), 3.0, config);
  EXPECT_TRUE(gentle.asleep);
  Body steep = body_at({0, 0, 0.3});
  (void)run(steep, slope(35.0), 1.0, config);
  EXPECT_FALSE(steep.asleep);
  // After the fall it gains g (sin - mu cos) along the slope per second.
  const double before_mps = steep.velocity_world_mps.norm();
  (void)run(steep, slope(35.0), 0.5 - 1e-9, config);
  const double tilt = 35.0 * M_PI / 180.0;
  const double gain_mps2 = 9.81 * (std::sin(tilt) - config.friction * std::cos(tilt));
  EXPECT_NEAR(steep.velocity_world_mps.norm() - before_mps, gain_mps2 * 0.5, 0.02 * gain_mps2);
}

TEST(Physics, SlidesToAHaltWithinTheDistanceOfCoulombFriction) {
  PhysicsConfig config;
  config.friction = 0.4;
  Body body = body_at({0, 0, kHalf_m + 0.001});
  body.velocity_world_mps = {2, 0, 0};
  (void)run(body, kFloor, 2.0, config);
  EXPECT_TRUE(body.asleep);
  EXPECT_NEAR(body.T_world_object.translation().x(), 2.0 * 2.0 / (2.0 * 0.4 * 9.81), 0.05);  // v^2 / (2 mu g)
  EXPECT_NEAR(height(body), 0.001, 1e-4);
}

TEST(Physics, StopsAtAStepAndFallsOffATablesEdge) {
  const Room step{.planes = {Plane{}}, .boxes = {{{0.5, -1, 0}, {1, 1, 0.05}}}};
  Body body = body_at({0, 0, kHalf_m + 0.001});
  body.velocity_world_mps = {2.2, 0, 0};
  (void)run(body, step, 1.5);
  EXPECT_NEAR(body.T_world_object.translation().x(), 0.5 - kHalf_m, 0.0035);  // it tips up and rocks back
  EXPECT_GT(0.5 - kHalf_m, body.T_world_object.translation().x());

  const Room table{.planes = {Plane{}}, .boxes = {{{-1, -1, 0}, {0.3, 1, 0.7}}}};
  Body slider = body_at({0, 0, 0.7 + kHalf_m + 0.001});
  slider.velocity_world_mps = {4, 0, 0};
  (void)run(slider, table, 2.0);
  EXPECT_TRUE(slider.asleep);
  EXPECT_NEAR(height(slider), 0.001, 1e-4);
}

TEST(Physics, SettlesInACornerOfThreeWalls) {
  const Room corner{.planes = {Plane{}, {Vec3::UnitX(), 0.0}, {Vec3::UnitY(), 0.0}}, .boxes = {}};
  Body body = body_at({0.4, 0.5, 0.4});
  body.velocity_world_mps = {-3, -3, 1};
  (void)run(body, corner, 3.0);
  EXPECT_TRUE(body.asleep);
  EXPECT_GE((body.T_world_object.translation().array() - kHalf_m).minCoeff(), 0.0);
}

TEST(Physics, RestsInAValleyOfTwoSteepSlopes) {
  const double tilt = 50.0 * M_PI / 180.0;  // far beyond the angle of friction
  const Room valley{.planes = {{Vec3(std::sin(tilt), 0, std::cos(tilt)), 0.0},
                               {Vec3(-std::sin(tilt), 0, std::cos(tilt)), 0.0}},
                    .boxes = {}};
  Body body = body_at({0.2, 0, 0.8});
  (void)run(body, valley, 4.0);
  EXPECT_TRUE(body.asleep);
  EXPECT_NEAR(body.T_world_object.translation().x(), 0.0, 0.012);  // friction holds it beside the middle
}

TEST(Physics, SlidesAlongTheCreaseOfAValley) {
  const double tilt = 50.0 * M_PI / 180.0;
  const Room valley{.planes = {{Vec3(std::sin(tilt), 0, std::cos(tilt)), 0.0},
                               {Vec3(-std::sin(tilt), 0, std::cos(tilt)), 0.0}},
                    .boxes = {}};
  PhysicsConfig config;
  config.friction = 0.0;
  Body body = body_at({0, 0, 0.4});
  (void)run(body, valley, 1.0, config);
  body.asleep = false;
  body.velocity_world_mps = {0, 1, 0};
  const double from_y_m = body.T_world_object.translation().y();
  (void)run(body, valley, 1.0 - 1e-9, config);
  EXPECT_NEAR(body.T_world_object.translation().y() - from_y_m, 1.0, 0.02);
  EXPECT_NEAR(body.T_world_object.translation().x(), 0.0, 0.005);
}

TEST(Physics, BouncesByItsRestitutionThenRests) {
  PhysicsConfig config;
  config.restitution = 0.5;
  Body body = body_at({0, 0, kHalf_m + 1.0});
  double highest_after_m = 0.0;
  bool has_bounced = false;
  for (int i = 0; i < 3000; ++i) {
    (void)step(body, 1e-3, kFloor, config);
    has_bounced |= body.velocity_world_mps.z() > 0.0;
    if (has_bounced) highest_after_m = std::max(highest_after_m, height(body));
  }
  EXPECT_NEAR(highest_after_m, 0.25, 0.01);  // e^2 of the height
  EXPECT_TRUE(body.asleep);
}

TEST(Physics, ARestingBodyIgnoresNoiseOfSomeMillimetres) {
  Room noisy = kFloor;
  noisy.noise_m = 0.005;
  Body body = body_at({0, 0, 0.5});
  (void)run(body, noisy, 10.0);
  ASSERT_TRUE(body.asleep);
  const Vec3 before = body.T_world_object.translation();
  int wakes = 0;
  for (int i = 0; i < 600; ++i) wakes += step(body, kFrame_s, noisy, {}).woke;
  EXPECT_EQ(wakes, 0);
  EXPECT_EQ(before, body.T_world_object.translation());
  EXPECT_NEAR(height(body), 0.0, 0.010);
}

TEST(Physics, ARestingBodyStaysUntilItsSupportMovesByMoreThanNoise) {
  const PhysicsConfig config;
  for (const double moved_m : {0.007, -0.011, 0.011, -0.020}) {
    Room room = kFloor;
    Body body = body_at({0, 0, kHalf_m + 0.001});
    body.asleep = true;
    room.planes[0].offset_m = moved_m;
    const bool is_noise =
        moved_m - 0.001 < config.wake_overlap_m && 0.001 - moved_m < config.wake_gap_m + 0.001;
    EXPECT_EQ(step(body, kFrame_s, room, {}).woke, !is_noise) << moved_m;
    if (is_noise) {
      EXPECT_EQ(body.T_world_object.translation().z(), kHalf_m + 0.001);
    } else {
      (void)run(body, room, 1.0);
      EXPECT_NEAR(height(body), moved_m, 0.002);
    }
  }
}

TEST(Physics, FallsAgainWhenItsSupportIsTakenAway) {
  Room room{.planes = {Plane{}}, .boxes = {{{-0.5, -0.5, 0.4}, {0.5, 0.5, 0.5}, SurfaceKind::kDynamic}}};
  Body body = body_at({0, 0, 1.0});
  (void)run(body, room, 2.0);
  ASSERT_TRUE(body.asleep);
  EXPECT_NEAR(height(body), 0.501, 1e-4);
  room.boxes.clear();
  EXPECT_TRUE(step(body, kFrame_s, room, {}).woke);
  (void)run(body, room, 2.0);
  EXPECT_TRUE(body.asleep);
  EXPECT_NEAR(height(body), 0.001, 1e-4);
}

TEST(Physics, IsLiftedByAHandFromBelow) {
  Room room{.planes = {Plane{}}, .boxes = {}};
  Body body = body_at({0, 0, 0.3});
  (void)run(body, room, 1.5);
  ASSERT_TRUE(body.asleep);
  room.boxes = {{{-0.05, -0.05, -0.2}, {0.05, 0.05, 0.0}, SurfaceKind::kDynamic}};
  double worst_m = 0.0;
  for (int i = 0; i < 60; ++i) {  // 0.3 m/s upward
    room.boxes[0].high.z() += 0.01;
    const StepReport report = step(body, kFrame_s, room, {});
    worst_m = std::max(worst_m, room.boxes[0].high.z() - height(body));
    EXPECT_NE(report.status, StepStatus::kHeld);
  }
  EXPECT_NEAR(height(body), 0.6, 0.012);
  EXPECT_LT(worst_m, 0.012);
}

TEST(Physics, IsPushedAsideByAHandFromTheSide) {
  Room room{.planes = {Plane{}}, .boxes = {{{-0.9, -0.05, 0.05}, {-0.4, 0.05, 0.15}, SurfaceKind::kDynamic}}};
  Body body = body_at({0, 0, kHalf_m + 0.001});
  body.asleep = true;
  const Vec3 towards_hand = -Vec3::UnitX();
  bool was_touched = false;
  for (int i = 0; i < 60; ++i) {  // 0.3 m/s towards +x, from 0.3 m in front of to 0.3 m past the body's side
    room.boxes[0].low.x() += 0.01;
    room.boxes[0].high.x() += 0.01;
    const StepReport report = step(body, kFrame_s, room, {}, {&towards_hand, 1});
    was_touched |= report.contacts_by_kind[static_cast<std::size_t>(SurfaceKind::kDynamic)] > 0;
    EXPECT_GT(body.T_world_object.translation().x() - kHalf_m, room.boxes[0].high.x() - 0.009);
    EXPECT_NEAR(height(body), 0.001, 5e-4);  // the first push may tip it down to half of the margin
  }
  EXPECT_TRUE(was_touched);
  EXPECT_NEAR(body.T_world_object.translation().x() - kHalf_m, 0.2, 0.01);
}

TEST(Physics, APushedBodyStopsAtTheWallBehindIt) {
  Room room{.planes = {Plane{}, {-Vec3::UnitX(), -0.25}},
            .boxes = {{{-0.9, -0.05, 0.05}, {-0.15, 0.05, 0.15}, SurfaceKind::kDynamic}}};
  Body body = body_at({0, 0, kHalf_m + 0.001});
  const Vec3 towards_hand = -Vec3::UnitX();
  for (int i = 0; i < 25; ++i) {
    room.boxes[0].high.x() += 0.01;
    (void)step(body, kFrame_s, room, {}, {&towards_hand, 1});
    EXPECT_LE(body.T_world_object.translation().x() + kHalf_m, 0.25);
  }
  EXPECT_NEAR(body.T_world_object.translation().x() + kHalf_m, 0.25, 0.002);
}

TEST(Physics, LeavesAnOverlapNoFasterThanAllowed) {
  Body body = body_at({0, 0, kHalf_m - 0.02});  // placed 2 cm into the floor
  PhysicsConfig config;
  config.max_depenetration_mps = 0.15;  // 5 mm per frame
  const StepReport first = step(body, kFrame_s, kFloor, config);
  EXPECT_NEAR(first.deepest_static_overlap_m, 0.02, 1e-7);
  EXPECT_NEAR(height(body), -0.015, 1e-6);
  (void)run(body, kFloor, 1.0, config);
  EXPECT_NEAR(height(body), 0.0, config.contact_margin_m + 1e-4);
}

TEST(Physics, AWallThatGrazesTheSideDoesNotThrowTheBodyUp) {
  // 2 mm into a kerb of 2 cm height: along gravity the overlap is ten times deeper.
  const Room kerb{.planes = {Plane{}}, .boxes = {{{0.098, -1, 0}, {1, 1, 0.02}}}};
  Body body = body_at({0, 0, kHalf_m + 0.001});
  const StepReport report = step(body, kFrame_s, kerb, {});
  EXPECT_NEAR(report.deepest_overlap_m, 0.002, 1e-7);
  (void)run(body, kerb, 1.0);
  EXPECT_NEAR(height(body), 0.001, 1e-4);
  EXPECT_NEAR(body.T_world_object.translation().x(), -0.002, 0.002);
}

TEST(Physics, TheAnswerHardlyDependsOnTheStep) {
  const Room room{.planes = {Plane{}}, .boxes = {{{-0.3, -1, 0}, {0.3, 1, 0.7}}}};
  std::vector<Vec3> ends;
  for (const double dt_s : {1e-3, 1.0 / 120.0, 1.0 / 30.0, 1.0 / 10.0}) {
    Body body = body_at({0, 0, 1.2});
    body.velocity_world_mps = {0.5, 0.2, 0};
    (void)run(body, room, 4.0, {}, dt_s);
    EXPECT_TRUE(body.asleep);
    ends.push_back(body.T_world_object.translation());
  }
  for (const Vec3& end : ends) EXPECT_LT((end - ends[0]).norm(), 0.03);
}

TEST(Physics, ManyTinyStepsFallAndRestToo) {
  Body body = body_at({0, 0, kHalf_m + 0.001 + 1e-5});
  Surfaces surfaces(kFloor);
  const CollisionQueries probe = surfaces.probe();
  for (int i = 0; i < 350'000; ++i) (void)advance(body, 1e-6, probe, {});
  EXPECT_TRUE(body.asleep);
  EXPECT_NEAR(height(body), 0.001, 1e-4);
}

TEST(Physics, NoTimeChangesNothing) {
  Body body = body_at({0, 0, 1});
  body.velocity_world_mps = {1, 2, 3};
  const StepReport report = step(body, 0.0, kFloor, {});
  EXPECT_EQ(report.status, StepStatus::kMoved);
  EXPECT_EQ(report.queries, 0);
  EXPECT_EQ(body.T_world_object.translation(), Vec3(0, 0, 1));
  EXPECT_EQ(body.velocity_world_mps, Vec3(1, 2, 3));
}

TEST(Physics, AStalledCameraMovesTheBodyByHalfASecondAtMost) {
  Body body = body_at({0, 0, 100});
  (void)step(body, 10.0, Room{}, {});
  EXPECT_NEAR(body.velocity_world_mps.z(), -9.81 * 0.5, 1e-9);
}

TEST(Physics, TimeOrBodyThatIsNotFiniteIsRefusedUnchanged) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double dt_s : {nan, -0.1, std::numeric_limits<double>::infinity()}) {
    Body body = body_at({0, 0, 1});
    EXPECT_EQ(step(body, dt_s, kFloor, {}).status, StepStatus::kInvalid);
    EXPECT_EQ(body.T_world_object.translation(), Vec3(0, 0, 1));
  }
  Body broken = body_at({0, nan, 1});
  EXPECT_EQ(step(broken, kFrame_s, kFloor, {}).status, StepStatus::kInvalid);
}

TEST(Physics, HoldsStillAndSaysSoWhereTheRadarAnswersNonsense) {
  const auto nan_travel = [](const Eigen::Isometry3d&, const Vec3&, double) {
    Contact contact;
    contact.status = ContactStatus::kContact;
    contact.contact_distance_m = std::numeric_limits<double>::quiet_NaN();
    return contact;
  };
  const auto invalid = [](const Eigen::Isometry3d&, const Vec3&, double) { return Contact{}; };
  for (const DistanceQuery& query : {DistanceQuery(nan_travel), DistanceQuery(invalid)}) {
    Body body = body_at({0, 0, 1});
    body.velocity_world_mps = {1, 0, -1};
    EXPECT_EQ(advance(body, kFrame_s, {query, {}, {}}, {}).status, StepStatus::kHeld);
    EXPECT_EQ(body.T_world_object.translation(), Vec3(0, 0, 1));
    EXPECT_EQ(body.velocity_world_mps, Vec3::Zero());
  }
}

TEST(Physics, AnOverlapIsNotLeftIntoASurfaceThatAnotherOverlapHides) {
  // Unknown space overlaps the cube below and above. The ceiling comes after it, 2 mm above the cube.
  const auto overlap = [](const Eigen::Isometry3d&, const Vec3& direction, double) {
    Contact contact;
    contact.status = ContactStatus::kOverlap;
    contact.touched = SurfaceKind::kUnknownFrontier;
    contact.contact_distance_m = contact.lower_m = direction.z() < 0.0 ? -0.01 : -0.05;
    return contact;
  };
  bool has_ceiling = true;
  const auto near = [](const Eigen::Isometry3d&, double, SurfaceKindMask, const TreeStates&,
                       std::vector<ClosestPoint>& points) {
    points.clear();
    return bit_of(SurfaceKind::kUnknownFrontier);
  };
  const auto free_time = [&](const Eigen::Isometry3d& T_world_object, const RigidMotion& motion,
                             double duration_s, double, SurfaceKindMask left_out, const TreeStates&) {
    const bool is_in_the_way = has_ceiling && (left_out & bit_of(SurfaceKind::kStatic)) == 0;
    const double to_ceiling_s = (1.002 - T_world_object.translation().z()) / motion.linear_m_s.z();
    return FreeTime{is_in_the_way ? std::min(to_ceiling_s, duration_s) : duration_s, {}};
  };
  for (const bool with_ceiling : {true, false}) {
    has_ceiling = with_ceiling;
    Body body = body_at({0, 0, 1});
    (void)advance(body, kFrame_s, {overlap, near, free_time}, {});
    if (with_ceiling)
      EXPECT_LE(body.T_world_object.translation().z(), 1.002);
    else
      EXPECT_GT(body.T_world_object.translation().z(), 1.005);
  }
}

TEST(Physics, AVelocityWakesABodyAtRest) {
  Body body = body_at({0, 0, kHalf_m + 0.001});
  body.asleep = true;
  body.velocity_world_mps = {1, 0, 2};
  EXPECT_TRUE(step(body, kFrame_s, kFloor, {}).woke);
  EXPECT_GT(height(body), 0.03);
}

TEST(Physics, WithoutGravityABodyDrifts) {
  PhysicsConfig config;
  config.gravity_world_mps2.setZero();
  Body body = body_at({0, 0, 1});
  body.velocity_world_mps = {1, 0, 0};
  (void)run(body, kFloor, 1.0 - 1e-9, config, 0.01);
  EXPECT_NEAR(body.T_world_object.translation().x(), 1.0, 1e-9);
}

TEST(Physics, RandomThrowsIntoARoomNeverLeaveIt) {
  const Room room{.planes = {Plane{},
                             {Vec3::UnitX(), -1},
                             {-Vec3::UnitX(), -1},
                             {Vec3::UnitY(), -1},
                             {-Vec3::UnitY(), -1},
                             {-Vec3::UnitZ(), -2.5}},
                  .boxes = {{{-0.5, -0.4, 0.68}, {0.5, 0.4, 0.70}}}};
  std::mt19937 random(11);
  std::uniform_real_distribution<double> speed(-10.0, 10.0);
  PhysicsConfig config;
  config.restitution = 0.3;
  for (int i = 0; i < 200; ++i) {
    Body body = body_at({0, 0, 1.5});
    body.velocity_world_mps = {speed(random), speed(random), speed(random)};
    for (int frame = 0; frame < 240; ++frame) {
      const StepReport report = step(body, kFrame_s, room, config);
      ASSERT_LT(report.deepest_overlap_m, 1e-3);
      const Vec3 p = body.T_world_object.translation();
      ASSERT_LE(p.head<2>().cwiseAbs().maxCoeff(), 1.0 - kHalf_m + 1e-6);
      ASSERT_GE(p.z(), kHalf_m - 1e-6);
      ASSERT_LE(p.z(), 2.5 - kHalf_m + 1e-6);
    }
    EXPECT_TRUE(body.asleep) << i;
  }
}

TEST(PushDirections, PointFromTheBodyToWhatMovesNearIt) {
  Mesh hand;
  hand.origin = {10, 0, 0};
  hand.vertices = {{0.3F, 0, 0.1F}, {0.35F, 0.02F, 0.1F}, {2, 0, 0}, {std::nanf(""), 0, 0}};
  const PushDirections found = depenetration_directions({&hand}, {10, 0, 0}, 0.5);
  ASSERT_EQ(found.count, 1);
  EXPECT_NEAR(found.direction_world[0].dot(Vec3::UnitX()), 1.0, 1e-9);
  EXPECT_EQ(depenetration_directions({&hand}, {10, 0, 0}, 0.1).count, 0);
  EXPECT_EQ(depenetration_directions({}, {0, 0, 0}, 1.0).count, 0);
  hand.vertices = {{0, 0, 0.3F}};  // straight above
  EXPECT_EQ(depenetration_directions({&hand}, {10, 0, 0}, 0.5).count, 0);
}

TEST(PhysicsConfig, NamesTheFieldThatIsWrong) {
  EXPECT_NO_THROW(require_valid(PhysicsConfig{}));
  PhysicsConfig config;
  config.friction = -1.0;
  try {
    require_valid(config);
    FAIL() << "a negative friction was taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("physics.friction"), std::string::npos);
  }
  config = {};
  config.max_step_s = std::nan("");
  EXPECT_THROW(require_valid(config), Error);
}

}  // namespace
}  // namespace roomradar::physics_test
