// relocalise.hpp: the pose of a frame in a known map, without an estimate to start from.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <string_view>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

enum class RelocalisationStatus {
  kFound,        ///< the pose agrees with the database in appearance and depth
  kNoKeyframes,  ///< the database is empty
  kNoDepth,      ///< the frame has almost no valid depth
  kNoMatch,      ///< no keyframe looks like this frame
  kNotVerified,  ///< a keyframe looks alike, but its depth disagrees with the frame's
};
std::string_view to_string(RelocalisationStatus status);

struct [[nodiscard]] Relocalisation {
  RelocalisationStatus status = RelocalisationStatus::kNoMatch;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< valid only if found
  std::int64_t keyframe = -1;  ///< index in places.keyframes of the keyframe that verified the pose
  int feature_inliers = 0;     ///< 0 if depth alone decided
  /// Fraction of pixels, measured in both the frame and the preview, that agree within the noise.
  double depth_agreement = 0.0;
  explicit operator bool() const { return status == RelocalisationStatus::kFound; }
};

struct RelocaliseConfig {
  KeyframeDatabaseConfig place;
  int candidates = 6;  ///< max keyframes tried, most similar first
  int min_feature_inliers = 20;
  double min_depth_agreement = 0.7;
};

/// Localises a frame in the keyframe database. ORB matches select keyframes, RANSAC over their 3D points
/// gives a pose, and alignment with the keyframe's depth refines and verifies the pose. If the frame or the
/// database has no colour, tries depth alone against the 40 most similar previews, with a stricter test.
/// Deterministic. Never throws for any frame.
Relocalisation relocalise(const Frame& frame, const KeyframeDatabase& keyframe_database,
                          const RelocaliseConfig& config = {});

}  // namespace roomradar
