// time_of_impact_test.cpp: moving and rotating objects against closed forms and against the exact reference,
// pose by pose.
//
// ROOMRADAR_LONG_TESTS=1 makes 25 times as many random sweeps.
#include "radar/motion/time_of_impact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <limits>
#include <string>
#include <vector>

#include "tests/radar/judged_scene.hpp"
#include "tests/radar/shapes.hpp"
#include "tests/support/exact_clearance.hpp"

namespace roomradar::time_of_impact_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Eigen::Vector3d kStill(0, 0, 0);

Eigen::Isometry3d at(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

/// One object and one scene mesh.
struct Stage {
  JudgedMesh object;
  JudgedMesh scene;
  RadarConfig radar = {};

  TimeOfImpact sweep_for(const RigidMotion& motion, double duration_s,
                         const TimeOfImpactConfig& config = {}) const {
    CyberRadar cyber_radar(radar);
    const SceneTree tree{{&scene.tree, scene.T_world_mesh}, SurfaceKind::kStatic};
    return time_of_impact(cyber_radar, {&object.tree, object.T_world_mesh}, motion, duration_s,
                          {{&tree, 1}, {}}, config);
  }
  double clearance_m(const RigidMotion& motion, double time_s, double at_most_m = kInfinity) const {
    return exact_clearance(object.mesh, pose_after(object.T_world_mesh, motion, time_s), scene.mesh,
                           scene.T_world_mesh, at_most_m);
  }
};

TEST(ContactTime, IsTravelOverSpeed) {
  Contact contact;
  contact.status = ContactStatus::kContact;
  contact.lower_m = 1.0;
  contact.upper_m = 1.5;
  EXPECT_EQ(contact_time(contact, 2.0).lower_s, 0.5);
  EXPECT_EQ(contact_time(contact, 2.0).upper_s, 0.75);
  EXPECT_EQ(contact_time(contact, 0.0).lower_s, kInfinity);
  contact.status = ContactStatus::kNoTarget;
  contact.upper_m = kInfinity;
  EXPECT_EQ(contact_time(contact, 2.0).lower_s, 0.5);
  EXPECT_EQ(contact_time(contact, 2.0).upper_s, kInfinity);
  contact.status = ContactStatus::kOverlap;
  EXPECT_EQ(contact_time(contact, 2.0).upper_s, 0.0);
  EXPECT_EQ(contact_time({}, 2.0).lower_s, 0.0);  // nothing is known to be free
  EXPECT_EQ(contact_time({}, 2.0).upper_s, kInfinity);
}

TEST(PoseAfter, TurnsAboutTheCentreThatGoesStraight) {
  const RigidMotion motion{
      .linear_m_s = {1, 2, 3}, .angular_rad_s = {0, 0, M_PI}, .centre_object = {1, 0, 0}};
  const Eigen::Isometry3d T = pose_after(at(0, 0, 0), motion, 0.5);  // a quarter turn about (1, 0, 0)
  EXPECT_TRUE((T * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1.5, 1, 1.5), 1e-15));
  EXPECT_TRUE((T * Eigen::Vector3d(2, 0, 0)).isApprox(Eigen::Vector3d(1.5, 2, 1.5), 1e-15));
  const Eigen::Isometry3d T_still = pose_after(at(4, 5, 6), {}, 1e9);
  EXPECT_TRUE(T_still.isApprox(at(4, 5, 6), 0.0));
}

TEST(Sweep, FallsForTheTimeOfItsClearance) {
  const Stage stage{JudgedMesh(shapes::box({0.25F, 0.25F, 0.25F}), at(0, 0, 1)),
                    JudgedMesh(shapes::floor(1.0F, 0.0F))};
  const TimeOfImpact hit = stage.sweep_for({.linear_m_s = {0, 0, -2}}, 1.0);
  EXPECT_EQ(hit.status, TimeOfImpactStatus::kContact);
  EXPECT_NEAR(hit.safe_s, 0.4375, 1e-9);
  EXPECT_NEAR(hit.contact_s, 0.4375, 1e-9);
  EXPECT_NEAR(hit.T_world_object.translation().z(), 0.125, 1e-9);
  EXPECT_EQ(hit.queries, 1);
  EXPECT_EQ(hit.contact.touched, SurfaceKind::kStatic);
  const TimeOfImpact free = stage.sweep_for({.linear_m_s = {0, 0, -2}}, 0.4);
  EXPECT_EQ(free.status, TimeOfImpactStatus::kFree);
  EXPECT_EQ(free.safe_s, 0.4);
  EXPECT_EQ(free.contact_s, kInfinity);
}

