// depth_evidence.cpp: what depth alone and registered frames tell; the order of the questions.
#include "app/sources/decisions/depth_evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "app/sources/decisions/compared_frames.hpp"
#include "app/sources/decisions/pose_hypotheses.hpp"
#include "app/sources/formats/median.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "mapping/alignment/align.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

// ---- depth alone ----

/// Statistics of the depth of the sampled frames.
void measure_depth_range(const std::vector<FramePair>& pairs, ComparedFrames& samples,
                         DepthEvidence& evidence) {
  std::vector<double> depths_m;
  std::size_t pixels = 0;
  for (const FramePair& pair : pairs) {
    const ComparedFrame* sample = samples.at(pair.a);
    if (!sample) continue;
    for (std::size_t i = 0; i < sample->depth_m.pixels.size(); i += 37, ++pixels)
      if (const float depth_m = sample->depth_m.pixels[i]; depth_m > 0.0F)
        depths_m.push_back(static_cast<double>(depth_m));
  }
  if (pixels == 0 || depths_m.empty()) return;
  std::sort(depths_m.begin(), depths_m.end());
  const auto quantile = [&](double part) {
    return depths_m[static_cast<std::size_t>(part * static_cast<double>(depths_m.size() - 1))];
  };
  evidence.measured_part = static_cast<double>(depths_m.size()) / static_cast<double>(pixels);
  evidence.median_depth_m = quantile(0.5);
  evidence.near_depth_m = quantile(0.05);
  evidence.far_depth_m = quantile(0.9);
  // Depths that are all equal, and apart from the ones before.
  constexpr double kBelow = 0.97;
  const auto most = std::lower_bound(depths_m.begin(), depths_m.end(), depths_m.back());
  const auto below = std::lower_bound(depths_m.begin(), most, kBelow * depths_m.back());
  const auto equal = static_cast<double>(depths_m.end() - most);
  if (equal > 0.02 * static_cast<double>(depths_m.size()) &&
      static_cast<double>(most - below) < 0.02 * equal && most != depths_m.begin())
    evidence.equal_most_m = depths_m.back();
}

/// Questions a unit that the depths alone contradict. Returns true if it did.
bool question_range(const DecidedRecording& recording, const DepthEvidence& evidence) {
  const RecordingFacts& facts = recording.facts;
  if (evidence.measured_part == 0.0) return false;
  const std::string unit_text = "a unit of " + format_general(recording.depth_unit_m, 4) + " m" +
                                (facts.unit_source.empty() ? "" : " (" + facts.unit_source + ")");
  const auto ask = [&](const std::string& fact, double likely_unit_m) {
    recording.report->add({"unit",
                           "with " + unit_text + " " + fact + "; is the unit of depth another one, such as " +
                               format_general(likely_unit_m, 4) + " m?",
                           0, "--depth-unit " + format_readable(likely_unit_m, 3), true});
    return true;
  };
  if (evidence.equal_most_m) {
    recording.report->add(
        {"images",
         "many depths are exactly " + format_readable(*evidence.equal_most_m, 5) +
             " m, and none is near that; does this value mean that nothing was measured? Write 0 "
             "for it, since it is taken as depth",
         0, "", true});
    return true;
  }
  if (facts.unit_origin == Origin::kOption) return false;
  const double unit_m = recording.depth_unit_m;
  constexpr double kFull = 0.4;  // of the pixels
  const bool is_fifth = std::abs(unit_m - 0.0002) < 1e-9;
  const bool is_phone = facts.rig.depth_noise == kPhoneLidarNoise,
             is_flight = facts.rig.depth_noise == kTimeOfFlightNoise;
  const bool is_kinect =
      facts.rig.depth_noise == DepthNoise{} &&
      (facts.camera_origin == Origin::kAssumed || facts.camera_source.ends_with("camera.json"));
  // People hold a phone close to things; other sensors measure nothing there.
  if (evidence.measured_part > kFull && evidence.median_depth_m < (is_phone                 ? 0.12
                                                                   : is_kinect || is_flight ? 0.45
                                                                                            : 0.3))
    return ask("half of a full image is nearer than " + format_readable(evidence.median_depth_m, 2) + " m",
               is_fifth ? 0.001 : unit_m * (evidence.median_depth_m < 0.06 ? 10.0 : 5.0));
  const double most_m = is_kinect ? 10.5 : is_phone ? 9.0 : is_flight ? 12.0 : 60.0;
  if (evidence.far_depth_m > most_m)
    return ask("a tenth of all depths is beyond " + format_readable(evidence.far_depth_m, 2) +
                   " m, farther than such a sensor measures",
               unit_m / (evidence.far_depth_m < 5.0 * most_m    ? 5.0
                         : evidence.far_depth_m < 10.0 * most_m ? 10.0
                                                                : 1000.0));
  return false;
}

