// movers.cpp: animates a hand with its arm, a rolling ball and a walking person, built from inflated solids.
#include "app/sim/sensor/movers.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/sim/solids/angles.hpp"
#include "mapping/types/system/counter_random.hpp"

namespace roomradar {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr Material kSkin{Pattern::kSkin, {222, 172, 142}, {196, 136, 110}, 301, 0.55F};
constexpr Material kSleeve{Pattern::kFabric, {70, 84, 110}, {92, 106, 132}, 302, 0.5F};
constexpr Material kShirt{Pattern::kFabric, {176, 62, 54}, {226, 210, 190}, 303, 0.55F};
constexpr Material kTrousers{Pattern::kFabric, {52, 60, 82}, {66, 76, 100}, 304, 0.4F};
constexpr Material kShoes{Pattern::kPortable, {50, 42, 38}, {34, 28, 26}, 305, 0.2F};
constexpr Material kHair{Pattern::kFabric, {62, 42, 30}, {44, 30, 22}, 306, 0.12F};
constexpr Material kBall{Pattern::kCarpet, {216, 60, 44}, {248, 240, 226}, 307, 0.6F};

/// Returns the time at which a mover of steady pace has the same position.
double steady_time_s(const Mover& mover, double t_s) {
  constexpr double kStand_s = 2.0, kGo_s = 2.0;
  switch (mover.pace) {
    case Pace::kSteady:
      return t_s;
    case Pace::kSlow:
      return t_s / 3.0;
    case Pace::kLeaves:
      return 0.0;
    case Pace::kWaits: {
      const double rounds = std::floor(t_s / (kStand_s + kGo_s));
      const double gone = std::max(t_s - rounds * (kStand_s + kGo_s) - kStand_s, 0.0) / kGo_s;
      return kGo_s * (rounds + gone * gone * (3.0 - 2.0 * gone));  // starts and stops gently
    }
  }
  return t_s;
}

/// Returns the distance moved out of the room: accelerates up to a quick walk.
double way_out_m(const Mover& mover, double t_s) {
  constexpr double kSpeedUp_s = 0.5, kSpeed_m_per_s = 1.5;
  if (mover.pace != Pace::kLeaves || t_s <= mover.leaves_at_s) return 0.0;
  const double since_s = t_s - mover.leaves_at_s;
  const double speeding_s = std::min(since_s, kSpeedUp_s);
  return kSpeed_m_per_s * (0.5 * speeding_s * speeding_s / kSpeedUp_s + (since_s - speeding_s));
}

/// Returns 0 at the start of a period and 1 in its middle, smoothly.
double there_and_back(const Mover& mover, double t_s) {
  return 0.5 - 0.5 * std::cos(kFullTurn_rad * t_s / mover.period_s + mover.phase_rad);
}

void append(std::vector<Solid>& solids, const Isometry3d& T_world_piece, Solid solid_piece) {
  solid_piece.T_world_solid = T_world_piece * solid_piece.T_world_solid;
  solids.push_back(solid_piece);
}

/// Hand frame: x from the fingers to the elbow, z up from the back of the hand, origin at the palm's centre.
void append_hand(const Mover& mover, double t_s, std::vector<Solid>& solids) {
  const double reach = there_and_back(mover, t_s);
  Isometry3d T_world_hand = Isometry3d::Identity();
  const Vector3d x = mover.arm_world;
  const Vector3d y = Vector3d::UnitZ().cross(x).normalized();
  T_world_hand.linear() << x, y, x.cross(y);
  T_world_hand.translation() = mover.from_world + reach * (mover.to_world - mover.from_world);
  append(solids, T_world_hand, rounded_box({0, 0, 0}, {0.1, 0.09, 0.032}, 0.015));
  constexpr double kFingers[4][3] = {
      {-0.034, 0.072, 0.0085}, {-0.012, 0.082, 0.009}, {0.011, 0.076, 0.009}, {0.033, 0.058, 0.008}};
  const double curl = 0.25 + 0.2 * reach;
  for (const auto& [across_m, length_m, radius_m] : kFingers) {
    const Vector3d knuckle(-0.042, across_m, 0.0);
    const Vector3d middle = knuckle + 0.55 * length_m * Vector3d(-std::cos(curl), 0, -std::sin(curl));
    const Vector3d tip = middle + 0.45 * length_m * Vector3d(-std::cos(2.2 * curl), 0, -std::sin(2.2 * curl));
    append(solids, T_world_hand, capsule(knuckle, middle, radius_m));
    append(solids, T_world_hand, capsule(middle, tip, 0.9 * radius_m));
  }
  append(solids, T_world_hand, capsule({0.02, -0.045, -0.004}, {-0.035, -0.078, -0.018}, 0.0105));
  append(solids, T_world_hand, capsule({0.05, 0, 0}, {0.15, 0, 0}, 0.029));
  append(solids, T_world_hand, capsule({0.14, 0, 0}, {0.34, 0, 0}, 0.043));
  append(solids, T_world_hand, capsule({0.34, 0, 0}, {0.66, 0, 0.06}, 0.052));
}

void append_ball(const Mover& mover, double t_s, std::vector<Solid>& solids) {
  const Vector3d way = mover.to_world - mover.from_world;
  const double gone = there_and_back(mover, t_s);
  Solid ball = sphere(mover.from_world + gone * way + Vector3d(0, 0, mover.radius_m), mover.radius_m);
  const Vector3d axis_world = Vector3d::UnitZ().cross(way).normalized();  // rolls without slipping
  ball.T_world_solid.linear() =
      Eigen::AngleAxisd(gone * way.norm() / mover.radius_m, axis_world).toRotationMatrix();
  solids.push_back(ball);
}

/// Person frame: +y ahead, z up, origin on the floor between the feet.
void append_person(const Mover& mover, double t_s, std::vector<Solid>& solids) {
  const Vector3d middle = 0.5 * (mover.from_world + mover.to_world);
  const Vector3d along = 0.5 * (mover.to_world - mover.from_world);
  const double long_m = along.norm();
  const double short_m = std::min(0.15, 0.3 * long_m);
  const Vector3d ahead = along / long_m;
  const Vector3d aside = Vector3d::UnitZ().cross(ahead);
  const double phase_rad = kFullTurn_rad * t_s / mover.period_s + mover.phase_rad;
  const Vector3d velocity = -std::sin(phase_rad) * long_m * ahead + std::cos(phase_rad) * short_m * aside;
  Isometry3d T_world_person = Isometry3d::Identity();
  const Vector3d y = velocity.normalized();
  T_world_person.linear() << y.cross(Vector3d::UnitZ()), y, Vector3d::UnitZ();
  T_world_person.translation() =
      middle + std::cos(phase_rad) * long_m * ahead + std::sin(phase_rad) * short_m * aside;

  constexpr double kHip_m = 0.9, kShoulder_m = 1.42, kThigh_m = 0.42, kShin_m = 0.38;
  const double gait_rad = kFullTurn_rad * t_s * 0.9 + mover.phase_rad;
  for (const double side : {-1.0, 1.0}) {
    const double swing = 0.35 * side * std::sin(gait_rad);
    const double bend = 0.22 * (1.0 + side * std::cos(gait_rad));  // the forward leg bends
    const Vector3d hip(side * 0.095, 0, kHip_m);
    const Vector3d knee =
        hip + kThigh_m * Vector3d(0, std::sin(swing + 0.5 * bend), -std::cos(swing + 0.5 * bend));
    const Vector3d ankle =
        knee + kShin_m * Vector3d(0, std::sin(swing - 0.5 * bend), -std::cos(swing - 0.5 * bend));
    append(solids, T_world_person, capsule(hip, knee, 0.075));
    append(solids, T_world_person, capsule(knee, ankle, 0.052));
    append(solids, T_world_person, rounded_box(ankle + Vector3d(0, 0.06, -0.055), {0.09, 0.25, 0.08}, 0.035));
    const Vector3d shoulder(side * 0.2, 0, kShoulder_m);
    const Vector3d elbow = shoulder + 0.29 * Vector3d(side * 0.12, -std::sin(swing), -std::cos(swing));
    const Vector3d wrist = elbow + 0.26 * Vector3d(0, std::sin(0.4 - swing), -std::cos(0.4 - swing));
    append(solids, T_world_person, capsule(shoulder, elbow, 0.048));
    append(solids, T_world_person, capsule(elbow, wrist, 0.038));
    append(solids, T_world_person, sphere(wrist + 0.3 * (wrist - elbow), 0.048));
  }
  append(solids, T_world_person, rounded_box({0, 0, 0.94}, {0.34, 0.22, 0.22}, 0.09));
  append(solids, T_world_person, rounded_box({0, 0, 1.24}, {0.4, 0.23, 0.5}, 0.1));
  append(solids, T_world_person, capsule({0, 0, 1.44}, {0, 0.01, 1.56}, 0.055));
  append(solids, T_world_person, capsule({0, 0.015, 1.6}, {0, 0.02, 1.66}, 0.092));
  append(solids, T_world_person, capsule({0, -0.012, 1.64}, {0, 0.0, 1.69}, 0.095));
}

}  // namespace

