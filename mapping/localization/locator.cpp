// locator.cpp: alignment with the static model, and a search of the whole map if alignment fails.
#include "mapping/localization/locator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "mapping/alignment/feature_flow.hpp"
#include "mapping/alignment/motion_prior.hpp"
#include "mapping/alignment/stationary_camera.hpp"
#include "mapping/localization/pose_hypothesis.hpp"
#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

/// Standard deviation along a direction up to which depth alone constrains it: that of the systematic errors
/// of an alignment. Where the noise says more, poses were 5 to 25 cm off.
constexpr double kMostUncertain_m = 0.006;
constexpr int kLiveStep_px = 1;  // all pixels of the finest level: less pose jitter

/// Returns true if the depth bent because the Kinect recalibrates, and the camera did not move. Alignment
/// takes such a bend for a motion, which puts edges in wrong places. So a motion that was not predicted must
/// explain about as many pixels as a stationary camera.
bool is_bend_not_motion(const Tracking& tracking, const Eigen::Isometry3d& T_world_predicted,
                        const Eigen::Isometry3d& T_world_before, const DepthImage& depth_m,
                        const ExpectedDepth& expected_depth) {
  constexpr double kSudden_m = 0.03, kSudden_rad = 0.01;
  constexpr double kMoreExplained = 0.005;
  if (is_near(T_world_predicted, tracking.T_world_camera, kSudden_m, kSudden_rad)) return false;
  const double by_motion = depth_agreement_of(depth_m, expected_depth(tracking.T_world_camera)).alike_part();
  return depth_agreement_of(depth_m, expected_depth(T_world_before)).alike_part() >
         by_motion + kMoreExplained;
}

/// Aligns the live view with the model rendered at T_world_view, starting from the guess. If the result is
/// far from T_world_view, the model showed other surfaces than the camera sees, so it renders and aligns once
/// more.
Tracking align_with_model(Locator& locator, const AlignConfig& config, const Intrinsics& camera,
                          Eigen::Isometry3d T_world_view, const Eigen::Isometry3d& T_world_camera_guess,
                          const ExpectedDepth& expected_depth) {
  constexpr double kFarOff_m = 0.05, kFarOff_rad = 0.05;
  Tracking tracking;
  tracking.T_world_camera = T_world_camera_guess;
  for (int round = 0; round < 2; ++round) {
    make_pyramid(expected_depth(T_world_view), camera, locator.expected_view,
                 locator.buffers.expected_pyramid, locator.buffers.live_pyramid.noise);
    make_target_view(locator.buffers.expected_pyramid, T_world_view, locator.expected_view,
                     locator.buffers.expected);
    tracking = align(locator.buffers.live, locator.buffers.expected, tracking.T_world_camera, config);
    if (!has_pose(tracking) || is_near(T_world_view, tracking.T_world_camera, kFarOff_m, kFarOff_rad)) break;
    T_world_view = tracking.T_world_camera;
  }
  return tracking;
}

/// Normal equation of a least-squares correction of a camera pose.
struct NormalEquation {
  Eigen::Matrix<double, 6, 6> H = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> g = Eigen::Matrix<double, 6, 1>::Zero();
};

/// Returns the constraint of matched patches on the camera's twist.
NormalEquation constraint_of(const std::vector<PointPair>& pairs, const Eigen::Isometry3d& T_world_camera) {
  constexpr double kIndependent = 0.25;  // patches share corners, and neighbours share depth errors
  NormalEquation by_patches;
  for (const PointPair& pair : pairs) {
    Eigen::Matrix<double, 3, 6> J;  // Jacobian of a point in the camera by the camera's twist
    J.leftCols<3>().setIdentity();
    for (int k = 0; k < 3; ++k) J.col(3 + k) = Eigen::Vector3d::Unit(k).cross(pair.b);
    const Eigen::Vector3d gap = T_world_camera.inverse() * pair.a - pair.b;
    // A gate is three standard deviations.
    const double weight = kIndependent * 9.0 / (pair.gate_m * pair.gate_m);
    by_patches.H += weight * J.transpose() * J;
    by_patches.g += weight * J.transpose() * gap;
  }
  return by_patches;
}

