// places.hpp: what is remembered of a room to find the camera in it again.
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

/// One remembered view.
struct Place {
  std::int64_t frame_index = 0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< of the depth camera
  std::vector<Eigen::Vector3f> points_camera;  ///< m, in this view's depth camera; one a descriptor
  /// ORB's; empty where the source has no colour. Source: Rublee et al., ORB: an efficient alternative to
  /// SIFT or SURF, ICCV 2011.
  std::vector<Descriptor> descriptors;
  std::vector<SurfacePatch> patches;  ///< in this view's depth camera
  Intrinsics preview_camera;
  Image<std::uint16_t> preview_depth_mm;  ///< of preview_camera's size; 0: none
};

struct Places {
  std::vector<Place> keyframes;
};

/// No view has more features, nor more patches: each is compared with each.
inline constexpr int kMostDescribed = 10'000;

struct PlaceConfig {
  int features = 800;  ///< at most, a view; up to kMostDescribed
  int patches = 800;   ///< at most, a view; up to kMostDescribed
  int preview_width_px = 160;
};

/// Features with their points, and the preview, of one frame.
Place describe_place(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                     const PlaceConfig& config = {});

/// Moves the places into another world frame: every pose becomes T_new_old * pose.
void transform(Places& places, const Eigen::Isometry3d& T_new_old);

/// Writes places as one binary file with a checksum of its own. Throws Error if the file cannot be written.
void write_places(const Places& places, const std::filesystem::path& path);

/// Reads such a file. Throws Error naming the file and the fault if it is missing, cut short, altered, or of
/// another version; sizes are checked before memory is taken.
Places read_places(const std::filesystem::path& path);

enum class RelocalisationStatus {
  kFound,     ///< the pose fits what was remembered in appearance and in depth
  kNoPlaces,  ///< nothing is remembered
  kNoDepth,   ///< the frame has next to no valid depth
  kNoMatch,   ///< no remembered view looks like this one
  kUnproven,  ///< a view looks alike, but its depth does not agree with the frame's
};
std::string_view to_string(RelocalisationStatus status);

struct [[nodiscard]] Relocalisation {
  RelocalisationStatus status = RelocalisationStatus::kNoMatch;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< only if found
  std::int64_t keyframe = -1;  ///< position in places.keyframes of the view that proved it
  int feature_inliers = 0;     ///< 0 where the depth alone decided
  /// Of the preview's pixels seen by both, the part that agrees within the noise.
  double depth_agreement = 0.0;
  explicit operator bool() const { return status == RelocalisationStatus::kFound; }
};

struct RelocaliseConfig {
  PlaceConfig place;
  int candidates = 6;  ///< views that are tried, the most alike first
  int min_feature_inliers = 20;
  double min_depth_agreement = 0.7;
};

/// Finds the frame's camera among the places: ORB matches vote for views, RANSAC over their 3D points gives a
/// pose, alignment with the view's depth refines it, and the depth must agree. Where either side has no
/// colour, the depth alone is tried against the 40 previews most like it, with a stricter test.
/// Deterministic. Never throws for any frame.
Relocalisation relocalise(const Frame& frame, const Places& places, const RelocaliseConfig& config = {});

}  // namespace roomradar
