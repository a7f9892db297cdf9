// rigid_body_test.cpp: laws of mechanics, for a ball with exact contacts and for meshes with the radar.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <vector>

#include "app/physics/physics.hpp"
#include "app/physics/rigid_motion.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar::rigid_body_test {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kFrame_s = 1.0 / 30.0;
constexpr double kG = 9.81;

/// A round ball above a plane through the origin, with exact contacts.
struct BallOverPlane {
  double radius_m = 0.05;
  Vec3 normal = Vec3::UnitZ();

  [[nodiscard]] double gap_m(const Vec3& centre) const { return normal.dot(centre) - radius_m; }
  [[nodiscard]] CollisionQueries probe() const {
    CollisionQueries probe;
    probe.travel = [this](const Eigen::Isometry3d& T, const Vec3& direction, double distance_m) {
      Contact contact;
      contact.status = ContactStatus::kNoTarget;
      contact.lower_m = distance_m;
      const double closing = -normal.dot(direction);
      const double contact_distance_m = gap_m(T.translation()) / closing;
      if (closing < 1e-9 || contact_distance_m > distance_m) return contact;
      contact.status = contact_distance_m < 0.0 ? ContactStatus::kOverlap : ContactStatus::kContact;
      contact.contact_distance_m = contact.lower_m = contact.upper_m = contact_distance_m;
      contact.normal_world = normal;
      contact.touched = SurfaceKind::kStatic;
      return contact;
    };
    probe.near = [this](const Eigen::Isometry3d& T, double reach_m, SurfaceKindMask, const TreeStates&,
                        std::vector<ClosestPoint>& points) {
      points.clear();
      const double gap = gap_m(T.translation());
      if (gap > 0.0 && gap <= reach_m)
        points.push_back({T.translation() - (radius_m + gap) * normal, normal, gap, SurfaceKind::kStatic});
      return SurfaceKindMask{0};
    };
    probe.free_time = [this](const Eigen::Isometry3d& T, const RigidMotion& motion, double duration_s,
                             double keep_m, SurfaceKindMask, const TreeStates&) {
      const double closing_mps = -normal.dot(motion.linear_m_s);
      const double gap = gap_m(T.translation());
      const double allowed_m = gap > 2.0 * keep_m ? gap - keep_m : 0.5 * gap;
      FreeTime free;
      free.free_s = closing_mps > 0.0 ? std::min(duration_s, allowed_m / closing_mps) : duration_s;
      return free;
    };
    return probe;
  }
};

Body ball_at(const Vec3& centre, double radius_m = 0.05) {
  Body body;
  body.mass.radius_m = radius_m;
  body.mass.inertia_m2 = 0.4 * radius_m * radius_m * Eigen::Matrix3d::Identity();
  body.T_world_object.translation() = centre;
  return body;
}

/// Static meshes, and one that moves among them.
class Stage {
 public:
  explicit Stage(const Mesh& object) {
    object_.build_by_place(object);
    mass = mass_properties(object, object_.is_closed());
  }
  void add(const Mesh& mesh, SurfaceKind kind = SurfaceKind::kStatic) {
    trees_.emplace_back().build_by_place(mesh);
    kinds_.push_back(kind);
  }
  void replace(std::size_t which, const Mesh& mesh) { trees_[which].build_by_place(mesh); }
  void clear() {
    trees_.clear();
    kinds_.clear();
  }
  [[nodiscard]] Body body_at(const Vec3& centre) const {
    Body body;
    body.mass = mass;
    body.T_world_object.translation() = centre;
    return body;
  }
  StepReport step(Body& body, double dt_s = kFrame_s, const PhysicsConfig& config = {},
                  std::span<const Vec3> push = {}, std::span<const SceneTree> others = {}) {
    std::vector<SceneTree> scene(others.begin(), others.end());
    for (std::size_t i = 0; i < trees_.size(); ++i)
      scene.push_back({{&trees_[i], Eigen::Isometry3d::Identity()}, kinds_[i]});
    const RadarScene radar_scene{scene, {}};
    return advance(body, dt_s, make_collision_queries(radar_, object_, radar_scene), config, push);
  }
  void run(Body& body, double seconds, const PhysicsConfig& config = {}) {
    for (double t = 0.0; t < seconds - 1e-9; t += kFrame_s) (void)step(body, kFrame_s, config);
  }
  [[nodiscard]] const TriangleTree& object() const { return object_; }