/// Moves an aligned pose in the directions that depth leaves unconstrained, to bring patches onto their
/// matches. Solves the least squares of both.
void pull(const Eigen::Matrix<double, 6, 6>& by_depth, const std::vector<PointPair>& pairs,
          Tracking& tracking) {
  constexpr double kMostPull_m = 0.3;  // beyond it, the pairs do not constrain the pose either
  constexpr double kLever_m = 1.0;     // a rotation counts as this length per rad
  const NormalEquation by_patches = constraint_of(pairs, tracking.T_world_camera);
  const Eigen::Matrix<double, 6, 6> H = by_depth + by_patches.H;
  const Eigen::Matrix<double, 6, 1> twist = solve_symmetric(H, by_patches.g);
  Eigen::Matrix<double, 6, 1> twist_m = twist;
  twist_m.tail<3>() *= kLever_m;
  if (!(twist_m.norm() < kMostPull_m)) return;
  tracking.T_world_camera = tracking.T_world_camera * retract(twist);
  tracking.information = H;
}

/// Returns true if the model explains the depth as well after the camera moved 6 cm, or rotated by as much,
/// along a direction that `information` leaves unconstrained.
bool slides(const Frame& frame, const Eigen::Isometry3d& T_world_camera, double fit,
            const Eigen::Matrix<double, 6, 6>& information, const ExpectedDepth& expected_depth) {
  // kDistance_m: distance at which rotations are measured.
  constexpr double kSlide_m = 0.06, kDistance_m = 2.0;
  constexpr double kMinLoss = 0.015;  // of the fit: outlines shift by a few pixels
  const SymmetricEigen<6> solved = symmetric_eigen(information);
  for (int i = 0; i < 6 && solved.values(i) < 1e-3; ++i) {
    const Eigen::Matrix<double, 6, 1> direction = solved.vectors.col(i);
    const double reach = direction.head<3>().norm() + kDistance_m * direction.tail<3>().norm();
    for (const double way : {-kSlide_m / reach, kSlide_m / reach}) {
      const Eigen::Isometry3d T_aside = T_world_camera * retract(way * direction);
      if (fit_of(depth_agreement_of(frame.depth_m, expected_depth(T_aside))) > fit - kMinLoss) return true;
    }
  }
  return false;
}

/// Tests a hypothesis. Aligns it with the model, then moves unconstrained directions by patches: first by the
/// pairs that proposed the pose, then by the pairs that coincide at the aligned pose.
PoseHypothesis tried(Locator& locator, const Frame& frame, const std::vector<SurfacePatch>& seen,
                     const PoseCandidate& guess, const ExpectedDepth& expected_depth) {
  constexpr std::size_t kEnough = 10;
  constexpr int kPulls = 3;
  constexpr double kGoodFit = 0.6;
  PoseHypothesis hypothesis;
  const auto align_from = [&](const Eigen::Isometry3d& T_world_camera, const AlignConfig& config) {
    hypothesis.tracking =
        align_with_model(locator, config, frame.depth_camera, T_world_camera, T_world_camera, expected_depth);
    const Eigen::Isometry3d& T_found = hypothesis.tracking.T_world_camera;
    const Eigen::Matrix<double, 6, 6> by_depth = hypothesis.tracking.information;
    hypothesis.appearance = match_patches_at(seen, locator.index.patches, T_found);
    if (hypothesis.tracking.status == TrackStatus::kDegenerate &&
        hypothesis.appearance.alike.size() < guess.pairs.size()) {
      pull(by_depth, guess.pairs, hypothesis.tracking);
      hypothesis.appearance = match_patches_at(seen, locator.index.patches, T_found);
    }
    for (int round = 0; round < kPulls && hypothesis.tracking.status == TrackStatus::kDegenerate &&
                        hypothesis.appearance.alike.size() >= kEnough;
         ++round) {
      pull(by_depth, hypothesis.appearance.alike, hypothesis.tracking);
      hypothesis.appearance = match_patches_at(seen, locator.index.patches, T_found);
    }
  };
  const std::size_t alike_before =
      match_patches_at(seen, locator.index.patches, guess.T_world_camera).alike.size();
  align_from(guess.T_world_camera, locator.align);
  if (alike_before >= kEnough && 3 * hypothesis.appearance.alike.size() < 2 * alike_before)
    align_from(guess.T_world_camera, locator.strict_align);
  hypothesis.agreement =
      depth_agreement_of(frame.depth_m, expected_depth(hypothesis.tracking.T_world_camera));
  if (!is_verified_by_patches(hypothesis) && hypothesis.tracking && fit_of(hypothesis.agreement) > kGoodFit) {
    // Depth alone must constrain the pose.
    const Eigen::Isometry3d& T_found = hypothesis.tracking.T_world_camera;
    const Tracking strict =
        align_with_model(locator, locator.strict_align, frame.depth_camera, T_found, T_found, expected_depth);
    if (!strict && slides(frame, T_found, fit_of(hypothesis.agreement), strict.information, expected_depth)) {
      hypothesis.tracking.status = TrackStatus::kDegenerate;
      hypothesis.tracking.information = strict.information;
    }
  }
  hypothesis.uncertainty_m = uncertainty_m(hypothesis.tracking);
  return hypothesis;
}

