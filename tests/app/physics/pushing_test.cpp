// pushing_test.cpp: fingers push a body: by several places at once, and a sleeping one before they are in it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "app/physics/depenetration.hpp"
#include "app/physics/physics.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "radar/motion/proximity.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar::pushing_test {
namespace {

using Vec3 = Eigen::Vector3d;
constexpr double kFrame_s = 1.0 / 30.0;
constexpr double kFinger_m = 0.02;  // radius of a fingertip

/// An object on a floor, and fingertips that move.
class Table {
 public:
  explicit Table(const Mesh& object) {
    object_.build_by_place(object);
    floor_.build_by_place(shapes::floor(5.0F, 0.0F));
    body.mass = mass_properties(object, object_.is_closed());
  }
  void add_finger(const Vec3& centre) {
    fingers.push_back(centre);
    finger_meshes_.push_back(shapes::ball(static_cast<float>(kFinger_m), 24, 48));
    finger_meshes_.back().origin = centre;
  }
  StepReport step(double surface_speed_mps = 0.0) {
    trees_.resize(fingers.size());
    std::vector<SceneTree> scene = {{{&floor_, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic}};
    Mesh together;
    for (std::size_t i = 0; i < fingers.size(); ++i) {
      finger_meshes_[i].origin = fingers[i];
      trees_[i].build_in_order(finger_meshes_[i]);
      scene.push_back({{&trees_[i], Eigen::Isometry3d::Identity()}, SurfaceKind::kDynamic});
      for (const Eigen::Vector3f& v : finger_meshes_[i].vertices)
        together.vertices.push_back((fingers[i] + v.cast<double>()).cast<float>());
    }
    const PushDirections push = depenetration_directions({&together}, centre_world(body), 0.3);
    const RadarScene radar_scene{scene, {}};
    const CollisionQueries queries = make_collision_queries(radar_, object_, radar_scene);
    AdvancedBody advanced{.body = &body,
                          .probe = &queries,
                          .dt_s = kFrame_s,
                          .surface_speed_mps = surface_speed_mps,
                          .depenetration_directions_world = push.span()};
    advance_together({&advanced, 1}, {}, system_);
    return advanced.report;
  }

  Body body;
  std::vector<Vec3> fingers;  ///< centres

 private:
  TriangleTree object_, floor_;
  std::vector<Mesh> finger_meshes_;
  std::vector<TriangleTree> trees_;
  CyberRadar radar_;
  ContactSystem system_;
};

/// Returns how deep a fingertip is in a box; negative outside.
double depth_in_box_m(const Vec3& finger, const Body& body, const Vec3& half_m) {
  const Vec3 p = body.T_world_object.inverse() * finger;
  const Vec3 q = p.cwiseAbs() - half_m;
  const double distance_m = q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
  return kFinger_m - distance_m;
}

TEST(Pushing, FingersFromTwoSidesPushABoxAwayFromBoth) {
  const Vec3 half(0.05, 0.05, 0.05);
  Table table(shapes::box({0.1F, 0.1F, 0.1F}));
  table.body.T_world_object.translation() = Vec3(0.0, 0.0, 0.051);
  table.add_finger({-0.08, 0.01, 0.05});
  table.add_finger({0.01, -0.08, 0.05});
  double deepest_m = -1.0;
  for (int i = 0; i < 30; ++i) {  // both at 0.3 m/s
    table.fingers[0].x() += 0.01;
    table.fingers[1].y() += 0.01;
    (void)table.step();
    for (const Vec3& finger : table.fingers)
      deepest_m = std::max(deepest_m, depth_in_box_m(finger, table.body, half));
  }
  EXPECT_LT(deepest_m, 0.003);
  EXPECT_GT(table.body.T_world_object.translation().x(), 0.07);
  EXPECT_GT(table.body.T_world_object.translation().y(), 0.07);
}

TEST(Pushing, ATallBoxThatTipsIsPushedByEveryFingerThatItTouches) {
  const Vec3 half(0.035, 0.035, 0.1);
  Table table(shapes::box({0.07F, 0.07F, 0.2F}));
  table.body.T_world_object.translation() = Vec3(0.0, 0.0, 0.101);
  for (const double z_m : {0.08, 0.12, 0.16}) table.add_finger({-0.06, 0.0, z_m});
  double deepest_m = -1.0;
  for (int i = 0; i < 10; ++i) {  // at 1.2 m/s
    for (Vec3& finger : table.fingers) finger.x() += 0.04;
    (void)table.step(1.2);
    for (const Vec3& finger : table.fingers)
      deepest_m = std::max(deepest_m, depth_in_box_m(finger, table.body, half));
  }
  EXPECT_LT(deepest_m, 0.003);
}

TEST(Pushing, ASleepingBodyWaitsForAStillHandButNotForOneThatComes) {
  for (const double speed_mps : {0.0, 0.3}) {
    Table table(shapes::box({0.1F, 0.1F, 0.1F}));
    table.body.T_world_object.translation() = Vec3(0.0, 0.0, 0.051);
    table.body.asleep = true;
    table.add_finger({-0.05 - kFinger_m + 0.004, 0.0, 0.05});  // 4 mm in it
    EXPECT_EQ(table.step(speed_mps).woke, speed_mps > 0.0) << speed_mps;
  }
}

}  // namespace
}  // namespace roomradar::pushing_test
