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

}  // namespace roomradar