/// Uses all pixels: the mask of moved pixels belongs to a pose that is no longer valid.
void look_at_all(Locator& locator) {
  make_source_points(locator.buffers.live_pyramid, locator.buffers.live, {}, kLiveStep_px);
}

/// Localises the frame by many features of one keyframe, such as close to a door, where depth is flat and
/// patches are few. Depth must agree with the keyframe's and the model's.
Tracking search_by_features(const Locator& locator, const Frame& frame,
                            const KeyframeDatabase& keyframe_database, const ExpectedDepth& expected_depth) {
  constexpr int kMany = 100;
  constexpr double kElsewhere_m = 0.5, kElsewhere_rad = 0.5;  // keyframes this near show the same place
  constexpr double kMinKeyframeAgreement = 0.85, kMinAlike = 0.45, kMaxFarther = 0.2, kMinCovered = 0.2;
  const Relocalisation found = relocalise(frame, keyframe_database, locator.relocalise);
  if (!found || found.feature_inliers < kMany || found.depth_agreement < kMinKeyframeAgreement) return {};
  // A second place that looks the same makes the first uncertain.
  const Relocalisation other = relocalise(frame, keyframe_database, locator.relocalise, [&](std::size_t i) {
    return !is_near(keyframe_database.keyframes[i].T_world_camera, found.T_world_camera, kElsewhere_m,
                    kElsewhere_rad);
  });
  if (other && 2 * other.feature_inliers > found.feature_inliers &&
      !is_same_pose(other.T_world_camera, found.T_world_camera))
    return {};
  const DepthAgreement agreement = depth_agreement_of(frame.depth_m, expected_depth(found.T_world_camera));
  if (agreement.both < kMinCovered * agreement.valid || agreement.alike_part() < kMinAlike ||
      agreement.farther_part() > kMaxFarther)
    return {};
  constexpr double kSigma_m = 0.01;  // of a relocalised pose
  Tracking tracking;
  tracking.status = TrackStatus::kTracked;
  tracking.T_world_camera = found.T_world_camera;
  tracking.information = prior_information(kSigma_m, Eigen::Isometry3d::Identity());
  return tracking;
}

