// keyframe_proof.cpp: alignment and comparison with downsampled depth images of keyframes.
#include "mapping/localization/keyframe_proof.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace roomradar {
namespace {

double rotation_rad(const Eigen::Isometry3d& T) { return Eigen::AngleAxisd(T.linear()).angle(); }

}  // namespace

void make_preview_pyramid(const MapKeyframe& keyframe, const ViewConfig& view, ViewPyramid& pyramid) {
  DepthImage depth_m(keyframe.preview_camera.width_px, keyframe.preview_camera.height_px);
  std::transform(keyframe.preview_depth_mm.pixels.begin(), keyframe.preview_depth_mm.pixels.end(),
                 depth_m.pixels.begin(), [](std::uint16_t mm) { return 0.001F * static_cast<float>(mm); });
  make_pyramid(depth_m, keyframe.preview_camera, view, pyramid);
}

TargetView target_of(const ViewPyramid& preview, const ViewConfig& view) {
  TargetView target;
  make_target_view(preview, Eigen::Isometry3d::Identity(), view, target);
  return target;
}

KeyframeProof prove_with_features(const SourcePoints& live, const MapKeyframe& keyframe,
                                  const KeyframeMatch& match, double min_depth_agreement,
                                  const ViewConfig& view) {
  constexpr double kMaxCorrection_m = 0.12, kMaxCorrection_rad = 0.12, kMinOverlap = 0.2;
  ViewPyramid preview;
  make_preview_pyramid(keyframe, view, preview);
  TargetView target = target_of(preview, view);
  const Tracking t = align(live, target, match.T_a_b, {.coarsest_level = 1, .gate_m = 0.15F});
  KeyframeProof proof;
  proof.T_keyframe_camera = t.T_world_camera;
  proof.agreement = t.inlier_fraction;
  proof.overlap = t.overlap;
  proof.target = std::move(target);
  const Eigen::Isometry3d correction = match.T_a_b.inverse() * t.T_world_camera;
  proof.holds = has_pose(t) && t.overlap > kMinOverlap && t.inlier_fraction >= min_depth_agreement &&
                correction.translation().norm() < kMaxCorrection_m &&
                rotation_rad(correction) < kMaxCorrection_rad;
  return proof;
}

Eigen::Isometry3d pose_by(const KeyframeWitness& witness, const KeyframeDatabase& keyframe_database) {
  return keyframe_database.keyframes[witness.keyframe].T_world_camera * witness.proof.T_keyframe_camera;
}

const KeyframeWitness& best_of(std::span<const KeyframeWitness> witnesses) {
  return *std::max_element(witnesses.begin(), witnesses.end(),
                           [](const KeyframeWitness& a, const KeyframeWitness& b) {
                             return std::pair(a.feature_inliers, a.proof.agreement) <
                                    std::pair(b.feature_inliers, b.proof.agreement);
                           });
}

Eigen::Isometry3d joint_pose(std::span<const KeyframeWitness> witnesses, const KeyframeWitness& best,
                             const SourcePoints& live, const KeyframeDatabase& keyframe_database) {
  constexpr double kAgree_m = 0.15, kAgree_rad = 0.1;
  const Eigen::Isometry3d T_world_best = pose_by(best, keyframe_database);
  std::vector<PosedReference> posed;
  for (const KeyframeWitness& witness : witnesses) {
    const Eigen::Isometry3d gap = T_world_best.inverse() * pose_by(witness, keyframe_database);
    if (gap.translation().norm() > kAgree_m || rotation_rad(gap) > kAgree_rad) continue;
    posed.push_back({&witness.proof.target, keyframe_database.keyframes[witness.keyframe].T_world_camera});
  }
  if (posed.size() < 2) return T_world_best;
  const Tracking refined = align(live, posed, T_world_best, {.coarsest_level = 1});
  return has_pose(refined) ? refined.T_world_camera : T_world_best;
}

PreviewOverlap compare_previews(const MapKeyframe& from, const MapKeyframe& to,
                                const Eigen::Isometry3d& T_to_from, double tolerance_m) {
  constexpr int kStep_px = 4;
  constexpr double kMax_m = 4.0;  // noise grows beyond
  PreviewOverlap overlap;
  for (int y = kStep_px / 2; y < from.preview_depth_mm.height; y += kStep_px)
    for (int x = kStep_px / 2; x < from.preview_depth_mm.width; x += kStep_px) {
      const double depth_m = 1e-3 * from.preview_depth_mm.at(x, y);
      if (depth_m <= 0.0 || depth_m > kMax_m) continue;
      ++overlap.valid;
      const Eigen::Vector3d p = T_to_from * back_project(from.preview_camera, x, y, depth_m);
      if (p.z() < 0.3) continue;
      const Eigen::Vector2d at = project(to.preview_camera, p).array().round();
      if (!(at.x() >= 0.0 && at.y() >= 0.0 && at.x() < to.preview_depth_mm.width &&
            at.y() < to.preview_depth_mm.height))
        continue;
      const double other_m =
          1e-3 * to.preview_depth_mm.at(static_cast<int>(at.x()), static_cast<int>(at.y()));
      if (other_m <= 0.0) continue;
      const double gate_m = 0.06 + 0.03 * p.z() + tolerance_m;
      if (std::abs(other_m - p.z()) < gate_m)
        ++overlap.same;
      else if (other_m > p.z() + gate_m)
        ++overlap.through;
    }
  return overlap;
}

}  // namespace roomradar
