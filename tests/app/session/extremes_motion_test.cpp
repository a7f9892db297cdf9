// extremes_motion_test.cpp: poses and objects over very many steps, and irregular time stamps.
//
// ROOMRADAR_LONG_TESTS=1 tracks 10^6 frames instead of 10^4.
#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "app/physics/physics.hpp"
#include "app/session/script/session_events.hpp"
#include "app/session/session.hpp"
#include "mapping/alignment/align.hpp"
#include "mapping/alignment/view.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "radar/motion/time_of_impact.hpp"
#include "tests/app/session/extremes_row.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/noisy_room.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::extremes_motion_test {
namespace {

using test::print_row;
using test::text;
using Vec3 = Eigen::Vector3d;

constexpr double kOrthonormal = 1e-12;

/// Deviation of a matrix from a rotation: the largest entry of R^T R - I, or 1 if it mirrors.
double off_rotation(const Eigen::Isometry3d& T) {
  const Eigen::Matrix3d R = T.linear();
  if (!(R.determinant() > 0.0)) return 1.0;
  return (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

/// Closed box with these half sizes about the origin, facing outwards.
Mesh box_mesh(const Eigen::Vector3f& half) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1 ? 1.0F : -1.0F) * half.x(), (i & 2 ? 1.0F : -1.0F) * half.y(),
                               (i & 4 ? 1.0F : -1.0F) * half.z());
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// A level floor of 8 x 8 m at z = 0.
SavedMap floor_map() {
  SavedMap map;
  map.mesh.vertices = {{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}};
  map.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return map;
}

/// A box, a floor and the real radar between them.
class Falling {
 public:
  Falling() {
    const Mesh mesh = box_mesh({0.05F, 0.08F, 0.03F});
    tree_.build_by_place(mesh);
    body.mass = mass_properties(mesh, tree_.is_closed());
    floor_.build_by_place(floor_map().mesh);
    if (!tree_.is_closed()) throw std::logic_error("the box is open");
  }
  StepReport step(double dt_s, const PhysicsConfig& config = {}) {
    const std::vector<SceneTree> scene = {{{&floor_, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic}};
    const RadarScene radar_scene{scene, {}};
    return advance(body, dt_s, make_collision_queries(radar_, tree_, radar_scene), config);
  }
  [[nodiscard]] double height_m() const { return body.T_world_object.translation().z(); }

  static constexpr double kHalfHeight_m = 0.03;
  Body body;

 private:
  TriangleTree tree_, floor_;
  CyberRadar radar_;
};

TEST(Extremes, AMillionStepsOfASpinningBodyKeepARotation) {
  constexpr int kSteps = 1'000'000;
  Falling box;
  PhysicsConfig weightless;
  weightless.gravity_world_mps2.setZero();
  box.body.T_world_object.translation() = Vec3(0, 0, 2.0);
  box.body.angular_velocity_world_rad_s = Vec3(3.0, -7.0, 5.0);
  const auto momentum = [&] {
    const Eigen::Matrix3d R = box.body.T_world_object.linear();
    return Vec3(R * box.body.mass.inertia_m2 * R.transpose() * box.body.angular_velocity_world_rad_s);
  };
  const Vec3 before = momentum();
  double worst = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    ASSERT_EQ(box.step(1.0 / 60.0, weightless).status, StepStatus::kMoved);
    worst = std::max(worst, off_rotation(box.body.T_world_object));
  }
  EXPECT_LT(worst, kOrthonormal);
  EXPECT_LT((momentum() - before).norm(), 1e-6 * before.norm());
  print_row("10⁶ steps of a body that spins freely", "a rotation to 1e-12; its angular momentum",
            text("%.0e; ", worst) +
                text("momentum changed by %.0e of itself", (momentum() - before).norm() / before.norm()));
}

TEST(Extremes, ManyTurnsByAUserKeepARotation) {
  const int turns = test::is_long_test() ? 1'000'000 : 50'000;
  const test::TemporaryFolder folder;
  write_mesh(box_mesh({0.05F, 0.08F, 0.03F}), folder.path() / "box.ply");
  const SavedMap map = floor_map();
  Session session(map, {});
  apply(session, {AddObject{.name = "box", .source = {.mesh = folder.path() / "box.ply"}}});
  // Not quite a rotation at the start.
  session.place("box", {.position_world = Vec3(0, 0, 2.0),
                        .R_world_object = (1.0 + 1e-9) * Eigen::Matrix3d::Identity()});
  const ScriptEvent turn{TurnObject{"box", {0.7, -1.3, 2.1}}};
  double worst = 0.0;
  for (int i = 0; i < turns; ++i) {
    apply(session, turn);
    worst = std::max(worst, off_rotation(session.objects().front()->body.T_world_object));
  }
  EXPECT_LT(worst, kOrthonormal);
  print_row(text("%.0e turns of an object by the user", turns), "a rotation to 1e-12", text("%.0e", worst));
}

/// Aligns each frame with the previous one at its estimated pose. Only the alignment itself keeps the product
/// of a million motions a rotation.
TEST(Extremes, ChainedPosesStayRotations) {
  const int frames = test::is_long_test() ? 1'000'000 : 10'000;
  constexpr int kViews = 24;
  constexpr Intrinsics kSmall{64, 48, 58.5, 58.5, 31.5, 23.5};
  struct View {
    SourcePoints live;
    TargetView reference;
    Eigen::Isometry3d T_world_camera;
  };
  std::vector<View> views(kViews);
  for (int i = 0; i < kViews; ++i) {
    View& view = views[static_cast<std::size_t>(i)];
    view.T_world_camera = test::on_path(i, kViews);
    const Frame frame = test::exact_frame(test::room(), kSmall, view.T_world_camera);
    const ViewConfig config{.noisy = false};
    ViewPyramid pyramid;
    make_pyramid(frame.depth_m, frame.depth_camera, config, pyramid);
    make_source_points(pyramid, view.live);
    make_target_view(pyramid, view.T_world_camera, config, view.reference);
  }
  AlignConfig config;
  config.min_points = 100;
  Eigen::Isometry3d T_world_camera = views[0].T_world_camera;
  double worst = 0.0;
  int tracked = 0;
  for (int i = 1; i <= frames; ++i) {
    const View& before = views[static_cast<std::size_t>((i - 1) % kViews)];
    const View& now = views[static_cast<std::size_t>(i % kViews)];
    const PosedReference reference{&before.reference, T_world_camera};
    const Eigen::Isometry3d T_guess = T_world_camera * before.T_world_camera.inverse() * now.T_world_camera;
    const Tracking tracking = align(now.live, {&reference, 1}, T_guess, config);
    tracked += has_pose(tracking) ? 1 : 0;
    T_world_camera = tracking.T_world_camera;
    worst = std::max(worst, off_rotation(T_world_camera));
  }
  EXPECT_GT(tracked, frames * 9 / 10);
  EXPECT_LT(worst, kOrthonormal);
  print_row(text("%.0e frames, each tracked against the one before it", frames), "a rotation to 1e-12",
            text("%.0e", worst));
}

TEST(Extremes, AMicrosecondAtATimeABodyFallsAndComesToRest) {
  constexpr double kStep_s = 1e-6;
  Falling box;
  box.body.T_world_object.translation() = Vec3(0, 0, 1.0);
  for (int i = 0; i < 100'000; ++i) static_cast<void>(box.step(kStep_s));
  const double fallen_m = 1.0 - box.height_m();
  EXPECT_NEAR(fallen_m, 0.5 * 9.81 * 0.01, 1e-6);

  Falling low;
  low.body.T_world_object.translation() = Vec3(0, 0, Falling::kHalfHeight_m + 0.0015);
  int steps = 0;
  while (!low.body.asleep && steps < 600'000) {
    ASSERT_EQ(low.step(kStep_s).status, StepStatus::kMoved);
    ++steps;
  }
  const double gap_m = low.height_m() - Falling::kHalfHeight_m;
  EXPECT_TRUE(low.body.asleep);
  EXPECT_GT(gap_m, 0.0);
  EXPECT_LT(gap_m, 0.0015);
  print_row("1 µs between frames", "0.1 s of fall are 49.050 mm; it comes to rest in its margin of 1 mm",
            text("%.3f mm; ", 1e3 * fallen_m) + text("at rest after %.2f s, ", steps * kStep_s) +
                text("%.2f mm over the floor", 1e3 * gap_m));
}

/// Frame without colour and depth, from a camera with a known pose that looks at the sky.
Frame sky(std::int64_t index, double stamp_s) {
  Frame frame;
  frame.index = index;
  frame.stamp_s = stamp_s;
  frame.depth_camera = {64, 48, 58.5, 58.5, 31.5, 23.5};
  frame.depth_m.resize(64, 48, 0.0F);
  frame.T_world_camera = test::looking_at({0, -1.2, 1.2}, {0, 0, 3});
  return frame;
}

/// A pot thrown down from 3 m at 20 m/s, in frames with given time stamps.
class Thrown {
 public:
  Thrown() : session_(map_, config()) {
    apply(session_, {AddObject{.name = "pot", .source = {.mesh = "teapot"}}});
    apply(session_, {ThrowObject{"pot", {0, 0, 3.0}, {0, 0, -20.0}}});
  }
  void step(double stamp_s) {
    result = session_.step(sky(index_++, stamp_s), times_);
    lowest_m_ = std::min(lowest_m_, bottom_m());
  }
  [[nodiscard]] double bottom_m() const {
    const VirtualObject& pot = *session_.objects().front();
    return pot.body.T_world_object.translation().z() + lowest_m(pot);
  }
  [[nodiscard]] double lowest_bottom_m() const { return lowest_m_; }
  [[nodiscard]] const Body& body() const { return session_.objects().front()->body; }
  FrameResult result;

 private:
  static SessionConfig config() {
    SessionConfig config;
    config.poses = PoseOrigin::kRecorded;
    config.make_picture = false;
    return config;
  }
  SavedMap map_ = floor_map();
  Session session_;
  StageTimes times_;
  std::int64_t index_ = 0;
  double lowest_m_ = std::numeric_limits<double>::infinity();
};

TEST(Extremes, TenSecondsBetweenFramesLaunchNothing) {
  Thrown pot;
  for (int i = 0; i < 12; ++i) pot.step(10.0 * i);
  EXPECT_GT(pot.lowest_bottom_m(), 0.0);
  EXPECT_LT(pot.bottom_m(), 0.002);
  EXPECT_TRUE(pot.body().asleep);
  print_row("10 s between frames, a pot thrown down at 20 m/s", "never in the floor; at rest on it",
            text("lowest point %.2f mm over it at the least, ", 1e3 * pot.lowest_bottom_m()) +
                (pot.body().asleep ? "at rest" : "not at rest"));
}

TEST(Extremes, StampsThatJumpBackStandStillForOneFrame) {
  Thrown pot;
  double clock_s = 1000.0;
  int done = 0;
  for (int i = 0; i < 120; ++i) {
    clock_s += i % 10 == 9 ? -100.0 : 1.0 / 30.0;
    pot.step(clock_s);
    done += pot.result.status == FrameStatus::kDone ? 1 : 0;
  }
  for (const double odd :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e300, 0.0}) {
    pot.step(odd);
    done += pot.result.status == FrameStatus::kDone ? 1 : 0;
  }
  EXPECT_EQ(done, 124);
  EXPECT_GT(pot.lowest_bottom_m(), 0.0);
  EXPECT_LT(pot.bottom_m(), 0.002);
  EXPECT_TRUE(pot.body().asleep);
  print_row(
      "stamps that jump back by 100 s every tenth frame, then NaN, infinity, -1e300 and 0 s",
      "every frame done; a pot falls on as if the odd steps were none",
      text("%.0f of 124 frames done, ", done) + text("at rest %.2f mm over the floor", 1e3 * pot.bottom_m()));
}

TEST(Extremes, WithoutGravityNothingMoves) {
  Falling box;
  PhysicsConfig weightless;
  weightless.gravity_world_mps2.setZero();
  box.body.T_world_object.translation() = Vec3(0.1, -0.2, 0.5);
  const Eigen::Isometry3d before = box.body.T_world_object;
  for (int i = 0; i < 1000; ++i) static_cast<void>(box.step(1.0 / 30.0, weightless));
  const double moved_m = (box.body.T_world_object.translation() - before.translation()).norm();
  EXPECT_EQ(moved_m, 0.0);
  print_row("physics without gravity, 1,000 frames", "a body put in mid-air stays there",
            text("moved by %.0f mm", 1e3 * moved_m));
}

}  // namespace
}  // namespace roomradar::extremes_motion_test
