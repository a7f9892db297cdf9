// locator.hpp: where the camera is in the saved room, frame by frame.
#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "mapping/alignment/align.hpp"
#include "mapping/alignment/view.hpp"
#include "mapping/localization/correlative_search.hpp"
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/localization/patch_matching.hpp"
#include "mapping/localization/pose_hypothesis.hpp"

namespace roomradar {

/// The depth that the room's static model shows at a pose, of the live depth image's size.
using ExpectedDepth = std::function<const DepthImage&(const Eigen::Isometry3d& T_world_camera)>;

/// How a search of the map ended.
enum class SearchEnd {
  kFound,
  kNoCandidate,  ///< neither look nor shape leads anywhere
  kNotCertain,   ///< the best pose does not explain the frame well enough, or leaves a direction open
  kRivalled,     ///< another pose explains it about as well
};
std::string_view to_string(SearchEnd end);

/// What is remembered from frame to frame, and buffers that are reused.
struct Locator {
  ViewConfig live_view{.finest_width_px = 160};  ///< twice as fine is 3 ms slower and no nearer to the truth
  ViewConfig expected_view{.finest_width_px = 160, .noisy = false};  ///< rendered depth needs no smoothing
  AlignConfig align;
  /// Where the depth alone has to fix a pose, or patches speak against what it fixed: the bumps of a mesh are
  /// not to pass for what fixes a direction.
  AlignConfig strict_align{.min_constraint = 0.01F};
  RelocaliseConfig relocalise;
  std::optional<Eigen::Isometry3d> T_world_camera;  ///< of the last frame; nothing while lost
  /// Motion from the frame before to the last one.
  Eigen::Isometry3d T_last_now = Eigen::Isometry3d::Identity();
  int doubtful_frames = 0;  ///< in a row, whose depth speaks against where the camera is taken to be
  int sure_until = 0;       ///< so many more doubtful frames pass before the map is searched again
  /// Where the camera was lost, for some frames after that, and how many have passed.
  std::optional<Eigen::Isometry3d> T_world_lost;
  int lost_frames = 0;

  std::vector<TriedPose> findings;  ///< of the last search
  SearchEnd search_end = SearchEnd::kNoCandidate;

  KnownPatches known;      ///< of the places; made when they are first asked for
  KnownShape known_shape;  ///< likewise
  ViewPyramid live_pyramid, expected_pyramid;
  LiveView live;
  ReferenceView expected;
};

/// Finds the frame's camera: by alignment with the expected depth at the pose predicted from the last motion,
/// or, when that fails, when the depth has spoken against it for three frames, or when nothing is known, by
/// what it sees of the map's patches, by the shape of its depth where gravity is known, or where there is
/// neither colour nor gravity by the map's places. A pose found anew must be fixed in all directions and
/// borne out by depth and patches, and no other pose may explain the frame about as well.
///
/// @param moved_mask  of the frame before: pixels at 255 moved and are left out; empty, or of the depth's
/// size
/// @return with status kTracked or kDegenerate a pose to go on with (in kDegenerate the directions that the
///         room does not fix are the prediction's, or it is the last frame's pose, where the sensor's
///         depth bent and alignment took that for a motion); any other status: not located, the next frame
///         starts anew
/// The expected depth at the pose returned is the last that was asked for.
Tracking locate(Locator& locator, const Frame& frame, const Places& places, const MaskImage& moved_mask,
                const ExpectedDepth& expected_depth);

}  // namespace roomradar
