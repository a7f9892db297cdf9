// keyframe_database.hpp: keyframe database for relocalisation in a known room.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "mapping/localization/patches.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// One keyframe of the database.
struct MapKeyframe {
  std::int64_t frame_index = 0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< pose of the depth camera
  std::vector<Eigen::Vector3f> points_camera;  ///< m, in this view's depth camera; one per descriptor
  /// ORB descriptors; empty if the source has no colour. Source: Rublee et al., ORB: an efficient alternative
  /// to SIFT or SURF, ICCV 2011.
  std::vector<Descriptor> descriptors;
  std::vector<SurfacePatch> patches;  ///< in this view's depth camera
  Intrinsics preview_camera;
  Image<std::uint16_t> preview_depth_mm;  ///< size of preview_camera; 0: none
};

struct KeyframeDatabase {
  std::vector<MapKeyframe> keyframes;
};

/// Max features, and max patches, per view; bounds the cost of matching each with each.
inline constexpr int kMostDescribed = 10'000;

struct KeyframeDatabaseConfig {
  int features = 800;  ///< max per view, at most kMostDescribed
  int patches = 800;   ///< max per view, at most kMostDescribed
  int preview_width_px = 160;
};

/// Computes the features with their points, the patches and the preview of one frame.
MapKeyframe make_map_keyframe(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                              const KeyframeDatabaseConfig& config = {});

/// Moves the database into another world frame: each pose becomes T_new_old * pose.
void transform(KeyframeDatabase& keyframe_database, const Eigen::Isometry3d& T_new_old);

/// Writes the database as one binary file with a checksum. Throws Error if the file cannot be written.
void write_keyframe_database(const KeyframeDatabase& keyframe_database, const std::filesystem::path& path);

/// Reads a file from write_keyframe_database(). Throws Error naming the file and the fault if it is missing,
/// truncated, altered, or of another version. Sizes are checked before memory is allocated.
KeyframeDatabase read_keyframe_database(const std::filesystem::path& path);

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
