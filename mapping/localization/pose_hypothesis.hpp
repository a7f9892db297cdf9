// tried_pose.hpp: is the camera where a search of the map would have it?
#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "mapping/alignment/align.hpp"
#include "mapping/localization/depth_agreement.hpp"
#include "mapping/localization/patch_matching.hpp"

namespace roomradar {

/// A pose that a search of the map tried, and what speaks for it.
struct TriedPose {
  Tracking tracking;
  double uncertainty_m = 0.0;  ///< of the position, one standard deviation, as far as depth and patches say
  PatchProof look;
  Evidence evidence;
};

bool is_near(const Eigen::Isometry3d& T_world_a, const Eigen::Isometry3d& T_world_b, double reach_m,
             double reach_rad);

/// How well the model's depth explains the frame's, of what it has an answer to: from 1, all of it, down.
inline double fit_of(const Evidence& evidence) {
  return evidence.alike_part() - 2.0 * evidence.farther_part();
}
/// The same by depth and by look: from 2 down.
double support_of(const TriedPose& finding);

/// The standard deviation of the camera's position in the direction in which it is greatest, of what the
/// depth and the patches fix; infinite if that is not all.
double uncertainty_m(const Tracking& tracking);

/// Whether enough patches lie where ones like them are known. Where boards or tiles repeat, some twenty do in
/// a wrong place, so where the depth leaves a direction to them there must be more, or next to nothing may
/// speak against the pose.
bool is_proven_by_look(const TriedPose& finding);

/// Whether a part of them is alike, of enough to tell, that patches in a wrong place do not have.
bool is_borne_out(const PatchProof& look);

/// Whether a pose is certain enough by itself: many patches lie where ones like them are known, and the depth
/// does not speak against it; or the depth alone fixes it, next to nothing of the model is seen through, and
/// the patches do not speak against it.
bool is_certain(const TriedPose& finding);

/// Whether another pose explains the frame about as well, so that nobody can say which is the right one: of
/// few patches a good part may be alike in one place and not in its twin by chance.
bool is_rivalled(const TriedPose& best, const std::vector<TriedPose>& findings);

/// Poses so near each other are one place.
inline bool is_same_place(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  constexpr double kSame_m = 0.1, kSame_rad = 0.1;
  return is_near(a, b, kSame_m, kSame_rad);
}

}  // namespace roomradar