/// Searches the whole map: by patches and, if these give no certain pose, by the depth's shape. Without
/// gravity and colour, finds only poses near keyframes with a similar view.
Tracking search(Locator& locator, const Frame& frame, const KeyframeDatabase& keyframe_database,
                const ExpectedDepth& expected_depth) {
  constexpr std::size_t kByLook = 4, kByShape = 8;
  constexpr int kMinAgreeing = 8;
  std::vector<PoseHypothesis>& hypotheses = locator.hypotheses;
  hypotheses.clear();
  locator.search_end = SearchEnd::kNoCandidate;
  const auto judge = [&] {
    const auto best = std::max_element(
        hypotheses.begin(), hypotheses.end(), [](const PoseHypothesis& a, const PoseHypothesis& b) {
          return has_pose(a.tracking) != has_pose(b.tracking) ? has_pose(b.tracking)
                                                              : support_of(a) < support_of(b);
        });
    if (best == hypotheses.end()) return Tracking{};
    locator.search_end = !is_certain(*best)                ? SearchEnd::kNotCertain
                         : is_ambiguous(*best, hypotheses) ? SearchEnd::kAmbiguous
                                                           : SearchEnd::kFound;
    return locator.search_end == SearchEnd::kFound ? best->tracking : Tracking{};
  };
  if (locator.index.patches.empty()) locator.index.patches = build_patch_index(keyframe_database);
  const std::vector<SurfacePatch> seen = describe_patches(frame, locator.relocalise.place.patches);
  const std::vector<PoseCandidate> by_appearance =
      propose_poses(seen, locator.index.patches, kByLook, kMinAgreeing);
  for (const PoseCandidate& candidate : by_appearance)
    if (4 * candidate.agreeing >= by_appearance.front().agreeing)
      hypotheses.push_back(tried(locator, frame, seen, candidate, expected_depth));
  if (!frame.down_camera && (frame.colour.empty() || locator.index.patches.empty())) {
    const Relocalisation by_preview = relocalise(frame, keyframe_database, locator.relocalise);
    if (by_preview)
      hypotheses.push_back(tried(locator, frame, seen, {by_preview.T_world_camera, 0, {}}, expected_depth));
  }
  Tracking found = judge();
  if (!has_pose(found) && !frame.colour.empty() && locator.search_end != SearchEnd::kAmbiguous) {
    found = search_by_features(locator, frame, keyframe_database, expected_depth);
    if (has_pose(found)) locator.search_end = SearchEnd::kFound;
  }
  if (!has_pose(found) && frame.down_camera) {
    if (locator.index.shapes.empty()) locator.index.shapes = shape_index(keyframe_database);
    for (const ShapeCandidate& candidate : search_by_shape(
             frame.depth_m, frame.depth_camera, *frame.down_camera, locator.index.shapes, kByShape))
      hypotheses.push_back(tried(locator, frame, seen, {candidate.T_world_camera, 0, {}}, expected_depth));
    found = judge();
  }
  if (has_pose(found)) expected_depth(found.T_world_camera);
  return found;
}

/// Combines an alignment that started from the recorded prior with it. If the alignment failed or is far off,
/// the recorded pose holds where the model supports it.
Tracking with_recorded(Locator& locator, const Frame& frame, const Eigen::Isometry3d& T_world_prior,
                       const Tracking& aligned, double dt_s, const ExpectedDepth& expected_depth) {
  constexpr double kMinAlike = 0.5, kMost_m = 0.15;
  const double difference_m = constrained_difference_m(T_world_prior, aligned);
  if (has_pose(aligned) && difference_m < kMost_m && !contradicts(locator.prior, difference_m))
    return combine(locator.prior, T_world_prior, aligned, dt_s);
  const double by_prior = depth_agreement_of(frame.depth_m, expected_depth(T_world_prior)).alike_part();
  const double by_alignment =
      has_pose(aligned)
          ? depth_agreement_of(frame.depth_m, expected_depth(aligned.T_world_camera)).alike_part()
          : 0.0;
  if (by_prior > kMinAlike && by_prior >= by_alignment - 0.1) {
    Tracking tracking = aligned;
    tracking.status = TrackStatus::kTracked;
    tracking.T_world_camera = T_world_prior;
    tracking.information = prior_information(locator.prior.sigma_m, Eigen::Isometry3d::Identity());
    return tracking;
  }
  count_contradiction(locator.prior);
  return aligned;
}

