// odometry.cpp: where the camera was, frame by frame, in a room that is not known yet.
#include "mapping/odometry.hpp"

#include <algorithm>
#include <numbers>
#include <optional>
#include <utility>

#include "mapping/place_matching.hpp"
#include "mapping/stillness.hpp"

namespace roomradar {
namespace {

/// A frame as it is kept: relative to a keyframe, so that it moves when the keyframe is moved.
struct KeptFrame {
  std::int64_t frame_index = 0;
  double stamp_s = 0.0;
  std::optional<std::size_t> keyframe;  ///< none: the pose is in the world, and fixed
  Eigen::Isometry3d T_keyframe_camera = Eigen::Isometry3d::Identity();
  TrackStatus status = TrackStatus::kDiverged;
  bool trusted = false;
};

bool has_pose(const Tracking& tracking) {
  return tracking.status == TrackStatus::kTracked || tracking.status == TrackStatus::kDegenerate;
}

}  // namespace

struct Odometry::State {
  OdometryConfig config;
  OdometryCounts counts;
  ViewPyramid pyramid;
  LiveView live;
  KeyframeGraph graph;
  Places places;  ///< one a keyframe while tracking
  std::vector<KeptFrame> frames;
  std::size_t current = 0;  ///< the keyframe that the last frame was aligned with first
  Eigen::Isometry3d T_world_last = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_last_next = Eigen::Isometry3d::Identity();  ///< the last motion from frame to frame
  Image<float> last_moved_grey;                                   ///< what the camera saw when it last moved
  Tracking last_moved;  ///< the answer for that frame; its pose is trusted

