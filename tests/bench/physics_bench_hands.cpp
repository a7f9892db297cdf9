// physics_bench_hands.cpp: renders the hand, steps the session, and measures overlaps with exact solids.
#include "physics_bench_hands.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "app/session/session.hpp"
#include "app/sim/sensor/kinect_depth.hpp"
#include "app/sim/solids/solid_distance.hpp"
#include "mapping/types/system/counter_random.hpp"
#include "physics_bench_scenes.hpp"
#include "tests/support/exact_depth.hpp"

namespace roomradar::bench {
namespace {

using Vec3 = Eigen::Vector3d;
constexpr double kHandFrame_s = 1.0 / 30.0;
constexpr double kTable_m = 0.72;
constexpr Intrinsics kCamera{320, 240, 292.0, 292.0, 159.5, 119.5};

struct HandledObject {
  const char* name;
  Vec3 size_m;  ///< of the bounding box
  bool is_ball;
};
constexpr int kKinds = 4;
const std::array<HandledObject, kKinds> kObjects = {{{"cube", {0.08, 0.08, 0.08}, false},
                                                     {"ball", {0.1, 0.1, 0.1}, true},
                                                     {"book", {0.2, 0.14, 0.04}, false},
                                                     {"carton", {0.07, 0.07, 0.2}, false}}};

/// One pass of a hand.
struct Pass {
  const HandledObject* object;
  double speed_mps;
  Vec3 way;      ///< unit, level: direction of the hand's motion
  Vec3 fingers;  ///< unit, level: from the wrist to the fingertips
  double phase_s;