/// Resets an aligned pose to the predicted one in the directions that depth constrains weakly. The pose is
/// then kDegenerate.
void predict_weak_directions(const Eigen::Isometry3d& T_world_predicted, Tracking& tracking) {
  Vector6d lever;  // m per m, and m per rad
  lever << 1.0, 1.0, 1.0, kPriorLever_m, kPriorLever_m, kPriorLever_m;
  const Vector6d inverse = lever.cwiseInverse();
  const SymmetricEigen<6> known =
      symmetric_eigen(Matrix6d(inverse.asDiagonal() * tracking.information * inverse.asDiagonal()));
  constexpr double kLeast = 1.0 / (kMostUncertain_m * kMostUncertain_m);
  if (!known.converged || known.values(0) >= kLeast) return;
  const Vector6d difference =
      lever.cwiseProduct(local(T_world_predicted.inverse() * tracking.T_world_camera));
  Vector6d step = Vector6d::Zero();
  Matrix6d information = Matrix6d::Zero();
  for (int i = 0; i < 6; ++i) {
    const Vector6d direction = known.vectors.col(i);
    if (known.values(i) < kLeast) continue;
    step += direction * direction.dot(difference);
    information += known.values(i) * direction * direction.transpose();
  }
  tracking.T_world_camera = T_world_predicted * retract(step.cwiseProduct(inverse));
  tracking.information = lever.asDiagonal() * information * lever.asDiagonal();
  tracking.status = TrackStatus::kDegenerate;
}

/// A pose tracked from the last one.
struct FollowedPose {
  Tracking tracking;
  bool is_bent = false;  ///< see is_bend_not_motion(); the pose is then the last one
};

/// Tracks from the last pose and motion, or from the recorded motion.
FollowedPose follow(Locator& locator, const Frame& frame, double dt_s, const ExpectedDepth& expected_depth) {
  // This near, the view rendered at the last pose shows the same surfaces, and it exists already.
  constexpr double kNear_m = 0.04, kNear_rad = 0.04;
  // No hand changes its motion by more between two frames.
  constexpr double kLeastOff_m = 0.02, kMostSpeed_mps = 1.0, kLeastOff_rad = 0.05, kMostTurn_radps = 3.0;
  constexpr double kStood_m = 0.01, kStood_rad = 0.01;
  const Eigen::Isometry3d& T_world_last = *locator.T_world_camera;
  const std::optional<Eigen::Isometry3d> T_world_prior =
      locator.use_recorded_poses ? predicted_by(locator.prior, frame.T_world_camera) : std::nullopt;
  const Eigen::Isometry3d T_world_predicted = T_world_prior.value_or(T_world_last * locator.T_last_now);
  Tracking tracking = align_with_model(
      locator, locator.align, frame.depth_camera,
      is_near(T_world_last, T_world_predicted, kNear_m, kNear_rad) ? T_world_last : T_world_predicted,
      T_world_predicted, expected_depth);
  if (T_world_prior)
    return {with_recorded(locator, frame, *T_world_prior, tracking, dt_s, expected_depth), false};
  if (has_pose(tracking) &&
      !is_near(T_world_predicted, tracking.T_world_camera, kLeastOff_m + kMostSpeed_mps * dt_s,
               kLeastOff_rad + kMostTurn_radps * dt_s))
    tracking.status = TrackStatus::kDiverged;
  if (has_pose(tracking)) predict_weak_directions(T_world_predicted, tracking);
  const bool stood = is_near(Eigen::Isometry3d::Identity(), locator.T_last_now, kStood_m, kStood_rad);
  const bool is_bent =
      has_pose(tracking) && stood &&
      is_bend_not_motion(tracking, T_world_predicted, T_world_last, frame.depth_m, expected_depth);
  if (is_bent) {
    tracking.status = TrackStatus::kDegenerate;
    tracking.T_world_camera = T_world_last;
  }
  return {tracking, is_bent};
}

/// Returns true if enough patches of the frame coincide with known ones and look like them, and depth and
/// these patches constrain the camera's position. Patches many metres away look alike from decimetres aside,
/// too.
bool is_verified_by_appearance(Locator& locator, const Frame& frame,
                               const KeyframeDatabase& keyframe_database, const Tracking& tracking) {
  constexpr double kMostUncertainByBoth_m = 0.015;
  if (locator.index.patches.empty()) locator.index.patches = build_patch_index(keyframe_database);
  const PatchAgreement appearance =
      match_patches_at(describe_patches(frame, locator.relocalise.place.patches), locator.index.patches,
                       tracking.T_world_camera);
  Tracking by_both = tracking;
  by_both.information += constraint_of(appearance.alike, tracking.T_world_camera).H;
  return is_supported_by_patches(appearance) && uncertainty_m(by_both) < kMostUncertainByBoth_m;
}