TEST(Sweep, ABarThatTurnsOnTheSpotStrikesTheFloorAtItsAngle) {
  // Half a metre long, level, 0.2 m above the floor: its lower far edge touches at asin(0.2 / r) - the angle
  // of that edge.
  const Stage stage{JudgedMesh(shapes::box({0.5F, 0.03125F, 0.03125F}), at(0, 0, 0.2)),
                    JudgedMesh(shapes::floor(1.0F, 0.0F))};
  const double r = std::hypot(0.25, 0.015625);
  const double angle = std::asin(0.2 / r) - std::atan2(0.015625, 0.25);
  for (const double speed_rad_s : {0.01, 1.0, 1000.0}) {
    const TimeOfImpact hit = stage.sweep_for({.angular_rad_s = {0, speed_rad_s, 0}}, 10.0 / speed_rad_s);
    EXPECT_EQ(hit.status, TimeOfImpactStatus::kContact);
    EXPECT_LE(hit.safe_s * speed_rad_s, angle);
    EXPECT_GE(hit.safe_s * speed_rad_s, angle - 1e-2);
    EXPECT_GE(hit.contact_s * speed_rad_s, angle - 1e-6);
    EXPECT_LE(hit.contact_s * speed_rad_s, angle + 1e-1);
  }
  // Above its reach it rotates without contact.
  const Stage high{JudgedMesh(shapes::box({0.5F, 0.03125F, 0.03125F}), at(0, 0, 0.3)),
                   JudgedMesh(shapes::floor(1.0F, 0.0F))};
  const TimeOfImpact free = high.sweep_for({.angular_rad_s = {0, 1000.0, 0}}, 1000.0);
  EXPECT_EQ(free.status, TimeOfImpactStatus::kFree);
  EXPECT_EQ(free.safe_s, 1000.0);
}

TEST(Sweep, TheCentreOfTurningMatters) {
  // A bar that rotates about its end, and a wall 0.4 m beside it: rotating about its centre, it does not
  // reach the wall.
  const Stage stage{JudgedMesh(shapes::box({0.5F, 0.03125F, 0.03125F}), at(0, 0, 0)),
                    JudgedMesh(shapes::box({1.0F, 0.0625F, 1.0F}), at(0, 0.4, 0))};
  EXPECT_EQ(stage.sweep_for({.angular_rad_s = {0, 0, 1}}, 3.0).status, TimeOfImpactStatus::kFree);
  const TimeOfImpact hit = stage.sweep_for({.angular_rad_s = {0, 0, 1}, .centre_object = {-0.25, 0, 0}}, 3.0);
  EXPECT_EQ(hit.status, TimeOfImpactStatus::kContact);
  EXPECT_LT(hit.contact_s, M_PI / 2);
}

TEST(Sweep, NothingTunnelsAtAnySpeed) {
  Mesh skin;  // a sheet with no thickness at all, facing the needle
  shapes::add_quad(skin, {0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1});
  for (const Mesh& sheet : {shapes::box({0.001F, 2.0F, 2.0F}), skin}) {
    for (const double turn_rad_s : {100.0, 1e4}) {
      for (const double speed_m_s : {1.0, 1000.0, 1e6}) {
        const Stage stage{JudgedMesh(shapes::box({0.3F, 0.001F, 0.001F}), at(-5, 0.1, 0.2)),
                          JudgedMesh(sheet)};
        const RigidMotion motion{.linear_m_s = {speed_m_s, 0, 0},
                                 .angular_rad_s = {0, 0.6 * turn_rad_s, 0.8 * turn_rad_s}};
        const TimeOfImpact hit = stage.sweep_for(motion, 100.0 / speed_m_s, {.max_queries = 20000});
        ASSERT_EQ(hit.status, TimeOfImpactStatus::kContact) << turn_rad_s << " " << speed_m_s;
        EXPECT_LT(hit.T_world_object.translation().x(), -0.0004);
        EXPECT_LT(hit.safe_s * speed_m_s, 5.0);
        EXPECT_GT(hit.safe_s * speed_m_s, 5.0 - 0.16);
        EXPECT_LT(hit.contact_s, kInfinity) << turn_rad_s << " rad/s " << speed_m_s << " m/s, safe at x "
                                            << hit.T_world_object.translation().x();
        EXPECT_GE(hit.contact_s, hit.safe_s);
        EXPECT_LT(stage.clearance_m(motion, hit.contact_s), 1e-5);
      }
    }
  }
}