  Tracking start(const Frame& frame);
  [[nodiscard]] Tracking align_near(std::size_t first, const Eigen::Isometry3d& T_world_guess) const;
  Tracking recover(const Frame& frame);
  [[nodiscard]] bool is_plausible(const Tracking& tracking) const;
  void improve_current(const Tracking& tracking);
  [[nodiscard]] bool is_far_from(std::size_t keyframe, const Tracking& tracking) const;
  void choose_keyframe(const Frame& frame, Tracking& tracking);
  void add_keyframe(const Frame& frame, const Eigen::Isometry3d& T_world_camera);
  void join_alike();
  void keep(const Frame& frame, const Tracking& tracking);
};

Tracking Odometry::State::start(const Frame& frame) {
  Tracking tracking;
  const auto enough = static_cast<std::size_t>(std::max(config.align.min_points, 1));
  if (live.levels.front().size() < enough) {
    tracking.status = TrackStatus::kTooFewPoints;
    return tracking;
  }
  tracking.status = TrackStatus::kTracked;
  tracking.overlap = tracking.inlier_fraction = 1.0;
  add_keyframe(frame, tracking.T_world_camera);
  return tracking;
}

Tracking Odometry::State::align_near(std::size_t first, const Eigen::Isometry3d& T_world_guess) const {
  // view_distance(); past it too little of the frame meets the keyframe.
  constexpr double kUsefulReference = 0.7;
  const auto most = static_cast<std::size_t>(std::max(config.references, 1));
  std::vector<const ReferenceView*> references{&graph.keyframes[first].reference};
  for (const std::size_t i : keyframes_near(graph, T_world_guess, kUsefulReference)) {
    if (i != first && references.size() < most) references.push_back(&graph.keyframes[i].reference);
  }
  return align(live, references, T_world_guess, config.align);
}

Tracking Odometry::State::recover(const Frame& frame) {
  Tracking standing = align_near(current, T_world_last);
  if (standing && is_plausible(standing)) return standing;
  standing.status = TrackStatus::kDiverged;
  if (frame.colour.empty() && !last_moved_grey.empty())
    return standing;  // a frame that lost its colour on the way
  const Relocalisation found = relocalise(frame, places, config.relocalise);
  if (!found) return standing;
  const auto keyframe = static_cast<std::size_t>(found.keyframe);
  const Tracking tracking = align_near(keyframe, found.T_world_camera);
  if (!tracking) return standing;
  ++counts.relocalised;
  current = keyframe;
  return tracking;
}

/// A hand does not change a camera's speed by more than this from one frame to the next; a sensor that
/// recalibrates itself seems to.
bool Odometry::State::is_plausible(const Tracking& tracking) const {
  constexpr double kMost_m = 0.10, kMost_rad = 0.05;
  if (!has_pose(tracking)) return false;
  const Eigen::Isometry3d change = (T_world_last * T_last_next).inverse() * tracking.T_world_camera;
  return change.translation().norm() < kMost_m && Eigen::AngleAxisd(change.linear()).angle() < kMost_rad;
}

void Odometry::State::improve_current(const Tracking& tracking) {
  Keyframe& keyframe = graph.keyframes[current];
  improve_depth(keyframe, pyramid, tracking.T_world_camera);
  if (keyframe.improved_since_refresh >= config.improve_every) refresh(keyframe, config.view);
}

bool Odometry::State::is_far_from(std::size_t keyframe, const Tracking& tracking) const {
  const Eigen::Isometry3d T =
      graph.keyframes[keyframe].reference.T_world_view.inverse() * tracking.T_world_camera;
  return T.translation().norm() > config.keyframe_distance_m ||
         Eigen::AngleAxisd(T.linear()).angle() > config.keyframe_angle_deg * std::numbers::pi / 180.0;
}

void Odometry::State::choose_keyframe(const Frame& frame, Tracking& tracking) {
  const bool little_in_common = tracking.overlap < config.keyframe_overlap;
  if (!little_in_common && !is_far_from(current, tracking)) return;
  const std::vector<std::size_t> near = keyframes_near(graph, tracking.T_world_camera, 1.0);
  if (!near.empty() && near.front() != current && !is_far_from(near.front(), tracking)) {
    current = near.front();
    return;
  }
  add_keyframe(frame, tracking.T_world_camera);
  tracking.T_world_camera = graph.keyframes[current].reference.T_world_view;
}

void Odometry::State::add_keyframe(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  graph.keyframes.push_back(make_keyframe(frame.index, pyramid, T_world_camera, config.view));
  places.keyframes.push_back(describe_place(frame, T_world_camera, config.place));
  ++counts.keyframes;
  current = graph.keyframes.size() - 1;
  join_alike();
  join_newest(graph, config.align, config.graph);
  for (std::size_t i = 0; i < graph.keyframes.size(); ++i) {
    places.keyframes[i].T_world_camera = graph.keyframes[i].reference.T_world_view;
  }
}

/// Joins the newest keyframe with one that looks alike but is thought to be far away: where the poses have
/// drifted apart, appearance still knows the place.
void Odometry::State::join_alike() {
  constexpr int kMinMatches = 25, kMinInliers = 30;
  constexpr std::size_t kCandidates = 2;
  const Place& newest = places.keyframes.back();
  const std::span<const Place> older(places.keyframes.data(), places.keyframes.size() - 1);
  for (const std::size_t i : most_alike(newest, older, kCandidates, kMinMatches)) {
    const Eigen::Isometry3d T_older_newest = older[i].T_world_camera.inverse() * newest.T_world_camera;
    if (view_distance(T_older_newest) < config.graph.furthest) continue;
    const PlaceMatch match = match_places(older[i], newest);
    if (match.inliers < kMinInliers) continue;
    join(graph, i, graph.keyframes.size() - 1, match.T_a_b, config.align, config.graph);
  }
}

void Odometry::State::keep(const Frame& frame, const Tracking& tracking) {
  KeptFrame kept{frame.index,     frame.stamp_s, std::nullopt, tracking.T_world_camera,
                 tracking.status, bool{tracking}};
  if (!graph.keyframes.empty()) {
    kept.keyframe = current;
    kept.T_keyframe_camera =
        graph.keyframes[current].reference.T_world_view.inverse() * tracking.T_world_camera;
  }
  frames.push_back(kept);
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
  const bool first = s.graph.keyframes.empty();
  if (!first && shows_the_same(s.last_moved_grey, s.pyramid.grey)) {
    ++s.counts.tracked;
    s.T_world_last = s.last_moved.T_world_camera;
    s.T_last_next.setIdentity();
    s.keep(frame, s.last_moved);
    return s.last_moved;
  }
  Tracking tracking = first ? s.start(frame) : s.align_near(s.current, s.T_world_last * s.T_last_next);
  if (!first && !s.is_plausible(tracking)) tracking = s.recover(frame);

  if (!has_pose(tracking)) {
    ++s.counts.lost;
    tracking.T_world_camera = s.T_world_last;
    s.T_last_next.setIdentity();
    s.keep(frame, tracking);
    return tracking;
  }
  const Eigen::Isometry3d T_last_next = s.T_world_last.inverse() * tracking.T_world_camera;
  if (tracking && !first) {
    s.improve_current(tracking);
    s.choose_keyframe(frame, tracking);
  }
  ++(tracking ? s.counts.tracked : s.counts.degenerate);
  // What is not fixed by what is seen must not run on for ever with the speed it once had.
  s.T_last_next = tracking ? T_last_next : exp_twist(0.5 * log_twist(T_last_next));
  s.T_world_last = tracking.T_world_camera;
  s.last_moved_grey.resize(0, 0);
  if (tracking) {
    s.last_moved_grey = s.pyramid.grey;
    s.last_moved = tracking;
  }
  s.keep(frame, tracking);
  return tracking;
}

void Odometry::add_posed(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  State& s = *state_;
  ++s.counts.frames;
  ++s.counts.tracked;
  s.frames.push_back({frame.index, frame.stamp_s, std::nullopt, T_world_camera, TrackStatus::kTracked, true});
  const double limit = view_distance(
      Eigen::Translation3d(s.config.keyframe_distance_m, 0, 0) *
      Eigen::AngleAxisd(s.config.keyframe_angle_deg * std::numbers::pi / 180.0, Eigen::Vector3d::UnitX()));
  const bool known =
      std::any_of(s.places.keyframes.begin(), s.places.keyframes.end(), [&](const Place& place) {
        return view_distance(place.T_world_camera.inverse() * T_world_camera) < limit;
      });
  if (known) return;
  s.places.keyframes.push_back(describe_place(frame, T_world_camera, s.config.place));
  ++s.counts.keyframes;
}

std::vector<TrackedFrame> Odometry::optimise() {
  State& s = *state_;
  join_all(s.graph, s.config.view, s.config.align, s.config.graph);
  for (std::size_t i = 0; i < s.graph.keyframes.size(); ++i) {
    s.places.keyframes[i].T_world_camera = s.graph.keyframes[i].reference.T_world_view;
  }
  std::vector<TrackedFrame> trajectory;
  for (const KeptFrame& f : s.frames) {
    const Eigen::Isometry3d T_world_camera =
        f.keyframe ? s.graph.keyframes[*f.keyframe].reference.T_world_view * f.T_keyframe_camera
                   : f.T_keyframe_camera;
    trajectory.push_back({f.frame_index, f.stamp_s, T_world_camera, f.status, f.trusted});
  }
  return trajectory;
}

Places Odometry::take_places() { return std::exchange(state_->places, {}); }

OdometryCounts Odometry::counts() const {
  OdometryCounts counts = state_->counts;
  counts.loops_found = state_->graph.loops_found;
  counts.loops_rejected = state_->graph.loops_rejected;
  return counts;
}

}  // namespace roomradar