/// Resumes at the pose at which tracking was lost some frames ago, such as when a hand covered the lens. In
/// front of a wall, depth would agree even after a motion along the wall, so patches must agree, too.
Tracking resume(Locator& locator, const Frame& frame, const KeyframeDatabase& keyframe_database,
                const ExpectedDepth& expected_depth) {
  constexpr int kLongest_frames = 30;
  constexpr double kMinAlike = 0.7, kMaxFarther = 0.08;
  if (!locator.T_world_lost || ++locator.lost_frames > kLongest_frames) return {};
  const Tracking tracking = align_with_model(locator, locator.align, frame.depth_camera,
                                             *locator.T_world_lost, *locator.T_world_lost, expected_depth);
  const DepthAgreement agreement = depth_agreement_of(frame.depth_m, expected_depth(tracking.T_world_camera));
  const bool holds = has_pose(tracking) && 2 * agreement.both > agreement.valid &&
                     agreement.alike_part() > kMinAlike && agreement.farther_part() < kMaxFarther;
  const bool is_open = tracking.status == TrackStatus::kDegenerate;
  if (!holds || (is_open && !is_verified_by_appearance(locator, frame, keyframe_database, tracking)))
    return {};
  return tracking;
}

/// Verifies the tracked pose. If the depth contradicts the pose for some frames, searches the map. If the
/// search fails, the camera is lost, unless a good part of the view still fits, because objects may have been
/// taken away. If the search finds another place, the predicted motion is reset. Returns false if the map was
/// searched and the camera is lost.
bool verify_tracking(Locator& locator, const Frame& frame, const KeyframeDatabase& keyframe_database,
                     const ExpectedDepth& expected_depth, Tracking& tracking) {
  constexpr double kMinAlike = 0.3, kMaxFarther = 0.25, kHopeless = 0.3;
  constexpr int kPatience_frames = 3, kSure_frames = 30;
  if (locator.unverified_frames == 0 && locator.followed_frames++ % locator.verify_every_n_frames != 0)
    return true;
  const DepthAgreement agreement = depth_agreement_of(frame.depth_m, expected_depth(tracking.T_world_camera));
  const bool is_doubtful = agreement.alike_part() < kMinAlike || agreement.farther_part() > kMaxFarther;
  locator.unverified_frames = is_doubtful ? locator.unverified_frames + 1 : 0;
  if (locator.unverified_frames < kPatience_frames || --locator.recheck_cooldown_frames > 0) return true;
  look_at_all(locator);
  const Tracking found = search(locator, frame, keyframe_database, expected_depth);
  if (has_pose(found)) {
    const bool is_elsewhere = !is_same_pose(found.T_world_camera, tracking.T_world_camera);
    tracking = found;
    if (is_elsewhere) {
      locator.T_world_camera.reset();
      locator.unverified_frames = locator.recheck_cooldown_frames = 0;
      return true;
    }
  } else if (agreement.alike_part() < kHopeless) {
    tracking = {};
    return false;
  }
  locator.recheck_cooldown_frames = kSure_frames;
  expected_depth(tracking.T_world_camera);
  return true;
}

/// Returns the pose, or one near it that explains the depth better, if depth, or depth and patches, prove it.
/// Otherwise returns the pose that many features of one keyframe prove, near or not. Has no pose if nothing
/// is proven.
Tracking prove(Locator& locator, const Frame& frame, const KeyframeDatabase& keyframe_database,
               const Eigen::Isometry3d& T_world_camera, const ExpectedDepth& expected_depth) {
  if (locator.index.patches.empty() && !keyframe_database.keyframes.empty())
    locator.index.patches = build_patch_index(keyframe_database);
  const std::vector<SurfacePatch> seen = describe_patches(frame, locator.relocalise.place.patches);
  const PoseHypothesis hypothesis = tried(locator, frame, seen, {T_world_camera, 0, {}}, expected_depth);
  const bool is_constrained_by_depth =
      !is_weak(hypothesis.tracking) && hypothesis.uncertainty_m < kMostUncertain_m;
  if (!(is_constrained_by_depth || is_verified_by_patches(hypothesis)) || !is_certain(hypothesis)) {
    if (frame.colour.empty()) return {};
    return search_by_features(locator, frame, keyframe_database, expected_depth);
  }
  if (is_bend_not_motion(hypothesis.tracking, T_world_camera, T_world_camera, frame.depth_m, expected_depth))
    return {};
  Tracking proven = hypothesis.tracking;
  proven.status = TrackStatus::kTracked;  // patches constrain what depth does not
  return proven;
}

