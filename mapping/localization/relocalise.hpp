// relocalise.hpp: finds the pose of a frame in a known map without an initial estimate.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

enum class RelocalisationStatus {
  kFound,        ///< the pose agrees with a keyframe in appearance and depth
  kNoKeyframes,  ///< the database is empty
  kNoDepth,      ///< the frame has almost no valid depth
  kNoMatch,      ///< no keyframe looks similar to this frame
  kNotVerified,  ///< a keyframe looks similar, but its depth disagrees with the frame's
};
std::string_view to_string(RelocalisationStatus status);

struct [[nodiscard]] Relocalisation {
  RelocalisationStatus status = RelocalisationStatus::kNoMatch;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< valid only if the status is kFound
  /// Index, in the database's keyframes, of the keyframe that verified the pose; -1: none.
  std::int64_t keyframe = -1;
  int feature_inliers = 0;  ///< number of matched features that agree with the pose; 0 if found by depth
                            ///< alone
  /// Fraction of pixels whose depths agree within the noise. Counts only pixels that are measured both in the
  /// frame and in the keyframe's downsampled depth image.
  double depth_agreement = 0.0;
  explicit operator bool() const { return status == RelocalisationStatus::kFound; }
};

struct RelocaliseConfig {
  KeyframeDatabaseConfig place;
  int candidates = 6;  ///< max number of keyframes tried, most similar first
  int min_feature_inliers = 20;
  double min_depth_agreement = 0.7;
};

/// Localises a frame in the keyframe database. ORB matches select keyframes, and RANSAC over their 3D points
/// gives a pose. Alignment with the keyframe's downsampled depth image refines and verifies the pose. If the
/// frame or the database has no colour, alignment is tried with the 40 keyframes most similar in depth, and
/// verification is stricter. Deterministic. Does not throw, even for corrupt frames.
/// @param accept  returns true for the indices of keyframes that are tried; empty: all
Relocalisation relocalise(const Frame& frame, const KeyframeDatabase& keyframe_database,
                          const RelocaliseConfig& config = {},
                          const std::function<bool(std::size_t)>& accept = {});

}  // namespace roomradar
