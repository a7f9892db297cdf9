// scan_view.cpp: receives frames from the scan's thread, and prepares the view on a separate thread.
#include "app/scan/scan_view.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "app/scan/live/table_tops.hpp"
#include "app/scan/scan_picture.hpp"
#include "mapping/odometry/odometry_snapshot.hpp"
#include "mapping/types/system/process_memory.hpp"
#include "mapping/types/system/worker_thread.hpp"

namespace roomradar {
namespace {

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::vector<Eigen::Vector3f> path_of(const OdometrySnapshot& odometry, const Tracking& tracking) {
  std::vector<Eigen::Vector3f> path;
  for (const Keyframe& keyframe : odometry.graph.keyframes)
    path.emplace_back(keyframe.T_world_camera.translation().cast<float>());
  path.emplace_back(tracking.T_world_camera.translation().cast<float>());
  return path;
}

/// Fraction of the measured pixels that are not known well.
double new_fraction(const Image<Knowledge>& knowledge) {
  std::size_t measured = 0, some_new = 0;
  for (const Knowledge k : knowledge.pixels) {
    measured += k != Knowledge::kNone ? 1 : 0;
    some_new += k == Knowledge::kNew || k == Knowledge::kThin ? 1 : 0;
  }
  return measured > 0 ? static_cast<double>(some_new) / static_cast<double>(measured) : 0.0;
}

}  // namespace

ScanView::ScanView(ScanChannel& channel, std::size_t max_memory_bytes, std::filesystem::path folder,
                   std::optional<NextView> first_view)
    : channel_(channel),
      counted_{max_memory_bytes, std::move(folder)},
      search_{std::move(first_view)},
      thread_([this] { serve(); }) {}

ScanView::~ScanView() {
  {
    const std::lock_guard lock(handover_.mutex);
    handover_.is_closed = true;
  }
  handover_.changed.notify_all();
  thread_.join();
}

void ScanView::measure_speed(const Frame& frame, const Tracking& tracking) {
  constexpr double kSmoothed_s = 0.15;
  if (!has_pose(tracking)) {
    scan_.last.reset();
    return;
  }
  if (scan_.last && frame.stamp_s > scan_.last->stamp_s) {
    const double passed_s = frame.stamp_s - scan_.last->stamp_s;
    const Eigen::Isometry3d moved = scan_.last->T_world_camera.inverse() * tracking.T_world_camera;
    const double share = std::min(passed_s / kSmoothed_s, 1.0);
    scan_.speed_mps += share * (moved.translation().norm() / passed_s - scan_.speed_mps);
    scan_.speed_rad_s += share * (Eigen::AngleAxisd(moved.linear()).angle() / passed_s - scan_.speed_rad_s);
  }
  scan_.last = Pose{frame.stamp_s, tracking.T_world_camera};
}

void ScanView::after_frame(const Frame& frame, const Tracking& tracking, const Odometry& odometry,
                           const StageTimes& times) {
  constexpr std::size_t kRateOver = 30;
  constexpr double kShare = 0.1;  // of the newest frame in the smoothed times
  const OdometrySnapshot& state = odometry.state();
  ++scan_.frames;
  scan_.seen_s.push_back(now_s());
  if (scan_.seen_s.size() > kRateOver) scan_.seen_s.pop_front();
  measure_speed(frame, tracking);
  times.visit_newest([&](const std::string& stage, std::size_t /*count*/, double newest_ms) {
    if (stage == "read") scan_.read_ms += kShare * (newest_ms - scan_.read_ms);
    if (stage == "track") scan_.track_ms += kShare * (newest_ms - scan_.track_ms);
  });
  scan_.has_moved = correct(state, scan_.anchors) || scan_.has_moved;
  {
    const std::lock_guard lock(handover_.mutex);
    if (handover_.is_busy || handover_.work) return;
  }
  Work work;
  work.frame = std::make_shared<Frame>(frame);
  work.tracking = tracking;
  work.facts = facts_of(frame, tracking);
  work.facts.is_apart = state.lost.has_value();
  work.facts.speed_mps = scan_.speed_mps;
  work.facts.speed_rad_s = scan_.speed_rad_s;
  if (tracking) work.anchor = anchor_for(frame.index, tracking.T_world_camera, state, scan_.anchors);
  work.T_world_anchor = scan_.anchors.T_world_anchor;
  work.has_moved = std::exchange(scan_.has_moved, false);
  work.is_located = state.located;
  work.path_world = path_of(state, tracking);
  if (tracking && wants_keyframes_.exchange(false)) work.keyframes = state.graph.keyframes;
  work.counts.frames = scan_.frames;
  if (scan_.seen_s.size() > 1)
    work.counts.frames_per_s = static_cast<double>(scan_.seen_s.size() - 1) /
                               std::max(scan_.seen_s.back() - scan_.seen_s.front(), 1e-6);
  work.counts.read_ms = scan_.read_ms;
  work.counts.track_ms = scan_.track_ms;
  work.counts.keyframes = state.counts.keyframes;
  work.counts.loops = state.graph.loops_found;
  {
    const std::lock_guard lock(handover_.mutex);
    handover_.work = std::move(work);
  }
  handover_.changed.notify_all();
}

void ScanView::forgot_frames(std::int64_t from_index) {
  forget_frames_from(from_index, scan_.anchors);
  scan_.has_moved = true;
  scan_.last.reset();
}

void ScanView::serve() {
  for (std::unique_lock lock(handover_.mutex);;) {
    handover_.changed.wait(lock, [&] { return handover_.work || handover_.is_closed; });
    if (handover_.is_closed) return;
    const Work work = *std::exchange(handover_.work, std::nullopt);
    handover_.is_busy = true;
    lock.unlock();
    show(work);
    lock.lock();
    handover_.is_busy = false;
  }
}

/// Estimates the up direction again whenever the number of frames has grown by half.
void ScanView::estimate_up(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  up_.estimator.add(frame, T_world_camera);
  if (++up_.frames < up_.due) return;
  up_.due += up_.due / 2 + 1;
  up_.T_shown_world = level_rotation(up_.estimator.estimate().up_world);
}

/// Starts computing the explored space and the next view on another thread, about once a second, and takes
/// the results.
void ScanView::explore(const Work& work) {
  using Clock = std::chrono::steady_clock;
  constexpr auto kEvery = std::chrono::seconds(1);
  constexpr double kReached_m = 0.25, kReached_rad = 0.35;
  if (search_.running.valid() &&
      search_.running.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    search_.last = search_.running.get();
    search_.holes = numbered(search_.last.holes, search_.holes);
  }
  if (!search_.running.valid() && !work.keyframes.empty()) {
    search_.begun = Clock::now();
    search_.running =
        std::async(std::launch::async, [keyframes = work.keyframes, T_shown_world = up_.T_shown_world,
                                        T_world_camera = work.tracking.T_world_camera] {
          lower_priority();
          Explored explored;
          explored.T_shown_world = T_shown_world;
          explored.grid = explored_around(T_world_camera.translation(), keyframes, T_shown_world);
          explored.next_view =
              best_next_view(*explored.grid, T_shown_world * T_world_camera, Eigen::Vector3d::UnitZ());
          explored.holes = holes_so_far(*explored.grid);
          return explored;
        });
  }
  if (!search_.running.valid() && Clock::now() - search_.begun > kEvery) wants_keyframes_ = true;
  const std::optional<NextView> next = next_view(work);
  if (!next || !work.tracking) return;
  const Eigen::Isometry3d left = next->T_world_camera.inverse() * shown_.T_world_camera;
  if (left.translation().norm() < kReached_m && Eigen::AngleAxisd(left.linear()).angle() < kReached_rad)
    (search_.first_view && work.is_located ? search_.first_view : search_.last.next_view).reset();
}

/// Returns the view to go to, in the shown world.
std::optional<NextView> ScanView::next_view(const Work& work) const {
  if (!search_.first_view || !work.is_located) return search_.last.next_view;
  NextView next = *search_.first_view;
  next.T_world_camera = up_.T_shown_world * next.T_world_camera;
  return next;
}

/// Fills the window's content with the state after the frame.
void ScanView::show_state(const Work& work) {
  const Frame& frame = *work.frame;
  shown_.frame_index = frame.index;
  shown_.stamp_s = frame.stamp_s;
  shown_.status = work.tracking.status;
  shown_.fault = advice_.fault();
  shown_.relative_speed = relative_speed(work.facts);
  shown_.camera = frame.depth_camera;
  shown_.path_world = work.path_world;
  for (Eigen::Vector3f& position : shown_.path_world)
    position = up_.T_shown_world.linear().cast<float>() * position;
  shown_.next_view.reset();
  if (const std::optional<NextView> next = next_view(work); next && work.tracking)
    shown_.next_view =
        ShownNextView{next->T_world_camera, way_to(*next, shown_.T_world_camera, Eigen::Vector3d::UnitZ())};
  shown_.holes = search_.holes;
  shown_.parts.clear();
  for (const LiveModelPart& part : model_.parts())
    if (part.anchor < work.T_world_anchor.size() && work.T_world_anchor[part.anchor])
      shown_.parts.push_back({part.mesh_anchor, up_.T_shown_world * *work.T_world_anchor[part.anchor]});
  shown_.counts = work.counts;
  shown_.counts.seen_m2 = seen_.total_m2();
  shown_.counts.well_known = counted_.well_known;
  shown_.counts.table_tops_known = counted_.table_tops_known;
  shown_.counts.memory_bytes = resident_bytes();
  shown_.counts.left_s = counted_.forecast.left_s();
}

void ScanView::show(const Work& work) {
  constexpr std::int64_t kCountedEvery = 30;
  constexpr double kWorthFusing = 0.1;
  const Frame& frame = *work.frame;
  const Eigen::Isometry3d& T_world_camera = work.tracking.T_world_camera;
  if (work.has_moved) knowledge_.move(work.T_world_anchor);
  make_picture(frame, shown_.picture);
  shown_.tint.resize(0, 0);
  if (work.tracking) {
    const Eigen::Isometry3d& T_world_anchor = *work.T_world_anchor[work.anchor];
    const Eigen::Isometry3d T_anchor_camera = T_world_anchor.inverse() * T_world_camera;
    const Image<Knowledge> knowledge = knowledge_.knowledge_of(frame, T_world_camera);
    knowledge_.add(frame, work.anchor, T_anchor_camera, T_world_anchor);
    shown_.tint = make_tint(frame, knowledge);
    seen_.add(frame, T_world_camera);
    estimate_up(frame, T_world_camera);
    last_good_ = shown_.picture;
    model_.offer(work.frame, work.anchor, T_anchor_camera, new_fraction(knowledge) > kWorthFusing);
  } else if (!has_pose(work.tracking)) {
    mix_half(last_good_, shown_.picture);
  }
  if (counted_.since++ % kCountedEvery == 0) {
    counted_.well_known = knowledge_.well_known_fraction();
    if (search_.last.grid)
      counted_.table_tops_known = table_tops_known(model_.parts(), work.T_world_anchor, up_.T_shown_world,
                                                   knowledge_, *search_.last.grid);
    counted_.forecast.add(resources_now(now_s(), counted_.max_memory_bytes, counted_.folder));
  }
  shown_.T_world_camera = up_.T_shown_world * T_world_camera;
  explore(work);
  ScanFacts facts = work.facts;
  if (search_.last.grid && work.tracking)
    facts.moved_fraction =
        moved_fraction(*search_.last.grid, frame, search_.last.T_shown_world * T_world_camera);
  advice_.add(facts, frame.stamp_s);

  show_state(work);
  channel_.publish(shown_);
}

}  // namespace roomradar
