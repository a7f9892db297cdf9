// scan_view.cpp: takes frames from the scan's thread, and prepares the view on a thread of its own.
#include "app/scan/scan_view.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "app/scan/live/table_tops.hpp"
#include "app/scan/scan_picture.hpp"
#include "mapping/odometry/odometry_snapshot.hpp"
#include "mapping/types/system/process_memory.hpp"

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
      max_memory_bytes_(max_memory_bytes),
      folder_(std::move(folder)),
      first_view_(std::move(first_view)),
      thread_([this] { serve(); }) {}

ScanView::~ScanView() {
  {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void ScanView::measure_speed(const Frame& frame, const Tracking& tracking) {
  constexpr double kSmoothed_s = 0.15;
  if (!has_pose(tracking)) {
    last_.reset();
    return;
  }
  if (last_ && frame.stamp_s > last_->stamp_s) {
    const double passed_s = frame.stamp_s - last_->stamp_s;
    const Eigen::Isometry3d moved = last_->T_world_camera.inverse() * tracking.T_world_camera;
    const double share = std::min(passed_s / kSmoothed_s, 1.0);
    speed_mps_ += share * (moved.translation().norm() / passed_s - speed_mps_);
    speed_rad_s_ += share * (Eigen::AngleAxisd(moved.linear()).angle() / passed_s - speed_rad_s_);
  }
  last_ = Pose{frame.stamp_s, tracking.T_world_camera};
}

void ScanView::after_frame(const Frame& frame, const Tracking& tracking, const Odometry& odometry) {
  constexpr std::size_t kRateOver = 30;
  const OdometrySnapshot& state = odometry.state();
  ++frames_;
  seen_s_.push_back(now_s());
  if (seen_s_.size() > kRateOver) seen_s_.pop_front();
  measure_speed(frame, tracking);
  has_moved_ = correct(state, anchors_) || has_moved_;
  {
    const std::lock_guard lock(mutex_);
    if (is_busy_ || work_) return;
  }
  Work work;
  work.frame = std::make_shared<Frame>(frame);
  work.tracking = tracking;
  work.facts = facts_of(frame, tracking);
  work.facts.speed_mps = speed_mps_;
  work.facts.speed_rad_s = speed_rad_s_;
  if (tracking) work.anchor = anchor_for(frame.index, tracking.T_world_camera, state, anchors_);
  work.T_world_anchor = anchors_.T_world_anchor;
  work.has_moved = std::exchange(has_moved_, false);
  work.is_located = state.located;
  work.path_world = path_of(state, tracking);
  if (tracking && wants_keyframes_.exchange(false)) work.keyframes = state.graph.keyframes;
  work.counts.frames = frames_;
  if (seen_s_.size() > 1)
    work.counts.frames_per_s =
        static_cast<double>(seen_s_.size() - 1) / std::max(seen_s_.back() - seen_s_.front(), 1e-6);
  work.counts.keyframes = state.counts.keyframes;
  work.counts.loops = state.graph.loops_found;
  {
    const std::lock_guard lock(mutex_);
    work_ = std::move(work);
  }
  changed_.notify_all();
}

void ScanView::forgot_frames(std::int64_t from_index) {
  forget_frames_from(from_index, anchors_);
  has_moved_ = true;
  last_.reset();
}

void ScanView::serve() {
  for (std::unique_lock lock(mutex_);;) {
    changed_.wait(lock, [&] { return work_ || is_closed_; });
    if (is_closed_) return;
    const Work work = *std::exchange(work_, std::nullopt);
    is_busy_ = true;
    lock.unlock();
    show(work);
    lock.lock();
    is_busy_ = false;
  }
}

/// Estimates the up direction again whenever the number of frames has grown by half.
void ScanView::estimate_up(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  up_.add(frame, T_world_camera);
  if (++up_frames_ < up_due_) return;
  up_due_ += up_due_ / 2 + 1;
  T_shown_world_ = level_rotation(up_.estimate().up_world);
}

/// Starts computing the explored space and the next view on another thread, about once a second, and takes
/// the results.
void ScanView::explore(const Work& work) {
  using Clock = std::chrono::steady_clock;
  constexpr auto kEvery = std::chrono::seconds(1);
  constexpr double kReached_m = 0.25, kReached_rad = 0.35;
  if (search_.valid() && search_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    explored_ = search_.get();
    holes_ = numbered(explored_.holes, holes_);
  }
  if (!search_.valid() && !work.keyframes.empty()) {
    searched_ = Clock::now();
    search_ = std::async(std::launch::async, [keyframes = work.keyframes, T_shown_world = T_shown_world_,
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
  if (!search_.valid() && Clock::now() - searched_ > kEvery) wants_keyframes_ = true;
  const std::optional<NextView> next = next_view(work);
  if (!next || !work.tracking) return;
  const Eigen::Isometry3d left = next->T_world_camera.inverse() * shown_.T_world_camera;
  if (left.translation().norm() < kReached_m && Eigen::AngleAxisd(left.linear()).angle() < kReached_rad)
    (first_view_ && work.is_located ? first_view_ : explored_.next_view).reset();
}

/// Returns the view to go to, in the shown world.
std::optional<NextView> ScanView::next_view(const Work& work) const {
  if (!first_view_ || !work.is_located) return explored_.next_view;
  NextView next = *first_view_;
  next.T_world_camera = T_shown_world_ * next.T_world_camera;
  return next;
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
  if (since_counted_++ % kCountedEvery == 0) {
    well_known_ = knowledge_.well_known_fraction();
    if (explored_.grid)
      table_tops_known_ =
          table_tops_known(model_.parts(), work.T_world_anchor, T_shown_world_, knowledge_, *explored_.grid);
    forecast_.add(resources_now(now_s(), max_memory_bytes_, folder_));
  }
  shown_.T_world_camera = T_shown_world_ * T_world_camera;
  explore(work);
  ScanFacts facts = work.facts;
  if (explored_.grid && work.tracking)
    facts.moved_fraction = moved_fraction(*explored_.grid, frame, explored_.T_shown_world * T_world_camera);
  advice_.add(facts, frame.stamp_s);

  shown_.frame_index = frame.index;
  shown_.stamp_s = frame.stamp_s;
  shown_.status = work.tracking.status;
  shown_.fault = advice_.fault();
  shown_.relative_speed = relative_speed(work.facts);
  shown_.camera = frame.depth_camera;
  shown_.path_world = work.path_world;
  for (Eigen::Vector3f& position : shown_.path_world)
    position = T_shown_world_.linear().cast<float>() * position;
  shown_.next_view.reset();
  if (const std::optional<NextView> next = next_view(work); next && work.tracking)
    shown_.next_view =
        ShownNextView{next->T_world_camera, way_to(*next, shown_.T_world_camera, Eigen::Vector3d::UnitZ())};
  shown_.holes = holes_;
  shown_.parts.clear();
  for (const LiveModelPart& part : model_.parts())
    if (part.anchor < work.T_world_anchor.size() && work.T_world_anchor[part.anchor])
      shown_.parts.push_back({part.mesh_anchor, T_shown_world_ * *work.T_world_anchor[part.anchor]});
  shown_.counts = work.counts;
  shown_.counts.seen_m2 = seen_.total_m2();
  shown_.counts.well_known = well_known_;
  shown_.counts.table_tops_known = table_tops_known_;
  shown_.counts.memory_bytes = resident_bytes();
  shown_.counts.left_s = forecast_.left_s();
  channel_.publish(shown_);
}

}  // namespace roomradar