Mover plan_mover(MoverKind kind, const Room& room, const Vector3d& viewer_world, std::uint64_t seed,
                 Pace pace, double duration_s) {
  CounterRandom random(hash_of(seed, 0x6d6f7665), static_cast<std::uint64_t>(kind));
  Mover mover;
  mover.kind = kind;
  mover.pace = pace;
  mover.leaves_at_s = 0.5 * duration_s;
  switch (kind) {
    case MoverKind::kHand: {
      const Vector3d to_viewer = (viewer_world - room.focus_world).normalized();
      const Vector3d right = Vector3d::UnitZ().cross(to_viewer).normalized();  // in the viewer's image
      mover.to_world = room.focus_world + random.uniform(0.27, 0.33) * to_viewer;
      mover.from_world = mover.to_world + 1.15 * right + Vector3d(0, 0, 0.12);
      mover.arm_world =
          (right + 0.35 * Vector3d(to_viewer.x(), to_viewer.y(), 0.0) + Vector3d(0, 0, 0.3)).normalized();
      mover.period_s = random.uniform(4.5, 6.0);
      mover.phase_rad = random.uniform(-0.3, 0.3);
      mover.materials.assign(10, kSkin);
      mover.materials.insert(mover.materials.end(), {kSkin, kSleeve, kSleeve});
      break;
    }
    case MoverKind::kBall:
      mover.from_world = room.ball_from_world;
      mover.to_world = room.ball_to_world;
      mover.radius_m = room.ball_from_world.z() > 0.1 ? 0.055 : 0.11;  // a small ball on a table
      mover.period_s =
          std::max(3.0, kFullTurn_rad * (mover.to_world - mover.from_world).norm() / (2.0 * 0.6));
      mover.phase_rad = random.uniform(0.0, kFullTurn_rad);
      mover.materials.assign(1, kBall);
      break;
    case MoverKind::kPerson:
      mover.from_world = room.person_from_world;
      mover.to_world = room.person_to_world;
      mover.period_s =
          std::max(6.0, kFullTurn_rad * (mover.to_world - mover.from_world).norm() / (2.0 * 0.9));
      mover.phase_rad = random.uniform(0.0, kFullTurn_rad);
      for (int side = 0; side < 2; ++side)
        mover.materials.insert(mover.materials.end(), {kTrousers, kTrousers, kShoes, kShirt, kSkin, kSkin});
      mover.materials.insert(mover.materials.end(), {kTrousers, kShirt, kSkin, kSkin, kHair});
      break;
  }
  const Vector3d middle = 0.5 * (mover.from_world + mover.to_world);
  const Vector3d outwards(middle.x() - room.walk_centre_world.x(), middle.y() - room.walk_centre_world.y(),
                          0.0);
  if (outwards.norm() > 0.1) mover.out_world = outwards.normalized();
  return mover;
}

void append_solids(const Mover& mover, double t_s, std::vector<Solid>& solids) {
  const std::size_t before = solids.size();
  const double steady_s = steady_time_s(mover, t_s);
  switch (mover.kind) {
    case MoverKind::kHand:
      append_hand(mover, steady_s, solids);
      break;
    case MoverKind::kBall:
      append_ball(mover, steady_s, solids);
      break;
    case MoverKind::kPerson:
      append_person(mover, steady_s, solids);
      break;
  }
  const Vector3d out_world = way_out_m(mover, t_s) * mover.out_world;
  for (std::size_t i = before; i < solids.size(); ++i) solids[i].T_world_solid.pretranslate(out_world);
}

}  // namespace roomradar