/// Adds the uncertainty of predicted directions: a hand moves by up to 0.5 m/s.
void add_motion_uncertainty(const Locator& locator, Tracking& tracking) {
  constexpr double kSpeed_mps = 0.5, kLeast_m = 0.01;
  const double sigma_m = kLeast_m + kSpeed_mps * locator.carried_s;
  tracking.information += prior_information(sigma_m, Eigen::Isometry3d::Identity());
}

/// Returns the followed pose if it counts as located, a proven pose near it, or an uncertain one. Directions
/// that depth does not constrain are predicted for kLongest_s at most, and while the position's standard
/// deviation is at most kMost_m. Then a pose must be proven at or near the predicted one, or found by a
/// search. If the depth is bent, patches suffice, since the camera stands.
Tracking verified(Locator& locator, const Frame& frame, const KeyframeDatabase& keyframe_database,
                  double dt_s, const ExpectedDepth& expected_depth, const FollowedPose& followed) {
  Tracking tracking = followed.tracking;
  constexpr double kLongest_s = 0.15, kMost_m = 0.05;
  constexpr int kEvery = 3, kSearchEvery = 9;  // frames between two proofs, and between two searches
  if (tracking.status == TrackStatus::kTracked && !locator.is_uncertain) {
    locator.carried_s = 0.0;
    return tracking;
  }
  locator.carried_s += dt_s;
  Tracking predicted = tracking;
  add_motion_uncertainty(locator, predicted);
  if (!locator.is_uncertain && locator.carried_s <= kLongest_s && uncertainty_m(predicted) <= kMost_m)
    return tracking;
  Tracking proven;
  if (followed.is_bent && is_verified_by_appearance(locator, frame, keyframe_database, tracking)) {
    proven = tracking;
  } else if (locator.uncertain_frames % kEvery == 0) {
    proven = prove(locator, frame, keyframe_database, tracking.T_world_camera, expected_depth);
  } else if (locator.uncertain_frames % kSearchEvery == kSearchEvery - 1) {
    look_at_all(locator);
    proven = search(locator, frame, keyframe_database, expected_depth);
    proven.status = has_pose(proven) ? TrackStatus::kTracked : proven.status;
  }
  if (has_pose(proven)) {
    if (!is_same_pose(proven.T_world_camera, tracking.T_world_camera))
      locator.T_world_camera.reset();  // the jump is not a motion
    locator.carried_s = 0.0;
    locator.is_uncertain = false;
    locator.uncertain_frames = 0;
    return proven;
  }
  locator.is_uncertain = true;
  ++locator.uncertain_frames;
  tracking.status = TrackStatus::kUncertain;
  return tracking;
}

/// Returns true if the images show that the camera has hardly moved since the last frame in which it moved.
bool stands(Locator& locator, const Frame& frame) {
  constexpr int kWidest_px = 320, kLong_frames = 5;
  make_grey(frame.colour, kWidest_px, locator.buffers.grey);
  const int stood_frames = locator.stood_frames < kLong_frames ? 0 : locator.stood_frames;
  if (is_camera_stationary(locator.moved_grey, locator.buffers.grey, stood_frames)) {
    ++locator.stood_frames;
    return true;
  }
  locator.stood_frames = 0;
  std::swap(locator.moved_grey, locator.buffers.grey);
  return false;
}

/// Returns the motion that is expected until the next frame: the mean of the last two, since a single one has
/// the noise of two poses. An uncertain camera is expected to slow down. The correction of an uncertain pose
/// is no motion.
Eigen::Isometry3d next_motion(const Locator& locator, const Tracking& tracking, bool was_uncertain) {
  if (!locator.T_world_camera) return Eigen::Isometry3d::Identity();
  if (was_uncertain && has_pose(tracking)) return locator.T_last_now;
  const Eigen::Isometry3d T_last_now = locator.T_world_camera->inverse() * tracking.T_world_camera;
  if (!has_pose(tracking)) return expected_motion(tracking, T_last_now);
  return retract(0.5 * (local(T_last_now) + local(locator.T_last_now)));
}

}  // namespace