  MassProperties mass;

 private:
  TriangleTree object_;
  std::vector<TriangleTree> trees_;
  std::vector<SurfaceKind> kinds_;
  CyberRadar radar_;
};

Mesh moved(Mesh mesh, const Vec3& by) {
  mesh.origin += by;
  return mesh;
}
Mesh box(double x, double y, double z) { return shapes::box(Vec3(x, y, z).cast<float>()); }
/// Cosine of the angle between the vertical and the body's nearest axis; 1 if the body lies on a face.
double on_a_face(const Body& body) {
  return (body.T_world_object.linear().transpose() * Vec3::UnitZ()).cwiseAbs().maxCoeff();
}

TEST(MassProperties, OfABoxAndOfItsShell) {
  const Vec3 size(0.2, 0.3, 0.5);
  Mesh mesh = moved(shapes::box(size.cast<float>()), {3, -2, 1});
  const MassProperties solid = mass_properties(mesh, true);
  EXPECT_LT((solid.centre_object - Vec3(3, -2, 1)).norm(), 1e-7);
  const Vec3 squares = size.cwiseAbs2() / 12.0;
  const Vec3 moments(squares.y() + squares.z(), squares.x() + squares.z(), squares.x() + squares.y());
  EXPECT_LT((solid.inertia_m2 - Eigen::Matrix3d(moments.asDiagonal())).norm(), 1e-8);
  EXPECT_NEAR(solid.radius_m, 0.5 * size.norm(), 1e-7);
  // A cube's shell of side a: 5/18 a^2 about each axis.
  const MassProperties shell = mass_properties(box(1, 1, 1), false);
  EXPECT_LT((shell.inertia_m2 - 5.0 / 18.0 * Eigen::Matrix3d::Identity()).norm(), 1e-7);
}

TEST(MassProperties, OfWhatHasNoVolumeNoAreaOrNoTriangleCanBeTurned) {
  Mesh line;
  line.vertices = {{-0.5F, 0, 0}, {0.5F, 0, 0}, {std::nanf(""), 0, 0}};
  line.triangles = {{0, 1, 1}, {0, 1, 2}, {0, 1, 7}};
  for (const Mesh& mesh : {line, Mesh{}, shapes::floor(0.5F, 0.0F)}) {
    const MassProperties mass = mass_properties(mesh, false);
    EXPECT_TRUE(mass.inertia_m2.allFinite() && mass.centre_object.allFinite());
    EXPECT_GT(mass.inertia_m2.determinant(), 0.0);
    EXPECT_GT(mass.inertia_m2.inverse().diagonal().minCoeff(), 0.0);
  }
}

TEST(RigidBody, FallsAlongAnExactParabolaWhateverTheStep) {
  const BallOverPlane far{.radius_m = 0.05, .normal = Vec3::UnitZ()};
  for (const double dt_s : {1e-3, 1.0 / 60.0, 1.0 / 30.0, 0.1, 0.5}) {
    Body body = ball_at({0, 0, 100});
    body.velocity_world_mps = {1, 2, 3};
    double t = 0.0;
    for (; t < 1.0 - 1e-9; t += dt_s) (void)advance(body, dt_s, far.probe(), {});
    const Vec3 expected = Vec3(0, 0, 100) + t * Vec3(1, 2, 3) - 0.5 * kG * t * t * Vec3::UnitZ();
    EXPECT_LT((body.T_world_object.translation() - expected).norm(), 1e-9) << dt_s;
  }
}

TEST(RigidBody, BouncesToTheSquareOfItsRestitution) {
  PhysicsConfig config;
  config.restitution = 0.7;
  const BallOverPlane scene;
  for (const double dt_s : {1e-3, 1.0 / 60.0, 1.0 / 30.0}) {
    Body body = ball_at({0, 0, 1.05});
    bool has_bounced = false;
    double highest_m = 0.0;
    for (double t = 0.0; t < 1.0; t += dt_s) {
      (void)advance(body, dt_s, scene.probe(), config);
      has_bounced |= body.velocity_world_mps.z() > 0.5;
      if (has_bounced) highest_m = std::max(highest_m, body.T_world_object.translation().z() - 0.05);
    }
    EXPECT_NEAR(highest_m, 0.49, 0.006) << dt_s;  // frames miss the highest point by up to 1.4 mm
    EXPECT_LE(highest_m, 0.4905) << dt_s;
  }
}

