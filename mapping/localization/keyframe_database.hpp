// keyframe_database.hpp: keyframes of a map, used for relocalisation in a known room, and their file.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "mapping/localization/feature_index.hpp"
#include "mapping/localization/patches.hpp"
#include "mapping/storage/binary_file.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// One keyframe of the database, with image features, surface patches and a downsampled depth image
/// ("preview").
struct MapKeyframe {
  std::int64_t frame_index = 0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< pose of the depth camera
  /// Surface point of each descriptor, in the frame of this keyframe's depth camera, m.
  std::vector<Eigen::Vector3f> points_camera;
  /// ORB descriptors; empty if the source has no colour. Source: Rublee et al., ORB: an efficient alternative
  /// to SIFT or SURF, ICCV 2011.
  std::vector<Descriptor> descriptors;
  std::vector<SurfacePatch> patches;  ///< in the frame of this keyframe's depth camera
  Intrinsics preview_camera;
  Image<std::uint16_t> preview_depth_mm;  ///< preview: downsampled depth, mm; 0: none
};

/// Two places of the map that look alike, such as two rooms with the same furniture.
struct LookAlike {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();  ///< camera position at this place, m
  /// Maps this place onto the other. For a camera near p_world, the views from T_world_camera and from
  /// T_other_this * T_world_camera are almost the same.
  Eigen::Isometry3d T_other_this = Eigen::Isometry3d::Identity();
};

struct KeyframeDatabase {
  std::vector<MapKeyframe> keyframes;
  std::vector<LookAlike> look_alikes{};  ///< each pair of places in both directions; empty: none are known
  /// Index of the descriptors of the first index.size() keyframes. May be empty: searches compare all
  /// features of keyframes that are not in the index.
  FeatureIndex index{};
};

/// Adds to the database's index all keyframes that are not in it.
void update_index(KeyframeDatabase& keyframe_database);

/// Max number of features, and of patches, per keyframe. The limit bounds the cost of matching all pairs.
inline constexpr int kMostDescribed = 10'000;

struct KeyframeDatabaseConfig {
  int features = 800;  ///< max number of ORB features per keyframe, at most kMostDescribed
  int patches = 800;   ///< max number of patches per keyframe, at most kMostDescribed
  int preview_width_px = 160;
};

/// Computes the features with their surface points, the patches and the depth preview of a frame.
MapKeyframe make_map_keyframe(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                              const KeyframeDatabaseConfig& config = {});

/// Moves the database into another world frame: each pose becomes T_new_old * pose.
void transform(KeyframeDatabase& keyframe_database, const Eigen::Isometry3d& T_new_old);

/// Writes the database to `path`, with a checksum. Throws Error if the file cannot be written.
void write_keyframe_database(const KeyframeDatabase& keyframe_database, const std::filesystem::path& path);

/// Reads a file written by write_keyframe_database(). Throws Error naming the file and the fault if the file
/// is missing, truncated, altered, or of another version. Sizes are checked before memory is allocated.
KeyframeDatabase read_keyframe_database(const std::filesystem::path& path,
                                        FileChecksum checksum = FileChecksum::kCompared);

}  // namespace roomradar