TEST(Sweep, FreeTimesAreFreeAndContactsAreReal) {
  std::mt19937 random(1);
  std::deque<Mesh> objects = {shapes::box({0.25F, 0.15F, 0.1F}), shapes::torus(10, 6, 0.12F, 0.04F, 0.01F),
                              shapes::cup(0.1F, 0.2F, 0.02F, 8), shapes::box({0.4F, 0.004F, 0.004F})};
  std::deque<Mesh> scenes = {shapes::bumpy_ground(12), shapes::chair(), shapes::cup(0.3F, 0.4F, 0.05F, 12)};
  int contacts = 0, frees = 0, shown = 0, queries = 0;
  double farthest_m = 0.0;
  const int count = std::getenv("ROOMRADAR_LONG_TESTS") != nullptr ? 3000 : 120;
  for (int i = 0; i < count && !HasFailure(); ++i) {
    Eigen::Isometry3d T(shapes::random_rotation(random));
    T.pretranslate(Eigen::Vector3d(0, 0, 0.9) + 0.5 * shapes::random_point(random));
    const Stage stage{JudgedMesh(objects[static_cast<std::size_t>(i) % objects.size()], T),
                      JudgedMesh(scenes[static_cast<std::size_t>(i / 4) % scenes.size()]),
                      {.mode = i % 5 == 0 ? RadarMode::kSampled : RadarMode::kExact}};
    RigidMotion motion{.linear_m_s = 3.0 * (Eigen::Vector3d(0, 0, -0.5) + shapes::random_point(random)),
                       .angular_rad_s = 15.0 * shapes::random_point(random),
                       .centre_object = 0.1 * shapes::random_point(random)};
    if (i % 7 == 0) motion.linear_m_s.setZero();
    if (exact_clearance(stage.object.mesh, T, stage.scene.mesh, at(0, 0, 0)) < 1e-3) continue;
    constexpr double kDuration_s = 0.5;
    const TimeOfImpact got = stage.sweep_for(motion, kDuration_s, {.max_queries = 1000});
    queries += got.queries;
    const std::string text = "sweep " + std::to_string(i) + " safe " + std::to_string(got.safe_s) +
                             " contact " + std::to_string(got.contact_s) + " after " +
                             std::to_string(got.queries) + " queries";
    ASSERT_TRUE(got.status == TimeOfImpactStatus::kFree || got.status == TimeOfImpactStatus::kContact)
        << text << " status " << static_cast<int>(got.status);
    // Checks pose by pose, in steps that miss no contact: no point moves farther than the clearance.
    const double reach_m = 0.5;
    const double speed_m_s = motion.linear_m_s.norm() + motion.angular_rad_s.norm() * reach_m;
    for (double time_s = 0.0; time_s < got.safe_s;) {
      const double clearance_m = stage.clearance_m(motion, time_s);
      ASSERT_GT(clearance_m, 0.0) << text << " at " << time_s;
      time_s += std::max(clearance_m, 2e-4) / speed_m_s;
    }
    if (got.status == TimeOfImpactStatus::kFree) {
      EXPECT_EQ(got.safe_s, kDuration_s);
      ++frees;
      continue;
    }
    ++contacts;
    const double stopped_m = stage.clearance_m(motion, got.safe_s);
    EXPECT_GT(stopped_m, 0.0) << text;
    farthest_m = std::max(farthest_m, stopped_m);
    if (got.contact_s < kInfinity) {
      ++shown;
      EXPECT_GE(got.contact_s, got.safe_s) << text;
      EXPECT_LT(stage.clearance_m(motion, got.contact_s), 1e-5) << text;
    }
  }
  std::printf("%d contacts (%d shown), %d free, %d queries; stopped at most %.3f mm away\n", contacts, shown,
              frees, queries, 1e3 * farthest_m);
  EXPECT_GT(contacts, HasFailure() ? 0 : 20);
  EXPECT_GT(frees, HasFailure() ? 0 : 15);
  EXPECT_GE(shown, contacts * 9 / 10);
  EXPECT_LT(farthest_m, 2e-3);
}

