// odometry.cpp: where the camera was, frame by frame, in a room that is not known yet.
#include "mapping/odometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "mapping/keyframe.hpp"
#include "mapping/pose_graph.hpp"

namespace roomradar {
namespace {

constexpr int kRefreshEvery = 5;        // views averaged into a keyframe between two makings of its reference
constexpr std::size_t kNeighbours = 3;  // keyframes closer in number than this are neighbours, not loops

/// A frame as it is kept: relative to a keyframe, so that it moves when the keyframe is moved.
struct KeptFrame {
  std::int64_t frame_index = 0;
  double stamp_s = 0.0;
  std::size_t keyframe = 0;
  Eigen::Isometry3d T_keyframe_camera = Eigen::Isometry3d::Identity();
  TrackStatus status = TrackStatus::kDiverged;
  bool trusted = false;
};

double angle_rad(const Eigen::Isometry3d& T) { return Eigen::AngleAxisd(T.linear()).angle(); }

/// How far apart two views are, 1 being where they hardly see the same any more.
double view_distance(const Eigen::Isometry3d& T) {
  return T.translation().norm() / 0.8 + angle_rad(T) / (35.0 * std::numbers::pi / 180.0);
}

}  // namespace

struct Odometry::State {
  OdometryConfig config;
  OdometryCounts counts;
  ViewPyramid pyramid;
  LiveView live;
  std::vector<Keyframe> keyframes;
  std::vector<PoseConstraint> constraints;
  std::vector<KeptFrame> frames;
  std::size_t current = 0;  ///< the keyframe that the last frame was aligned with
  Eigen::Isometry3d T_world_last = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_last_next = Eigen::Isometry3d::Identity();  ///< motion from frame to frame

  [[nodiscard]] std::vector<std::size_t> nearest_keyframes(const Eigen::Isometry3d& T_world_camera,
                                                           std::size_t count, double furthest) const;
  [[nodiscard]] Tracking align_with(const std::vector<std::size_t>& chosen,
                                    const Eigen::Isometry3d& guess) const;
  [[nodiscard]] bool needs_keyframe(const Tracking& tracking) const;
  void add_keyframe(const Frame& frame, const Tracking& tracking);
  void join(std::size_t older, std::size_t newer, bool& loop);
  void solve_graph();
  void keep(const Frame& frame, const Tracking& tracking);
};

std::vector<std::size_t> Odometry::State::nearest_keyframes(const Eigen::Isometry3d& T_world_camera,
                                                            std::size_t count, double furthest) const {
  std::vector<std::pair<double, std::size_t>> found;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const double distance = view_distance(keyframes[i].reference.T_world_view.inverse() * T_world_camera);
    if (distance < furthest) found.emplace_back(distance, i);
  }
  std::sort(found.begin(), found.end());
  std::vector<std::size_t> nearest;
  for (const auto& [distance, i] : found) {
    if (nearest.size() < count) nearest.push_back(i);
  }
  return nearest;
}

Tracking Odometry::State::align_with(const std::vector<std::size_t>& chosen,
                                     const Eigen::Isometry3d& guess) const {
  std::vector<const ReferenceView*> references;
  for (const std::size_t i : chosen) references.push_back(&keyframes[i].reference);
  return align(live, references, guess, config.align);
}

bool Odometry::State::needs_keyframe(const Tracking& tracking) const {
  if (tracking.overlap < config.keyframe_overlap) return true;
  const Eigen::Isometry3d T = keyframes[current].reference.T_world_view.inverse() * tracking.T_world_camera;
  return T.translation().norm() > config.keyframe_distance_m ||
         angle_rad(T) > config.keyframe_angle_deg * std::numbers::pi / 180.0;
}

void Odometry::State::join(std::size_t older, std::size_t newer, bool& loop) {
  const Keyframe& a = keyframes[older];
  const Keyframe& b = keyframes[newer];
  const Eigen::Isometry3d& T_world_a = a.reference.T_world_view;
  const Eigen::Isometry3d& T_world_b = b.reference.T_world_view;
  const Tracking b_in_a = align(b.live, a.reference, T_world_b, config.align);
  const Tracking a_in_b = align(a.live, b.reference, T_world_a, config.align);
  const bool neighbours = newer - older < kNeighbours;
  const auto good = [](const Tracking& t) {
    return (t.status == TrackStatus::kTracked || t.status == TrackStatus::kDegenerate) && t.overlap > 0.25 &&
           t.inlier_fraction > 0.5;
  };
  if (!good(b_in_a) || !good(a_in_b)) {
    if (!neighbours) ++counts.loops_rejected;
    return;
  }
  const Eigen::Isometry3d T_a_b = T_world_a.inverse() * b_in_a.T_world_camera;
  const Eigen::Isometry3d T_b_a = T_world_b.inverse() * a_in_b.T_world_camera;
  const Eigen::Isometry3d gap = T_a_b * T_b_a;
  if (gap.translation().norm() > config.max_gap || angle_rad(gap) > config.max_gap) {
    if (!neighbours) ++counts.loops_rejected;
    return;
  }
  constraints.push_back({older, newer, T_a_b, b_in_a.information, !neighbours});
  constraints.push_back({newer, older, T_b_a, a_in_b.information, !neighbours});
  if (!neighbours) {
    ++counts.loops_found;
    loop = true;
  }
}