TEST(RigidBody, SlidesAsFarAsFrictionLetsIt) {
  Stage stage(box(0.2, 0.2, 0.1));
  stage.add(shapes::floor(10.0F, 0.0F));
  PhysicsConfig config;
  config.friction = 0.3;
  Body body = stage.body_at({0, 0, 0.051});
  body.velocity_world_mps = {1.5, 0, 0};
  stage.run(body, 2.0, config);
  EXPECT_TRUE(body.asleep);
  EXPECT_NEAR(body.T_world_object.translation().x(), 1.5 * 1.5 / (2.0 * 0.3 * kG), 0.004);
  EXPECT_NEAR(on_a_face(body), 1.0, 1e-6);
}

TEST(RigidBody, WhatHasRestedSlidesAsFarAsAnyOther) {
  Stage stage(box(0.2, 0.2, 0.1));
  stage.add(shapes::floor(10.0F, 0.0F));
  PhysicsConfig config;
  config.friction = 0.3;
  Body body = stage.body_at({0, 0, 0.051});
  stage.run(body, 2.0, config);
  ASSERT_TRUE(body.asleep);
  const double from_m = body.T_world_object.translation().x();
  body.asleep = false;  // as after a throw
  body.velocity_world_mps = {0.6, 0, 0};
  stage.run(body, 2.0, config);
  EXPECT_NEAR(body.T_world_object.translation().x() - from_m, 0.6 * 0.6 / (2.0 * 0.3 * kG), 0.004);
}

TEST(RigidBody, ABallRollsDownASlopeAtFiveSevenths) {
  const double tilt = 10.0 * std::numbers::pi / 180.0;
  const BallOverPlane slope{.radius_m = 0.05, .normal = Vec3(std::sin(tilt), 0, std::cos(tilt))};
  PhysicsConfig config;
  config.rolling = 0.0;
  Body body = ball_at(0.0510 * slope.normal);
  double t = 0.0;
  for (; t < 1.0 - 1e-9; t += kFrame_s) (void)advance(body, kFrame_s, slope.probe(), config);
  const double acceleration = 5.0 / 7.0 * kG * std::sin(tilt);
  EXPECT_NEAR(body.velocity_world_mps.norm(), acceleration * t, 0.002 * acceleration * t);
  EXPECT_NEAR((body.T_world_object.translation() - 0.0510 * slope.normal).norm(), 0.5 * acceleration * t * t,
              0.005 * acceleration);
  // It rolls: the velocity at the contact point is zero.
  EXPECT_NEAR(body.angular_velocity_world_rad_s.norm() * 0.0510, body.velocity_world_mps.norm(),
              0.03 * acceleration);
}

TEST(RigidBody, AMeshBallRollsDownASlopeAndComesToRestOnTheFloor) {
  Mesh ball;
  {  // 6 x 16 x 16 squares on a sphere
    constexpr int kN = 16;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        const auto at = [&](int i, int j) -> Eigen::Vector3f {
          Vec3 p;
          p[axis] = side;
          p[(axis + 1) % 3] = std::tan(std::numbers::pi / 4.0 * (2.0 * i / kN - 1.0));
          p[(axis + 2) % 3] = side * std::tan(std::numbers::pi / 4.0 * (2.0 * j / kN - 1.0));
          return (0.06 * p.normalized()).cast<float>();
        };
        for (int i = 0; i < kN; ++i)
          for (int j = 0; j < kN; ++j)
            shapes::add_quad(ball, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
    }
  }
  Stage stage(ball);
  ASSERT_TRUE(stage.object().is_closed());
  Mesh ramp;  // descends from x = -1 at 12 degrees to the floor at x = 0
  const float rise = std::tan(12.0F * std::numbers::pi_v<float> / 180.0F);
  shapes::add_quad(ramp, {-1, -1, rise}, {0, -1, 0}, {0, 1, 0}, {-1, 1, rise});
  stage.add(ramp);
  stage.add(shapes::floor(20.0F, 0.0F));
  Body body = stage.body_at({-0.8, 0, 0.8 * static_cast<double>(rise) + 0.065});
  double fastest_mps = 0.0;
  for (int i = 0; i < 600 && !body.asleep; ++i) {
    (void)stage.step(body);
    fastest_mps = std::max(fastest_mps, body.velocity_world_mps.norm());
  }
  EXPECT_TRUE(body.asleep);
  const double without_loss_mps = std::sqrt(10.0 / 7.0 * kG * 0.8 * static_cast<double>(rise));
  EXPECT_GT(fastest_mps, 0.8 * without_loss_mps);
  EXPECT_LT(fastest_mps, without_loss_mps);
  EXPECT_GT(body.T_world_object.translation().x(), 0.5);
  EXPECT_NEAR(body.T_world_object.translation().z(), 0.06, 0.002);
}