// ---- without poses ----

/// Registers two depth images. Returns nullopt if they cannot be.
std::optional<Eigen::Isometry3d> register_depth(const DepthImage& from, const DepthImage& to,
                                                const Intrinsics& camera, const DepthNoise& noise,
                                                const Eigen::Isometry3d& T_to_from_guess) {
  constexpr ViewConfig kViews{.finest_width_px = 160, .levels = 2, .min_depth_m = 0.05F, .max_depth_m = 8.0F};
  ViewPyramid from_pyramid, to_pyramid;
  make_pyramid(from, camera, kViews, from_pyramid, noise);
  make_pyramid(to, camera, kViews, to_pyramid, noise);
  TargetView target;
  SourcePoints points;
  make_target_view(to_pyramid, Eigen::Isometry3d::Identity(), kViews, target);
  make_source_points(from_pyramid, points, {}, 1);
  const AlignConfig config{.coarsest_level = 1, .finest_level = 0, .iterations = 10, .intensity_sigma = 0.0F};
  const Tracking tracking = align(points, target, T_to_from_guess, config);
  if (!has_pose(tracking)) return std::nullopt;
  return tracking.T_world_camera;
}

/// Registers frames some steps apart, each time from twice the motion before. Returns the disagreement of
/// depth plus that of brightness by place; nullopt where the frames cannot be registered.
std::vector<std::optional<double>> disagreements_when_registered(const std::vector<std::size_t>& places,
                                                                 ComparedFrames& samples,
                                                                 const DepthNoise& noise,
                                                                 const CameraError& error) {
  constexpr std::array<std::size_t, 3> kSteps = {3, 6, 12};
  const Intrinsics camera = without_error(samples.camera(), error);
  std::vector<std::optional<double>> disagreements;
  for (const std::size_t place : places) {
    const ComparedFrame* a = samples.at(place);
    Eigen::Isometry3d T_b_a = Eigen::Isometry3d::Identity();
    std::optional<double> last;
    for (const std::size_t step : kSteps) {
      const ComparedFrame* b = a ? samples.at(place + step) : nullptr;
      const auto T = b ? register_depth(a->depth_m, b->depth_m, camera, noise, T_b_a) : std::nullopt;
      last.reset();
      if (!T) break;
      last = depth_difference(a->depth_m, b->depth_m, camera, *T).disagreement +
             brightness_disagreement(*a, *b, camera, *T).value_or(0.0);
      T_b_a = *T * *T;
    }
    disagreements.push_back(last);
  }
  return disagreements;
}

