// live_model.cpp: the worker thread that fuses frames and extracts surfaces.
#include "app/scan/live/live_model.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

#include "mapping/surface/surface_extraction.hpp"
#include "mapping/types/system/worker_thread.hpp"

namespace roomradar {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kOpenParts = 4;
constexpr auto kBetweenMeshes = std::chrono::milliseconds(500);

FusionConfig fusion_config() {
  FusionConfig config;
  config.max_range_m = 4.0F;
  config.threads = 1;
  return config;
}

SurfaceConfig surface_config() {
  SurfaceConfig config;
  config.max_deviation_m = 6e-3F;
  config.min_weight = 4e-3F;  // places that were seen once or twice appear, too
  return config;
}

}  // namespace

LiveModel::LiveModel(double cell_m) : cell_m_(cell_m), thread_([this] { serve(); }) {}

LiveModel::~LiveModel() {
  {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

bool LiveModel::offer(std::shared_ptr<const Frame> frame, std::size_t anchor,
                      const Eigen::Isometry3d& T_anchor_camera, bool shows_new) {
  {
    const std::lock_guard lock(mutex_);
    if (is_busy_ || work_) return false;
    work_ = Work{std::move(frame), anchor, T_anchor_camera, shows_new};
  }
  changed_.notify_all();
  return true;
}

std::vector<LiveModelPart> LiveModel::parts() const {
  const std::lock_guard lock(mutex_);
  return parts_;
}

void LiveModel::finish() {
  std::unique_lock lock(mutex_);
  is_finishing_ = true;
  changed_.notify_all();
  changed_.wait(lock, [&] { return !is_finishing_; });
}

void LiveModel::serve() {
  lower_priority();
  Clock::time_point meshed = Clock::now();
  const auto is_changed = [](const Part& part) { return part.is_changed; };
  for (std::unique_lock lock(mutex_);;) {
    const bool has_changed = std::any_of(open_.begin(), open_.end(), is_changed);
    const auto is_called = [&] { return work_ || is_closed_ || is_finishing_; };
    if (has_changed)
      changed_.wait_until(lock, meshed + kBetweenMeshes, is_called);
    else
      changed_.wait(lock, is_called);
    if (is_closed_) return;
    is_busy_ = true;
    const std::optional<Work> work = std::exchange(work_, std::nullopt);
    const bool is_last = is_finishing_ && !work;
    lock.unlock();
    if (work) fuse(*work);
    if (is_last || Clock::now() - meshed >= kBetweenMeshes) {
      for (Part& part : open_)
        if (part.is_changed) extract(part);
      meshed = Clock::now();
    }
    lock.lock();
    is_busy_ = false;
    if (is_last) is_finishing_ = false;
    changed_.notify_all();
  }
}

void LiveModel::fuse(const Work& work) {
  auto part =
      std::find_if(open_.begin(), open_.end(), [&](const Part& open) { return open.anchor == work.anchor; });
  if (part == open_.end()) {
    if (!work.shows_new) return;
    if (open_.size() == kOpenParts) {
      if (open_.back().is_changed) extract(open_.back());
      open_.pop_back();
    }
    const std::lock_guard lock(mutex_);
    parts_.push_back({work.anchor, std::make_shared<const Mesh>()});
    open_.push_front({work.anchor, StaticMap(cell_m_, fusion_config()), false, parts_.size() - 1});
    part = open_.begin();
  }
  open_.splice(open_.begin(), open_, part);
  part->is_changed |= part->map.fuse(*work.frame, work.T_anchor_camera) == FuseStatus::kFused;
}

void LiveModel::extract(Part& part) {
  auto mesh = std::make_shared<const Mesh>(extract_surface(part.map, surface_config()));
  part.is_changed = false;
  const std::lock_guard lock(mutex_);
  parts_[part.index].mesh_anchor = std::move(mesh);
}

}  // namespace roomradar