TEST(RigidBody, WhatTurnsFreelyKeepsItsAngularMomentum) {
  Body body;
  body.mass = mass_properties(box(0.1, 0.2, 0.4), true);
  body.angular_velocity_world_rad_s = {0.3, 8.0, 0.2};  // about the middle axis: it tumbles
  const BallOverPlane far_below;
  const CollisionQueries nothing = far_below.probe();
  body.T_world_object.translation() = Vec3(0, 0, 100);
  PhysicsConfig config;
  config.gravity_world_mps2.setZero();
  const auto momentum = [&]() -> Vec3 { return inertia_world_m2(body) * body.angular_velocity_world_rad_s; };
  const Vec3 before = momentum();
  double least_along_y = 1.0;
  for (int i = 0; i < 3000; ++i) {
    (void)advance(body, 1e-3, nothing, config);
    least_along_y = std::min(least_along_y, body.T_world_object.linear()(1, 1));
  }
  EXPECT_LT((momentum() - before).norm(), 1e-9 * before.norm());
  EXPECT_LT(least_along_y, -0.8);  // it turned over
  const double turning = body.angular_velocity_world_rad_s.dot(momentum());
  EXPECT_NEAR(turning, Vec3(0.3, 8.0, 0.2).dot(before), 1e-9 * turning);  // twice the energy
}

TEST(RigidBody, ItsAxesStayAtRightAnglesThroughAMillionSteps) {
  Body body = ball_at({0, 0, 1e6});
  body.mass = mass_properties(box(0.1, 0.2, 0.4), true);
  body.angular_velocity_world_rad_s = {1, 2, 3};
  const BallOverPlane far_below;
  const CollisionQueries nothing = far_below.probe();
  PhysicsConfig config;
  config.gravity_world_mps2.setZero();
  for (int i = 0; i < 1'000'000; ++i) (void)advance(body, 1e-3, nothing, config);
  const Eigen::Matrix3d R = body.T_world_object.linear();
  EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_NEAR(R.determinant(), 1.0, 1e-12);
}

TEST(RigidBody, ATiltedCubeFallsOntoAFaceAndRestsThere) {
  Stage stage(box(0.2, 0.2, 0.2));
  stage.add(shapes::floor(5.0F, 0.0F));
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(1, 2, 0.5), Vec3(-0.2, 1, 3)}) {
    Body body = stage.body_at({0, 0, 0.4});
    body.T_world_object.rotate(Eigen::AngleAxisd(0.6, axis.normalized()));
    stage.run(body, 3.0);
    EXPECT_TRUE(body.asleep);
    EXPECT_NEAR(on_a_face(body), 1.0, 1e-4);
    EXPECT_NEAR(body.T_world_object.translation().z(), 0.101, 2e-4);
  }
}

TEST(RigidBody, WhatStandsMoreThanHalfOverAnEdgeTipsOverIt) {
  Stage stage(box(0.2, 0.2, 0.2));
  stage.add(moved(box(1, 1, 0.5), {-0.5, 0, 0.25}));  // the edge is at x = 0
  stage.add(shapes::floor(5.0F, 0.0F));
  Body stays = stage.body_at({-0.02, 0, 0.601});
  stage.run(stays, 2.0);
  EXPECT_TRUE(stays.asleep);
  EXPECT_NEAR(stays.T_world_object.translation().x(), -0.02, 1e-3);
  Body tips = stage.body_at({0.02, 0, 0.601});
  double most_turned = 0.0;
  for (int i = 0; i < 90; ++i) {
    (void)stage.step(tips);
    most_turned = std::max(most_turned, std::abs(tips.T_world_object.linear()(0, 2)));
  }
  EXPECT_TRUE(tips.asleep);
  EXPECT_GT(most_turned, 0.5);
  EXPECT_NEAR(on_a_face(tips), 1.0, 1e-4);
  EXPECT_NEAR(tips.T_world_object.translation().z(), 0.101, 1e-3);
}