Tracking locate(Locator& locator, const Frame& frame, const KeyframeDatabase& keyframe_database,
                const MaskImage& dynamic_mask, const ExpectedDepth& expected_depth) {
  make_pyramid(frame.depth_m, frame.depth_camera, locator.live_view, locator.buffers.live_pyramid,
               frame.depth_noise);
  make_source_points(locator.buffers.live_pyramid, locator.buffers.live, dynamic_mask, kLiveStep_px);
  constexpr double kShortestStep_s = 1.0 / 60.0, kLongestStep_s = 1.0;  // stamps may be equal
  const std::optional<double> last_stamp_s = std::exchange(locator.last_stamp_s, frame.stamp_s);
  const double dt_s =
      last_stamp_s ? std::clamp(frame.stamp_s - *last_stamp_s, kShortestStep_s, kLongestStep_s) : 0.0;

  if (locator.use_recorded_poses && frame.T_world_camera)
    note_recorded(locator.prior, frame.stamp_s, *frame.T_world_camera);
  const bool was_uncertain = locator.is_uncertain;
  Tracking tracking;
  bool may_be_found = true;  // by a search; one per frame is enough
  // Images show rotations better than depth does, and depth shows an orbit round what is in the middle of the
  // image: if both say that the camera stands, the difference of the poses is noise.
  constexpr double kNoise_m = 0.008, kNoise_rad = 0.006;
  const bool is_standing = stands(locator, frame);
  bool is_held = false;
  if (locator.T_world_camera) {
    if (is_standing) locator.T_last_now.setIdentity();
    const FollowedPose followed = follow(locator, frame, dt_s, expected_depth);
    tracking = followed.tracking;
    // The caller may have set T_world_camera meanwhile.
    const bool is_known = locator.last_tracking.T_world_camera.matrix() == locator.T_world_camera->matrix();
    is_held = is_standing && is_known && !locator.is_uncertain && has_pose(tracking) &&
              !(locator.use_recorded_poses && frame.T_world_camera) &&
              is_near(*locator.T_world_camera, tracking.T_world_camera, kNoise_m, kNoise_rad);
    if (is_held) tracking = locator.last_tracking;
    if (has_pose(tracking))
      may_be_found = verify_tracking(locator, frame, keyframe_database, expected_depth, tracking);
    if (has_pose(tracking) && !is_held)
      tracking = verified(locator, frame, keyframe_database, dt_s, expected_depth,
                          {.tracking = tracking, .is_bent = followed.is_bent});
  }
  if (locator.T_world_camera && !has_guess(tracking)) {
    locator.T_world_lost = locator.T_world_camera;
    locator.T_world_camera.reset();
    locator.lost_frames = locator.unverified_frames = locator.recheck_cooldown_frames = 0;
  }
  if (!has_guess(tracking)) {
    look_at_all(locator);
    tracking = resume(locator, frame, keyframe_database, expected_depth);
    if (!has_pose(tracking) && may_be_found)
      tracking = search(locator, frame, keyframe_database, expected_depth);
    locator.carried_s = 0.0;
    locator.is_uncertain = false;
    locator.uncertain_frames = 0;
    interrupt_prior(locator.prior);
  }

  if (!has_guess(tracking)) {
    locator.T_last_now.setIdentity();
    return tracking;
  }
  if (tracking.status != TrackStatus::kTracked && !is_held) add_motion_uncertainty(locator, tracking);
  locator.T_last_now = next_motion(locator, tracking, was_uncertain);
  locator.T_world_camera = tracking.T_world_camera;
  locator.last_tracking = tracking;
  if (locator.use_recorded_poses && frame.T_world_camera && tracking && !locator.prior.T_world_recorded)
    restart_prior(locator.prior, tracking.T_world_camera, *frame.T_world_camera);
  return tracking;
}

}  // namespace roomradar
