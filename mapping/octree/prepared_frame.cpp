// prepared_frame.cpp: checks a frame, then builds its depth pyramid and collects its hits.
#include "mapping/octree/prepared_frame.hpp"

#include <algorithm>
#include <future>

#include "mapping/types/validity.hpp"

namespace roomradar {
namespace {

FuseStatus fault_of(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  constexpr int kMaxSide_px = 4096;  // pixel indices are computed in float
  if (!depth_fault_of(frame).empty() || std::max(frame.depth_m.width, frame.depth_m.height) > kMaxSide_px)
    return FuseStatus::kInvalidFrame;
  return is_rigid(T_world_camera, 1e-3) ? FuseStatus::kFused : FuseStatus::kInvalidPose;
}

FuseStatus status_of(HitStatus hits) {
  switch (hits) {
    case HitStatus::kNone:
      return FuseStatus::kNothingMeasured;
    case HitStatus::kOutOfBounds:
      return FuseStatus::kOutOfBounds;
    case HitStatus::kCollected:
      break;
  }
  return FuseStatus::kFused;
}

}  // namespace

void prepare_frame(const Frame& frame, const Eigen::Isometry3d& T_world_camera, double resolution_m,
                   const FusionConfig& config, unsigned threads, PreparedFrame& prepared) {
  prepared.T_world_camera = T_world_camera;
  prepared.config = config;
  prepared.config.noise = frame.depth_noise;
  prepared.status = fault_of(frame, T_world_camera);
  if (prepared.status != FuseStatus::kFused) return;
  auto pyramid = std::async(threads > 1 ? std::launch::async : std::launch::deferred, [&] {
    build_pyramid(frame.depth_m, resolution_m, prepared.config, prepared.scratch.pyramid);
  });
  prepared.status =
      status_of(collect_hits(frame, T_world_camera, resolution_m, prepared.config, prepared.scratch));
  if (prepared.status == FuseStatus::kFused) pyramid.get();
}

}  // namespace roomradar