TEST(RigidBody, TheEdgeOfWhatIsMetFromOneSideHoldsAsAnyOther) {
  for (const SurfaceKind kind : {SurfaceKind::kStatic, SurfaceKind::kUnknownFrontier}) {
    Stage stage(shapes::box({0.3F, 0.3F, 0.3F}));
    stage.add(shapes::box({1.0F, 1.0F, 1.0F}), kind);
    // Tips over the edge of its top.
    Body body = stage.body_at({0.52, 0.0, 0.652});
    double deepest_m = 0.0;
    for (int frame = 0; frame < 20; ++frame)
      deepest_m = std::max(deepest_m, stage.step(body).deepest_overlap_m);
    EXPECT_GT(Eigen::AngleAxisd(body.T_world_object.linear()).angle(), 0.3) << static_cast<int>(kind);
    EXPECT_EQ(deepest_m, 0.0) << static_cast<int>(kind);
    // Thrown flat against an upright edge.
    body = stage.body_at({0.9, 0.9, 0.0});
    body.T_world_object.rotate(Eigen::AngleAxisd(M_PI / 4.0, Vec3::UnitZ()));
    body.velocity_world_mps = {-4.0, -4.0, 0.0};
    PhysicsConfig weightless;
    weightless.gravity_world_mps2.setZero();
    for (int frame = 0; frame < 10; ++frame) {
      (void)stage.step(body, kFrame_s, weightless);
      EXPECT_GT(body.T_world_object.translation().dot(Vec3(1, 1, 0).normalized()), std::sqrt(0.5) + 0.15)
          << static_cast<int>(kind) << ' ' << frame;
    }
  }
}

TEST(RigidBody, PushedHighATallBoxTipsPushedLowItSlides) {
  const auto hand = [](double x_m, double z_m) {
    Mesh mesh;  // a small upright sheet that faces +x
    const auto at = [&](double y, double z) { return Vec3(x_m, y, z_m + z).cast<float>().eval(); };
    shapes::add_quad(mesh, at(-0.03, -0.02), at(0.03, -0.02), at(0.03, 0.02), at(-0.03, 0.02));
    return mesh;
  };
  for (const bool is_high : {true, false}) {
    Stage stage(box(0.1, 0.1, 0.4));
    const double z_m = is_high ? 0.35 : 0.05;
    stage.add(shapes::floor(5.0F, 0.0F));
    stage.add(hand(-0.2, z_m), SurfaceKind::kDynamic);
    Body body = stage.body_at({0, 0, 0.201});
    const Vec3 towards_hand = -Vec3::UnitX();
    for (int i = 0; i < 120; ++i) {
      const double x_m = -0.1 + std::min(0.005 * i, 0.25);  // 0.15 m/s, then it stops
      stage.replace(1, hand(x_m, z_m));
      (void)stage.step(body, kFrame_s, {}, {&towards_hand, 1});
    }
    const double upright = body.T_world_object.linear()(2, 2);
    if (is_high) {
      EXPECT_LT(std::abs(upright), 0.1);
      EXPECT_GT(body.T_world_object.translation().x(), 0.1);
    } else {
      EXPECT_NEAR(upright, 1.0, 1e-3);
      EXPECT_NEAR(body.T_world_object.translation().x(), 0.15 + 0.05, 0.02);
    }
  }
}

TEST(RigidBody, TwoBoxesStandOnEachOtherInWhicheverOrderTheyAreMoved) {
  for (const bool upper_first : {false, true}) {
    Stage stage(box(0.2, 0.2, 0.2));
    stage.add(shapes::floor(5.0F, 0.0F));
    Body lower = stage.body_at({0, 0, 0.15}), upper = stage.body_at({0.03, 0.02, 0.42});
    for (int i = 0; i < 90; ++i) {
      for (const bool is_upper : {upper_first, !upper_first}) {
        Body& body = is_upper ? upper : lower;
        const Body& other = is_upper ? lower : upper;
        const SceneTree tree{{&stage.object(), other.T_world_object}, SurfaceKind::kObject};
        (void)stage.step(body, kFrame_s, {}, {}, {&tree, 1});
      }
    }
    EXPECT_TRUE(lower.asleep);
    EXPECT_TRUE(upper.asleep);
    EXPECT_NEAR(lower.T_world_object.translation().z(), 0.101, 1e-3);
    EXPECT_NEAR(upper.T_world_object.translation().z(), 0.302, 2e-3);
    EXPECT_LT((upper.T_world_object.translation().head<2>() - Eigen::Vector2d(0.03, 0.02)).norm(), 2e-3);
    EXPECT_GT(on_a_face(upper), 0.99999);
  }
}