TEST(Sweep, StandingStillIsFreeUnlessItOverlaps) {
  const Mesh box = shapes::box({0.25F, 0.25F, 0.25F}), floor = shapes::floor(1.0F, 0.0F);
  const TimeOfImpact free = Stage{JudgedMesh(box, at(0, 0, 1)), JudgedMesh(floor)}.sweep_for({}, 2.0);
  EXPECT_EQ(free.status, TimeOfImpactStatus::kFree);
  EXPECT_EQ(free.safe_s, 2.0);
  const Stage through{JudgedMesh(box, at(0, 0, 0.1)), JudgedMesh(floor)};
  for (const RigidMotion& motion :
       {RigidMotion{}, RigidMotion{.linear_m_s = {0, 0, -1}}, RigidMotion{.angular_rad_s = {1, 0, 0}},
        RigidMotion{.linear_m_s = {0, 0, -1}, .angular_rad_s = {1, 2, 0}}}) {
    const TimeOfImpact stuck = through.sweep_for(motion, 2.0);
    EXPECT_EQ(stuck.status, TimeOfImpactStatus::kOverlap);
    EXPECT_EQ(stuck.safe_s, 0.0);
    EXPECT_EQ(stuck.contact_s, 0.0);
    EXPECT_TRUE(stuck.T_world_object.isApprox(at(0, 0, 0.1), 0.0));
  }
  // An invalid query does not count as free.
  Stage nowhere{JudgedMesh(box, at(0, 0, 1)), JudgedMesh(floor)};
  nowhere.scene.T_world_mesh.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(nowhere.sweep_for({}, 2.0).status, TimeOfImpactStatus::kInvalidInput);
  EXPECT_EQ(nowhere.sweep_for({}, 2.0).safe_s, 0.0);
  Mesh upright = floor;  // detected along the first axis only if queried from the other side
  for (Eigen::Vector3f& vertex : upright.vertices) vertex = {vertex.z(), vertex.x(), vertex.y()};
  const Stage crossed{JudgedMesh(box, at(0, 0, 0)), JudgedMesh(upright)};
  EXPECT_EQ(crossed.sweep_for({}, 2.0, {.max_queries = 1}).status, TimeOfImpactStatus::kOutOfQueries);
  EXPECT_EQ(crossed.sweep_for({}, 2.0, {.max_queries = 2}).status, TimeOfImpactStatus::kOverlap);
  const TimeOfImpact no_time = through.sweep_for({.linear_m_s = {0, 0, 1}}, 0.0);
  EXPECT_NE(no_time.status, TimeOfImpactStatus::kInvalidInput);
}

TEST(Sweep, WhatTouchesAndTurnsIsStoppedAndWhatKeepsAGapMayLeave) {
  const Mesh box = shapes::box({0.25F, 0.25F, 0.25F}), floor = shapes::floor(1.0F, 0.0F);
  const RigidMotion leaving{.linear_m_s = {0, 0, 1}, .angular_rad_s = {0, 1, 0}};
  const TimeOfImpact stopped =
      Stage{JudgedMesh(box, at(0, 0, 0.125)), JudgedMesh(floor)}.sweep_for(leaving, 0.5);
  EXPECT_EQ(stopped.status, TimeOfImpactStatus::kContact);
  EXPECT_EQ(stopped.safe_s, 0.0);
  const RigidMotion hardly{.linear_m_s = {0, 0, 1}, .angular_rad_s = {0, 1e-9, 0}};
  EXPECT_EQ((Stage{JudgedMesh(box, at(0, 0, 0.125)), JudgedMesh(floor)}.sweep_for(hardly, 0.5).status),
            TimeOfImpactStatus::kFree);
  const Stage gap{JudgedMesh(box, at(0, 0, 0.125 + 2e-5)), JudgedMesh(floor)};
  EXPECT_EQ(gap.sweep_for(leaving, 0.5).status, TimeOfImpactStatus::kFree);
  // But it is a contact if rotation moves a corner into the floor faster than the object rises.
  const RigidMotion digging{.linear_m_s = {0, 0, 0.1}, .angular_rad_s = {0, 5, 0}};
  const TimeOfImpact dug = gap.sweep_for(digging, 0.5);
  EXPECT_EQ(dug.status, TimeOfImpactStatus::kContact);
  EXPECT_LT(dug.safe_s, 1e-4);
}

