// locator.cpp: alignment with the static model, and a search of the whole map when that fails.
#include "app/locator.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/evidence.hpp"

namespace roomradar {
namespace {

constexpr int kLiveStep_px = 1;  // all pixels of the finest level: a still camera's pose shakes the less

bool is_located(const Tracking& tracking) {
  return tracking.status == TrackStatus::kTracked || tracking.status == TrackStatus::kDegenerate;
}

bool is_near(const Eigen::Isometry3d& T_world_a, const Eigen::Isometry3d& T_world_b, double reach_m,
             double reach_rad) {
  const Eigen::Isometry3d T_a_b = T_world_a.inverse() * T_world_b;
  return T_a_b.translation().norm() < reach_m && Eigen::AngleAxisd(T_a_b.linear()).angle() < reach_rad;
}

/// A Kinect that recalibrates itself bends its depth from one frame to the next, and alignment takes that for
/// a motion, by which edges come to stand where they are not seen. So a motion that nothing announced has to
/// explain no fewer pixels than a camera that stood still would.
bool is_bend_not_motion(const Tracking& tracking, const Eigen::Isometry3d& T_world_predicted,
                        const Eigen::Isometry3d& T_world_before, const DepthImage& depth_m,
                        const ExpectedDepth& expected_depth) {
  constexpr double kSudden_m = 0.03, kSudden_rad = 0.01;
  constexpr double kMoreExplained = 0.005;
  if (is_near(T_world_predicted, tracking.T_world_camera, kSudden_m, kSudden_rad)) return false;
  const double by_motion = evidence_of(depth_m, expected_depth(tracking.T_world_camera)).alike_part();
  return evidence_of(depth_m, expected_depth(T_world_before)).alike_part() > by_motion + kMoreExplained;
}

/// Aligns the live view with the model as seen from T_world_view, from the guess on; once more from where
/// that led if it is far from the view, for then the model showed other surfaces than the camera sees.
Tracking align_with_model(Locator& locator, const Intrinsics& camera, Eigen::Isometry3d T_world_view,
                          const Eigen::Isometry3d& T_world_camera_guess,
                          const ExpectedDepth& expected_depth) {
  constexpr double kFarOff_m = 0.05, kFarOff_rad = 0.05;
  Tracking tracking;
  tracking.T_world_camera = T_world_camera_guess;
  for (int round = 0; round < 2; ++round) {
    make_pyramid(expected_depth(T_world_view), camera, locator.expected_view, locator.expected_pyramid);
    make_reference(locator.expected_pyramid, T_world_view, locator.expected_view, locator.expected);
    tracking = align(locator.live, locator.expected, tracking.T_world_camera, locator.align);
    if (!is_located(tracking) || is_near(T_world_view, tracking.T_world_camera, kFarOff_m, kFarOff_rad))
      break;
    T_world_view = tracking.T_world_camera;
  }
  return tracking;
}

/// A pose that was found by searching, and what speaks for it.
struct Finding {
  Tracking tracking;
  int agreeing = 0;  ///< patches
  Evidence evidence;
};

/// Whether a pose is certain enough by itself. Where boards or tiles repeat, some thirty patches can agree on
/// a wrong one; so few are believed only where the depth fixes the pose in all directions, and next to
/// nothing of the model is seen through.
bool is_certain(const Finding& finding) {
  constexpr int kMany = 45;
  const Evidence& evidence = finding.evidence;
  if (!is_located(finding.tracking)) return false;
  if (finding.agreeing >= kMany)
    return evidence.both > 0.2 * evidence.valid && evidence.alike_part() > 0.3 &&
           evidence.farther_part() < 0.12;
  return finding.tracking && evidence.both > 0.5 * evidence.valid && evidence.alike_part() > 0.9 &&
         evidence.farther < 0.01 * evidence.alike;
}

/// Whether another pose explains the frame about as well, so that nobody can say which is the right one.
bool is_rivalled(const Finding& best, const std::vector<Finding>& findings) {
  constexpr double kSame_m = 0.1, kSame_rad = 0.1;
  return std::any_of(findings.begin(), findings.end(), [&](const Finding& other) {
    if (is_near(best.tracking.T_world_camera, other.tracking.T_world_camera, kSame_m, kSame_rad))
      return false;
    return 2 * other.agreeing > 3 * best.agreeing ||
           (is_located(other.tracking) && 3 * other.agreeing > 2 * best.agreeing &&
            other.evidence.score() > best.evidence.score() - 0.05);
  });
}

/// Looks for the camera in all of the map.
Tracking search(Locator& locator, const Frame& frame, const Places& places,
                const ExpectedDepth& expected_depth) {
  constexpr std::size_t kTried = 4;
  constexpr int kMinAgreeing = 8;
  if (locator.known.empty()) locator.known = known_patches(places);
  std::vector<PoseCandidate> candidates;
  if (frame.colour.empty() || locator.known.empty()) {
    const Relocalisation found = relocalise(frame, places, locator.relocalise);
    if (found) candidates.push_back({found.T_world_camera, 0});
  } else {
    const std::vector<SurfacePatch> seen = describe_patches(frame, locator.relocalise.place.patches);
    candidates = propose_poses(seen, locator.known, kTried, kMinAgreeing);
  }
  std::vector<Finding> findings;
  for (const PoseCandidate& candidate : candidates) {
    if (4 * candidate.agreeing < candidates.front().agreeing) break;
    Finding& finding = findings.emplace_back();
    finding.agreeing = candidate.agreeing;
    finding.tracking = align_with_model(locator, frame.depth_camera, candidate.T_world_camera,
                                        candidate.T_world_camera, expected_depth);
    finding.evidence = evidence_of(frame.depth_m, expected_depth(finding.tracking.T_world_camera));
  }
  const auto best =
      std::max_element(findings.begin(), findings.end(), [](const Finding& a, const Finding& b) {
        return is_located(a.tracking) != is_located(b.tracking) ? is_located(b.tracking)
                                                                : a.evidence.score() < b.evidence.score();
      });
  if (best == findings.end() || !is_certain(*best) || is_rivalled(*best, findings)) return {};
  expected_depth(best->tracking.T_world_camera);
  return best->tracking;
}

/// From the last pose and motion.
Tracking follow(Locator& locator, const Frame& frame, const ExpectedDepth& expected_depth) {
  // So near, the view from the last pose shows what the camera sees now, and it was drawn already.
  constexpr double kNear_m = 0.04, kNear_rad = 0.04;
  const Eigen::Isometry3d& T_world_last = *locator.T_world_camera;
  const Eigen::Isometry3d T_world_predicted = T_world_last * locator.T_last_now;
  Tracking tracking = align_with_model(
      locator, frame.depth_camera,
      is_near(T_world_last, T_world_predicted, kNear_m, kNear_rad) ? T_world_last : T_world_predicted,
      T_world_predicted, expected_depth);
  if (is_located(tracking) &&
      is_bend_not_motion(tracking, T_world_predicted, T_world_last, frame.depth_m, expected_depth)) {
    tracking.status = TrackStatus::kDegenerate;
    tracking.T_world_camera = T_world_last;
  }
  return tracking;
}

/// Where the camera was lost some frames ago it may still be: a hand was before the lens.
Tracking resume(Locator& locator, const Frame& frame, const ExpectedDepth& expected_depth) {
  constexpr int kLongest_frames = 30;
  constexpr double kMinAlike = 0.7, kMaxFarther = 0.08;
  if (!locator.T_world_lost || ++locator.lost_frames > kLongest_frames) return {};
  const Tracking tracking = align_with_model(locator, frame.depth_camera, *locator.T_world_lost,
                                             *locator.T_world_lost, expected_depth);
  const Evidence evidence = evidence_of(frame.depth_m, expected_depth(tracking.T_world_camera));
  const bool holds = is_located(tracking) && 2 * evidence.both > evidence.valid &&
                     evidence.alike_part() > kMinAlike && evidence.farther_part() < kMaxFarther;
  return holds ? tracking : Tracking{};
}

/// What was followed into a place that the depth speaks against for some frames is searched for; what is not
/// found then is lost, unless a good part of the view still fits: things may have been taken away.
void doubt(Locator& locator, const Frame& frame, const Places& places, const ExpectedDepth& expected_depth,
           Tracking& tracking) {
  constexpr double kMinAlike = 0.3, kMaxFarther = 0.25, kHopeless = 0.3;
  constexpr int kPatience_frames = 3, kSure_frames = 30;
  const Evidence evidence = evidence_of(frame.depth_m, expected_depth(tracking.T_world_camera));
  const bool is_doubtful = evidence.alike_part() < kMinAlike || evidence.farther_part() > kMaxFarther;
  locator.doubtful_frames = is_doubtful ? locator.doubtful_frames + 1 : 0;
  if (locator.doubtful_frames < kPatience_frames || --locator.sure_until > 0) return;
  const Tracking found = search(locator, frame, places, expected_depth);
  if (is_located(found)) {
    tracking = found;
  } else if (evidence.alike_part() < kHopeless) {
    tracking = {};
    return;
  }
  locator.sure_until = kSure_frames;
  expected_depth(tracking.T_world_camera);
}

}  // namespace

Tracking locate(Locator& locator, const Frame& frame, const Places& places, const MaskImage& moved_mask,
                const ExpectedDepth& expected_depth) {
  make_pyramid(frame.depth_m, frame.depth_camera, locator.live_view, locator.live_pyramid);
  make_live(locator.live_pyramid, locator.live, moved_mask, kLiveStep_px);

  Tracking tracking;
  if (locator.T_world_camera) {
    tracking = follow(locator, frame, expected_depth);
    if (is_located(tracking)) doubt(locator, frame, places, expected_depth, tracking);
    if (!is_located(tracking)) {
      locator.T_world_lost = locator.T_world_camera;
      locator.T_world_camera.reset();
      locator.lost_frames = locator.doubtful_frames = locator.sure_until = 0;
    }
  }
  if (!is_located(tracking)) {
    make_live(locator.live_pyramid, locator.live, {},
              kLiveStep_px);  // the mask belonged to a pose that no longer holds
    tracking = resume(locator, frame, expected_depth);
    if (!is_located(tracking)) tracking = search(locator, frame, places, expected_depth);
  }

  if (!is_located(tracking)) {
    locator.T_last_now.setIdentity();
    return tracking;
  }
  locator.T_last_now = locator.T_world_camera
                           ? Eigen::Isometry3d(locator.T_world_camera->inverse() * tracking.T_world_camera)
                           : Eigen::Isometry3d::Identity();
  locator.T_world_camera = tracking.T_world_camera;
  return tracking;
}

}  // namespace roomradar