TEST(RigidBody, ExtremeSizesAndStepsStayFinite) {
  for (const Mesh& mesh :
       {box(0.002, 0.002, 0.2), box(3, 0.5, 0.5), box(0.4, 0.4, 0.0005), box(0.001, 0.001, 0.001)}) {
    for (const double dt_s : {0.0, 1e-6, 1.0 / 30.0, 0.5, 10.0}) {
      Stage stage(mesh);
      stage.add(shapes::floor(20.0F, 0.0F));
      Body body = stage.body_at({0, 0, 1.0 + stage.mass.radius_m});
      body.T_world_object.rotate(Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()));
      body.velocity_world_mps = {3, -2, -8};
      body.angular_velocity_world_rad_s = {1e4, -300, 20};
      for (int i = 0; i < 40; ++i) {
        (void)stage.step(body, dt_s);
        ASSERT_TRUE(body.T_world_object.matrix().allFinite());
        ASSERT_TRUE(body.velocity_world_mps.allFinite() && body.angular_velocity_world_rad_s.allFinite());
        ASSERT_GT(body.T_world_object.translation().z(), 0.0);
      }
      if (dt_s > 0.0) {
        EXPECT_LE(body.angular_velocity_world_rad_s.norm(), PhysicsConfig{}.max_angular_rad_s * (1.0 + 1e-9));
      }
    }
  }
}

TEST(RigidBody, AThinSheetIsNotPassedByTurning) {
  // A rod rotates about its centre beside a sheet without thickness: for any time step it stays on its side.
  Mesh sheet;
  shapes::add_quad(sheet, {0.3F, -2, -2}, {0.3F, 2, -2}, {0.3F, 2, 2}, {0.3F, -2, 2});
  PhysicsConfig config;
  config.gravity_world_mps2.setZero();
  for (const double dt_s : {1e-3, kFrame_s, 0.5}) {
    Stage stage(box(1.0, 0.002, 0.002));
    stage.add(sheet);
    Body body = stage.body_at({0, 0, 0});
    body.T_world_object.rotate(Eigen::AngleAxisd(std::numbers::pi / 2.0, Vec3::UnitY()));
    body.angular_velocity_world_rad_s = {0, 50, 0};
    for (int i = 0; i < 60; ++i) {
      (void)stage.step(body, dt_s, config);
      for (const double end : {-0.5, 0.5})
        ASSERT_LT((body.T_world_object * Vec3(end, 0, 0)).x(), 0.3) << dt_s;
    }
  }
}

TEST(RigidBody, SetExactlyOnAFaceItStaysThereAndIsLiftedToItsMargin) {
  for (const bool is_turned : {false, true}) {
    Stage stage(shapes::box({0.1F, 0.1F, 0.1F}));
    stage.add(shapes::floor(1.0F, 0.0F));
    const double half_m = static_cast<double>(0.5F * 0.1F);
    Body body = stage.body_at({0.0, 0.0, half_m});
    if (is_turned) body.T_world_object.rotate(Eigen::AngleAxisd(0.4, Vec3::UnitZ()));
    for (int frame = 0; frame < 15; ++frame) {
      (void)stage.step(body);
      EXPECT_GE(body.T_world_object.translation().z() - half_m, 0.0) << frame;
    }
    EXPECT_NEAR(body.T_world_object.translation().z() - half_m, 0.001, 0.0002);
    EXPECT_LT(body.T_world_object.translation().head<2>().norm(), 1e-6);
    EXPECT_TRUE(body.asleep);
  }
}

TEST(RigidBody, ASheetSetExactlyOnAFloorDoesNotFallThroughIt) {
  Stage stage(shapes::floor(0.25F, 0.0F));
  stage.add(shapes::floor(1.0F, 0.0F));
  Body body = stage.body_at(Vec3::Zero());
  for (int frame = 0; frame < 15; ++frame) {
    (void)stage.step(body);
    EXPECT_GE(body.T_world_object.translation().z(), 0.0) << frame;
  }
  EXPECT_LT(body.T_world_object.translation().norm(), 0.0015);
}

}  // namespace
}  // namespace roomradar::rigid_body_test
