// recognise_place.hpp: localises a single frame in a large map, and detects ambiguity between similar places.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <string_view>
#include <vector>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/localization/relocalise.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

enum class PlaceStatus {
  kFound,        ///< keyframes agree with the frame in features and depth, all at one pose
  kNoKeyframes,  ///< the database is empty
  kNoDepth,      ///< the frame has almost no valid depth
  kNoColour,     ///< the frame has no colour image, or almost no features
  kNoMatch,      ///< no keyframe matches enough features of the frame
  kNotVerified,  ///< features match, but the depth disagrees
  kAmbiguous,    ///< keyframes at another pose fit about as well
};
std::string_view to_string(PlaceStatus status);

struct [[nodiscard]] RecognisedPlace {
  PlaceStatus status = PlaceStatus::kNoMatch;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< valid if kFound or kAmbiguous
  std::vector<Eigen::Isometry3d> T_world_others;  ///< if kAmbiguous: the other poses that fit about as well
  std::int64_t keyframe = -1;                     ///< index of the best keyframe in the database; -1: none
  /// Number of features matched with the best keyframe that agree with the pose.
  int feature_inliers = 0;
  /// Max number of features that agree with another verified pose; 0: there is no such pose.
  int rival_inliers = 0;
  /// Fraction of pixels, of those visible from frame and keyframe, whose depths agree.
  double depth_agreement = 0.0;
  double overlap = 0.0;  ///< fraction of the frame's depth that the best keyframe sees
  explicit operator bool() const { return status == PlaceStatus::kFound; }
};

/// Localises a frame with colour, as relocalise() does, and then looks for rivals: poses farther than 0.3 m
/// or 0.3 rad away that fit about as well. Rivals are verified by features and depth, and have at least half
/// as many inliers as the found pose. Keyframes more than 3 m from the found pose are searched separately,
/// since the keyframes of one of two similar rooms may fill the list of candidates. Poses implied by
/// look-alikes (KeyframeDatabase::look_alikes) within 2.5 m of the found pose are rivals, too, since the
/// right place may have been recorded from other views only. A pose is dropped as a rival if the depth of
/// keyframes with similar views agrees with the frame clearly less there than at the found pose. Time hardly
/// grows with the database if its index is complete. Deterministic. Does not throw, even for corrupt frames.
/// Thread safe.
RecognisedPlace recognise_place(const Frame& frame, const KeyframeDatabase& keyframe_database,
                                const RelocaliseConfig& config = {});

}  // namespace roomradar