void Odometry::State::solve_graph() {
  std::vector<Eigen::Isometry3d> poses;
  for (const Keyframe& keyframe : keyframes) poses.push_back(keyframe.reference.T_world_view);
  if (!optimise_pose_graph(poses, constraints).usable) return;
  for (std::size_t i = 0; i < poses.size(); ++i) keyframes[i].reference.T_world_view = poses[i];
}

void Odometry::State::add_keyframe(const Frame& frame, const Tracking& tracking) {
  const std::vector<std::size_t> near = nearest_keyframes(
      tracking.T_world_camera, static_cast<std::size_t>(config.loop_candidates), config.furthest);
  keyframes.push_back(make_keyframe(frame.index, pyramid, live, tracking.T_world_camera, config.view));
  current = keyframes.size() - 1;
  ++counts.keyframes;
  bool loop = false;
  for (const std::size_t older : near) join(older, current, loop);
  if (config.solve_online && !near.empty()) solve_graph();
}

void Odometry::State::keep(const Frame& frame, const Tracking& tracking) {
  const Eigen::Isometry3d T_keyframe_camera =
      keyframes[current].reference.T_world_view.inverse() * tracking.T_world_camera;
  frames.push_back({frame.index, frame.stamp_s, current, T_keyframe_camera, tracking.status,
                    tracking.status == TrackStatus::kTracked});
}

Odometry::Odometry(const OdometryConfig& config) : state_(std::make_unique<State>()) {
  state_->config = config;
}
Odometry::Odometry(Odometry&&) noexcept = default;
Odometry& Odometry::operator=(Odometry&&) noexcept = default;
Odometry::~Odometry() = default;

Tracking Odometry::track(const Frame& frame) {
  State& s = *state_;
  ++s.counts.frames;
  make_pyramid(frame, s.config.view, s.pyramid);
  make_live(s.pyramid, s.live);
  Tracking tracking;
  if (s.keyframes.empty()) {
    tracking.status = TrackStatus::kTracked;
    s.add_keyframe(frame, tracking);
    s.keep(frame, tracking);
    return tracking;
  }
  const Eigen::Isometry3d guess = s.T_world_last * s.T_last_next;
  std::vector<std::size_t> chosen{s.current};
  for (const std::size_t i : s.nearest_keyframes(guess, static_cast<std::size_t>(s.config.references), 0.7)) {
    if (i != s.current && chosen.size() < static_cast<std::size_t>(s.config.references)) chosen.push_back(i);
  }
  tracking = s.align_with(chosen, guess);
  if (tracking.status == TrackStatus::kTracked || tracking.status == TrackStatus::kDegenerate) {
    s.T_last_next = s.T_world_last.inverse() * tracking.T_world_camera;
    if (tracking) {
      ++s.counts.tracked;
      Keyframe& keyframe = s.keyframes[s.current];
      improve_depth(keyframe, s.pyramid, tracking.T_world_camera);
      if (keyframe.improved_since_refresh >= kRefreshEvery) refresh(keyframe, s.config.view);
      if (s.needs_keyframe(tracking)) {
        const std::vector<std::size_t> near = s.nearest_keyframes(tracking.T_world_camera, 1, 10.0);
        const std::size_t before = s.current;
        s.current = near.front();
        if (s.needs_keyframe(tracking)) {
          s.current = before;
          s.add_keyframe(frame, tracking);
          tracking.T_world_camera = s.keyframes[s.current].reference.T_world_view;
        }
      }
    } else {
      ++s.counts.degenerate;
    }
    s.T_world_last = tracking.T_world_camera;
  } else {
    ++s.counts.lost;
    s.T_last_next.setIdentity();
  }
  s.keep(frame, tracking);
  return tracking;
}

std::vector<TrackedFrame> Odometry::optimise() {
  State& s = *state_;
  s.solve_graph();
  std::vector<TrackedFrame> trajectory;
  for (const KeptFrame& f : s.frames) {
    trajectory.push_back({f.frame_index, f.stamp_s,
                          s.keyframes[f.keyframe].reference.T_world_view * f.T_keyframe_camera, f.status,
                          f.trusted});
  }
  return trajectory;
}

const OdometryCounts& Odometry::counts() const { return state_->counts; }

}  // namespace roomradar