TEST(Sweep, RunsOutOfQueriesHonestly) {
  const Stage stage{JudgedMesh(shapes::box({0.25F, 0.25F, 0.25F}), at(-0.8, 0, 0.126)),
                    JudgedMesh(shapes::floor(1.0F, 0.0F))};
  // Slides 1 mm above the floor while rotating about the vertical: many short steps.
  const RigidMotion motion{.linear_m_s = {1, 0, 0}, .angular_rad_s = {0, 0, 20}};
  const TimeOfImpact got = stage.sweep_for(motion, 1.5, {.max_queries = 20});
  EXPECT_EQ(got.status, TimeOfImpactStatus::kOutOfQueries);
  EXPECT_LE(got.queries, 20);
  EXPECT_GT(got.safe_s, 0.0);
  EXPECT_LT(got.safe_s, 1.5);
  EXPECT_EQ(stage.sweep_for(motion, 1.5, {.max_queries = 20000}).status, TimeOfImpactStatus::kFree);
}

TEST(Sweep, WhatIsNoQuestionIsRefused) {
  const double nan = std::nan("");
  const Stage stage{JudgedMesh(shapes::box({0.25F, 0.25F, 0.25F}), at(0, 0, 1)),
                    JudgedMesh(shapes::floor(1.0F, 0.0F))};
  const auto status = [&](const RigidMotion& motion, double duration_s,
                          const TimeOfImpactConfig& config = {}) {
    const TimeOfImpact got = stage.sweep_for(motion, duration_s, config);
    EXPECT_EQ(got.safe_s, 0.0);
    return got.status;
  };
  EXPECT_EQ(status({.linear_m_s = {nan, 0, 0}}, 1.0), TimeOfImpactStatus::kInvalidInput);
  EXPECT_EQ(status({.angular_rad_s = {0, kInfinity, 0}}, 1.0), TimeOfImpactStatus::kInvalidInput);
  EXPECT_EQ(status({.centre_object = {0, 0, nan}}, 1.0), TimeOfImpactStatus::kInvalidInput);
  EXPECT_EQ(status({}, nan), TimeOfImpactStatus::kInvalidInput);
  EXPECT_EQ(status({}, -1.0), TimeOfImpactStatus::kInvalidInput);
  EXPECT_EQ(status({}, kInfinity), TimeOfImpactStatus::kInvalidInput);
  EXPECT_EQ(status({.linear_m_s = {1e300, 0, 0}}, 1e300), TimeOfImpactStatus::kInvalidInput);
  EXPECT_EQ(status({}, 1.0, {.tolerance_m = 0.0}), TimeOfImpactStatus::kInvalidInput);
  EXPECT_EQ(status({}, 1.0, {.max_queries = 0}), TimeOfImpactStatus::kInvalidInput);
  CyberRadar radar;
  EXPECT_EQ(time_of_impact(radar, {}, {}, 1.0, {}).status, TimeOfImpactStatus::kInvalidInput);
}

TEST(Sweep, HugeSpeedsAreAnsweredWithinTheirQueries) {
  const Stage stage{JudgedMesh(shapes::box({0.25F, 0.25F, 0.25F}), at(0, 0, 1)),
                    JudgedMesh(shapes::floor(1.0F, 0.0F))};
  for (const RigidMotion& motion :
       {RigidMotion{.linear_m_s = {0, 0, -1e12}},
        RigidMotion{.linear_m_s = {0, 0, -1e12}, .angular_rad_s = {1e12, 0, 0}},
        RigidMotion{.linear_m_s = {0, 0, -1e-12}, .angular_rad_s = {1e12, 1, 0}}}) {
    const TimeOfImpact got = stage.sweep_for(motion, 1.0);
    EXPECT_NE(got.status, TimeOfImpactStatus::kInvalidInput);
    EXPECT_LE(got.queries, 256);
    if (motion.linear_m_s.z() < -1.0) {
      EXPECT_EQ(got.status, TimeOfImpactStatus::kContact);
      EXPECT_LE(got.safe_s, 0.875e-12 * (1 + 1e-9));
    } else {
      EXPECT_EQ(got.status, TimeOfImpactStatus::kFree);
    }
  }
}

}  // namespace
}  // namespace roomradar::time_of_impact_test