  [[nodiscard]] Vec3 palm_world(double t_s) const {
    constexpr double kFrom_m = -0.5;
    const double height_m = std::max(0.5 * object->size_m.z(), 0.03);
    return Vec3(0.0, 0.0, kTable_m + height_m) + (kFrom_m + speed_mps * (t_s + phase_s)) * way -
           0.09 * fingers;  // the fingers meet the object, not the palm
  }
};

/// Returns a flat hand on edge with its forearm, which rises to the elbow.
std::vector<Solid> hand_solids(const Pass& pass, double t_s) {
  const Vec3 palm = pass.palm_world(t_s), up = Vec3::UnitZ();
  std::vector<Solid> solids;
  Solid palm_solid =
      rounded_box(palm, {0.09, 0.028, 0.05}, 0.012, std::atan2(pass.fingers.y(), pass.fingers.x()));
  solids.push_back(palm_solid);
  for (int finger = 0; finger < 3; ++finger) {
    const Vec3 knuckle = palm + 0.045 * pass.fingers + 0.018 * (finger - 1) * up;
    solids.push_back(capsule(knuckle, knuckle + 0.08 * pass.fingers, 0.009));
  }
  const Vec3 wrist = palm - 0.05 * pass.fingers;
  solids.push_back(capsule(wrist, wrist + 0.4 * (-pass.fingers + 0.6 * up).normalized(), 0.035));
  return solids;
}

Solid object_solid(const HandledObject& object, double smaller_m) {
  if (object.is_ball) return sphere(Vec3::Zero(), 0.5 * object.size_m.x() - smaller_m);
  return box(Vec3::Zero(), object.size_m - Vec3::Constant(2.0 * smaller_m));
}

Frame render(std::span<const Solid> table, std::span<const Solid> hand,
             const Eigen::Isometry3d& T_world_camera, int index) {
  std::vector<Solid> solids(table.begin(), table.end());
  solids.insert(solids.end(), hand.begin(), hand.end());
  const std::vector<float> infrared(solids.size(), 0.7F);
  ViewCaster view;
  ExactView exact;
  KinectScratch scratch;
  Frame frame;
  view.prepare(solids, kCamera, T_world_camera);
  render_exact(solids, view, kCamera, {}, exact);
  measure_depth({solids, infrared}, {view, exact, kCamera, T_world_camera}, {{}, 1.0, 1, index}, scratch,
                frame.depth_m);
  frame.index = index;
  frame.stamp_s = index * kHandFrame_s;
  frame.depth_camera = kCamera;
  frame.T_world_camera = T_world_camera;
  return frame;
}

struct PassResult {
  bool touched = false, entered = false, passed = false;
  bool entered_unseen = true, entered_pinned = true;  ///< in all frames in which the hand is in the object
  double deepest_m = 0.0;
};

constexpr double kEntered_m = 0.01;

/// Depth by which the hand is in the object, in steps of 2.5 mm; 0: not deeper than 2.5 mm.
double depth_in_m(std::span<const Solid> hand, const HandledObject& object,
                  const Eigen::Isometry3d& T_world_object) {
  constexpr double kStep_m = 0.0025;
  double depth_m = 0.0;
  while (true) {
    const double smaller_m = depth_m + kStep_m;
    if (2.0 * smaller_m >= object.size_m.minCoeff()) return depth_m;
    const Solid solid = object_solid(object, smaller_m);
    if (clearance_m(hand, {&solid, 1}, T_world_object, 0.1) > 0.0) return depth_m;
    depth_m = smaller_m;
  }
}

/// Returns true if most of what the hand and the object share lies more than a finger's thickness behind the
/// hand's front: the camera sees another part of the hand there.
bool is_unseen(std::span<const Solid> hand, const HandledObject& object,
               const Eigen::Isometry3d& T_world_object, const Eigen::Isometry3d& T_world_camera) {
  constexpr double kStep_m = 0.004, kThick_m = 0.03;
  ViewCaster view;
  ExactView exact;
  view.prepare(hand, kCamera, T_world_camera);
  render_exact(hand, view, kCamera, {}, exact);
  const Solid solid = object_solid(object, 0.0);
  const Eigen::Array3i steps = (object.size_m / kStep_m).array().cast<int>();
  int seen = 0, unseen = 0;
  for (int x = 0; x <= steps.x(); ++x)
    for (int y = 0; y <= steps.y(); ++y)
      for (int z = 0; z <= steps.z(); ++z) {
        const Vec3 p_object = kStep_m * Vec3(x, y, z) - 0.5 * object.size_m;
        const Vec3 p_world = T_world_object * p_object;
        if (signed_distance_m(solid, p_object) > 0.0 ||
            std::none_of(hand.begin(), hand.end(),
                         [&](const Solid& part) { return signed_distance_m(part, p_world) < 0.0; }))
          continue;
        const Vec3 p_camera = T_world_camera.inverse() * p_world;
        const Eigen::Vector2i pixel = project(kCamera, p_camera).array().round().cast<int>();
        const bool is_in_view = exact.depth_m.contains(pixel.x(), pixel.y());
        const double front_m = is_in_view ? exact.depth_m.at(pixel.x(), pixel.y()) : 0.0;
        ++(front_m > 0.0 && p_camera.z() - front_m < kThick_m ? seen : unseen);
      }
  return unseen > seen;
}

/// Returns true if the object cannot be translated out of the hand's way: the room is there.
bool is_pinned(std::span<const Solid> room, const Vec3& way, double depth_m, const HandledObject& object,
               Eigen::Isometry3d T_world_object) {
  T_world_object.pretranslate(depth_m * way);
  const Solid solid = object_solid(object, 0.0);
  return !(clearance_m(room, {&solid, 1}, T_world_object, 0.1) > 0.0);
}

PassResult sweep(const Pass& pass) {
  constexpr int kSettle_frames = 30;
  const std::vector<Solid> table = {box({0.0, 0.0, 0.5 * kTable_m}, {2.0, 1.6, kTable_m}),
                                    box({0.0, 0.0, -0.05}, {8.0, 8.0, 0.1})};
  SavedMap map;
  map.mesh = box_mesh({2.0, 1.6, kTable_m});
  for (Eigen::Vector3f& vertex : map.mesh.vertices) vertex.z() += 0.5F * static_cast<float>(kTable_m);
  const auto floor_from = static_cast<std::uint32_t>(map.mesh.vertices.size());
  for (const auto& [x, y] : {std::pair{-4.0F, -4.0F}, {4.0F, -4.0F}, {4.0F, 4.0F}, {-4.0F, 4.0F}})
    map.mesh.vertices.emplace_back(x, y, 0.0F);
  map.mesh.triangles.push_back({floor_from, floor_from + 1, floor_from + 2});
  map.mesh.triangles.push_back({floor_from, floor_from + 2, floor_from + 3});
  SessionConfig config;
  config.poses = PoseOrigin::kRecorded;
  Session session(map, config);
  const Vec3& size_m = pass.object->size_m;
  session.add_object("object", pass.object->is_ball ? ball_mesh(0.5 * size_m.x(), 12) : box_mesh(size_m));
  session.place("object", {.position_world = {0.0, 0.0, kTable_m + 0.5 * size_m.z() + 0.002}});
  const VirtualObject& object = *session.objects().front();
  const Eigen::Isometry3d T_world_camera =
      test::looking_at({0.0, -1.0, kTable_m + 0.8}, {0.0, 0.0, kTable_m});
  StageTimes times;
  PassResult result;
  const int moving_frames = static_cast<int>(std::ceil(0.9 / pass.speed_mps / kHandFrame_s));
  for (int index = 0; index < kSettle_frames + moving_frames; ++index) {
    const double t_s = (index - kSettle_frames) * kHandFrame_s;
    const std::vector<Solid> hand = t_s > 0.0 ? hand_solids(pass, t_s) : std::vector<Solid>{};
    static_cast<void>(session.step(render(table, hand, T_world_camera, index), times));
    if (hand.empty()) continue;
    const double depth_m = depth_in_m(hand, *pass.object, object.body.T_world_object);
    result.touched |= !object.body.asleep;
    result.deepest_m = std::max(result.deepest_m, depth_m);
    if (depth_m < kEntered_m) continue;
    const Eigen::Isometry3d& T_world_object = object.body.T_world_object;
    result.entered = true;
    result.entered_unseen &= is_unseen(hand, *pass.object, T_world_object, T_world_camera);
    result.entered_pinned &= is_pinned(table, pass.way, depth_m, *pass.object, T_world_object);
  }
  const double end_s = (moving_frames - 1) * kHandFrame_s;  // of the last frame
  const Vec3 hand_end = pass.palm_world(end_s) + 0.09 * pass.fingers;
  const Vec3 from_hand = object.body.T_world_object.translation() - hand_end;
  // Behind the hand, in its track.
  const Vec3 across = Vec3::UnitZ().cross(pass.way);
  result.passed = from_hand.dot(pass.way) < 0.0 && std::abs(from_hand.dot(across)) < 0.03 &&
                  object.body.T_world_object.translation().z() > kTable_m - 0.1;
  return result;
}

}  // namespace

void measure_hands(int objects, nlohmann::json& rows) {
  const std::array<double, 10> speeds = {0.1, 0.3, 0.6, 0.9, 1.2, 1.5, 1.8, 2.2, 2.6, 3.0};
  std::printf("a hand through objects on a table\n%6s %8s %8s %8s %8s %8s %8s %11s\n", "m/s", "objects",
              "touched", "entered", "unseen", "pinned", "passed", "deepest mm");
  const int each = std::max(1, objects / static_cast<int>(speeds.size()));
  for (const double speed_mps : speeds) {
    int touched = 0, entered = 0, unseen = 0, pinned = 0, passed = 0;
    double deepest_m = 0.0;
    for (int i = 0; i < each; ++i) {
      CounterRandom random(11, static_cast<std::uint64_t>(i));
      const double angle = random.uniform(0.0, 2.0 * M_PI);
      const Vec3 way(std::cos(angle), std::sin(angle), 0.0);
      // Fingertips first, or the flat of the hand to either side.
      const double turn = std::array{0.0, 0.5 * M_PI, -0.5 * M_PI}[static_cast<std::size_t>(i % 3)];
      const Pass pass{&kObjects[static_cast<std::size_t>(i / 3 % kKinds)], speed_mps, way,
                      Eigen::AngleAxisd(turn, Vec3::UnitZ()) * way, random.uniform(0.0, kHandFrame_s)};
      const PassResult result = sweep(pass);
      touched += result.touched;
      entered += result.entered;
      unseen += result.entered && result.entered_unseen;
      pinned += result.entered && result.entered_pinned;
      passed += result.passed;
      deepest_m = std::max(deepest_m, result.deepest_m);
    }
    std::printf("%6.1f %8d %8d %8d %8d %8d %8d %11.1f\n", speed_mps, each, touched, entered, unseen, pinned,
                passed, 1e3 * deepest_m);
    std::fflush(stdout);
    rows.push_back({{"table", "hands"},
                    {"speed_mps", speed_mps},
                    {"objects", each},
                    {"touched", touched},
                    {"entered", entered},
                    {"unseen", unseen},
                    {"pinned", pinned},
                    {"passed", passed},
                    {"deepest_mm", 1e3 * deepest_m}});
  }
}

}  // namespace roomradar::bench