/// Questions the camera of a recording without poses: under a wrong one, depth images of a camera that turns
/// cannot be registered well.
void question_camera(const DecidedRecording& recording, ComparedFrames& samples) {
  constexpr std::size_t kPlacesRegistered = 8, kLongest = 12, kLeastPlaces = 4;
  constexpr double kBetter = 0.08, kMostPlaces = 0.75, kBetterEverywhere = 0.045, kNearlyAll = 0.85;
  const std::size_t frames = recording.frames.size();
  if (frames < 3 * kLongest || recording.evidence->is_camera_still) return;
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < kPlacesRegistered; ++k)
    places.push_back(k * (frames - 1 - kLongest) / (kPlacesRegistered - 1));
  const DepthNoise& noise = recording.facts.rig.depth_noise;
  const auto now = disagreements_when_registered(places, samples, noise, {});
  double best_gain = 0.0;
  CameraError best;
  std::vector<CameraError> tried;
  for (const double factor : {0.7, 0.77, 0.87, 1.15, 1.3, 1.43})
    tried.push_back({.fx_factor = factor, .fy_factor = factor});
  for (const double factor : {0.77, 1.3}) {
    tried.push_back({.fx_factor = factor});
    tried.push_back({.fy_factor = factor});
  }
  for (const double part : {-0.09, 0.09}) {
    tried.push_back({.principal = {part, 0.0}});
    tried.push_back({.principal = {0.0, part}});
  }
  for (const CameraError& error : tried) {
    const auto then = disagreements_when_registered(places, samples, noise, error);
    std::vector<double> gains;  // of the places where both can be registered
    for (std::size_t k = 0; k < places.size(); ++k)
      if (now[k] && then[k]) gains.push_back(*now[k] - *then[k]);
    if (gains.size() < kLeastPlaces) continue;
    const auto better = std::count_if(gains.begin(), gains.end(), [](double gain) { return gain > 0.0; });
    const double gain = median_of(gains);
    const double part = static_cast<double>(better) / static_cast<double>(gains.size());
    // A smaller gain counts if nearly all places have it.
    const bool is_clear =
        (gain > kBetter && part >= kMostPlaces) ||
        (gain > kBetterEverywhere && part > kNearlyAll && gains.size() + 1 >= places.size());
    if (is_clear && gain > best_gain) best_gain = gain, best = error;
  }
  if (const auto other = other_camera(samples.full_camera(), best))
    recording.report->add(
        {"camera",
         "depth of nearby frames agrees better " + *other + " (" + recording.facts.camera_source + ")", 0,
         "--camera FILE", true});
}

}  // namespace

void question_depth(DecidedRecording& recording, bool is_convention_given) {
  recording.evidence.emplace();
  DepthEvidence& evidence = *recording.evidence;
  ComparedFrames samples(recording);
  const std::size_t frames = recording.frames.size();
  const PoseOf pose_at_position = [&](std::size_t position) { return pose_of(recording, position); };
  const std::vector<FramePair> pairs = choose_pairs(frames, 0.35, pose_at_position);

  measure_depth_range(pairs, samples, evidence);
  evidence.noise_ratio = samples.noise_ratio();
  std::vector<FramePair> far_pairs;
  constexpr std::size_t kSecondApart = 32;
  for (const FramePair& pair : pairs)
    if (pair.a + kSecondApart < frames) far_pairs.push_back({pair.a, pair.a + kSecondApart});
  if (!far_pairs.empty()) {
    evidence.still_difference = mean_difference(far_pairs, samples, [](std::size_t) {
                                  return Eigen::Isometry3d::Identity();
                                }).disagreement;
    evidence.is_camera_still = *evidence.still_difference < 0.65;
  }

  if (evidence.measured_part == 0.0 && !pairs.empty()) {
    recording.report->add(
        {"images", "no pixel of the depth images that were tried holds a depth", 0, "", true});
    return;
  }
  const bool is_questioned = question_range(recording, evidence);
  const auto posed = std::count_if(pairs.begin(), pairs.end(), [&](const FramePair& pair) {
    return pose_of(recording, pair.a) && pose_of(recording, pair.b);
  });
  evidence.posed_pairs = static_cast<std::size_t>(posed);
  if (posed >= 3) {
    if (!is_questioned) question_poses(recording, pairs, samples, is_convention_given);
  } else if (!is_questioned) {
    question_camera(recording, samples);
  }
  const RecordingFacts& facts = recording.facts;
  const bool is_stated = facts.unit_origin != Origin::kFormat && facts.unit_origin != Origin::kAssumed;
  const std::vector<InputDecision> reported = recording.report->decisions();
  const bool is_asked = std::any_of(reported.begin(), reported.end(), [](const InputDecision& decision) {
    return decision.topic == "unit" && decision.is_advice;
  });
  if (facts.is_written_by_many && !is_stated && !evidence.is_scale_confirmed && !is_asked)
    recording.report->add(
        {"unit",
         "nothing in the recording confirms a unit of depth of " + format_general(recording.depth_unit_m, 4) +
             " m" + (facts.unit_source.empty() ? "" : " (" + facts.unit_source + ")") + ": it has no poses" +
             (posed < 3                 ? ""
              : evidence.poses_disagree ? " with which depth agrees"
                                        : " between which the camera moves far enough sideways"),
         0, "--depth-unit M"});
}

}  // namespace roomradar
