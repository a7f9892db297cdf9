// depth_evidence.cpp: projects depth of one frame into another one, under different assumptions.
#include "app/sources/decisions/depth_evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include "app/sources/formats/nominal_rig.hpp"
#include "mapping/alignment/align.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

constexpr std::size_t kPlaces = 14;              // of the recording at which frames are compared
constexpr std::array<std::size_t, 6> kApart = {1, 2, 4, 8, 16, 32};  // frames
constexpr double kAgrees = 0.72, kDisagrees = 0.78;  // see DepthDifference::disagreement
constexpr double kClearlyBetter = 0.12;

Intrinsics with_focal(const Intrinsics& camera, double factor) {
  Intrinsics changed = camera;
  changed.fx_px *= factor;
  changed.fy_px *= factor;
  return changed;
}

/// Differences of the points of `from` to the image `to`, m and relative to depth. Returns false if too few
/// points are seen in both.
bool add_differences(const DepthImage& from, const DepthImage& to, const Intrinsics& camera,
                     const Eigen::Isometry3d& T_to_from, std::vector<double>& differences_m, double& sum,
                     std::size_t& count) {
  constexpr double kPoints = 1500.0, kTolerance = 0.02, kNear_m = 1e-3;
  const int step = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(from.pixels.size()) / kPoints)));
  std::size_t valid = 0, both = 0;
  double clipped = 0.0;
  for (int y = step / 2; y < from.height; y += step)
    for (int x = step / 2; x < from.width; x += step) {
      const float depth_m = from.at(x, y);
      if (!(depth_m > 0.0F)) continue;
      ++valid;
      const Eigen::Vector3d p = T_to_from * back_project(camera, x, y, depth_m);
      if (!(p.z() > kNear_m)) continue;
      const Eigen::Vector2d uv = project(camera, p);
      if (!(uv.x() > -0.5 && uv.y() > -0.5 && uv.x() < to.width - 0.5 && uv.y() < to.height - 0.5)) continue;
      const float seen_m = to.at(static_cast<int>(std::lround(uv.x())), static_cast<int>(std::lround(uv.y())));
      if (!(seen_m > 0.0F)) continue;
      const double difference_m = std::abs(p.z() - static_cast<double>(seen_m));
      differences_m.push_back(difference_m);
      clipped += std::min(difference_m / (kTolerance * static_cast<double>(seen_m)), 1.0);
      ++both;
    }
  if (valid == 0 || both * 5 < valid) return false;
  sum += clipped;
  count += both;
  return true;
}

double median_of(std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// A frame that was read for the comparison.
struct Sample {
  DepthImage depth_m;
  std::optional<Eigen::Isometry3d> stated{};  ///< pose as stated
};

/// Two frames that overlap.
struct Pair {
  std::size_t a = 0, b = 0;  ///< positions
};

/// Poses of a position under an assumption; nullopt: none.
using PoseOf = std::function<std::optional<Eigen::Isometry3d>(std::size_t)>;

class Samples {
 public:
  explicit Samples(const DecidedRecording& recording) : recording_(recording) {
    camera_ = recording.facts.rig.depth_camera;
    if (recording.facts.depth_lens != RationalLens{}) {
      correction_.emplace(camera_, recording.facts.depth_lens, recording.facts.name.c_str());
      camera_ = correction_->ideal();
    }
  }
  /// Returns the frame; null if it cannot be read.
  const Sample* at(std::size_t position) {
    const auto [place, is_new] = samples_.try_emplace(position);
    if (is_new) {
      Sample sample;
      try {
        read_depth(recording_, position, sample.depth_m);
        if (correction_) correction_->correct(sample.depth_m);
        place->second = std::move(sample);
      } catch (const Error&) {  // counted when the frame's turn comes
      }
    }
    return place->second ? &*place->second : nullptr;
  }
  [[nodiscard]] const Intrinsics& camera() const { return camera_; }

 private:
  const DecidedRecording& recording_;
  Intrinsics camera_;
  std::optional<LensCorrection> correction_;
  std::map<std::size_t, std::optional<Sample>> samples_;
};

/// Returns pairs of frames between which the camera has moved, by the poses, but not too far. Without poses,
/// frames four apart.
std::vector<Pair> choose_pairs(std::size_t frames, const PoseOf& pose_of_position) {
  constexpr double kTurn_rad = 0.1, kShift_m = 0.12;
  std::vector<Pair> pairs;
  for (std::size_t k = 0; k < kPlaces && frames > 1; ++k) {
    const std::size_t a = k * (frames - 1) / kPlaces;
    const auto T_world_a = pose_of_position(a);
    std::optional<Pair> best;
    for (const std::size_t apart : kApart) {
      const std::size_t b = a + apart;
      if (b >= frames) break;
      const auto T_world_b = pose_of_position(b);
      if (!T_world_a || !T_world_b) {
        if (!T_world_a && apart <= 4) best = Pair{a, b};
        continue;
      }
      best = Pair{a, b};
      const Eigen::Isometry3d T_a_b = T_world_a->inverse() * *T_world_b;
      if (Eigen::AngleAxisd(T_a_b.linear()).angle() > kTurn_rad || T_a_b.translation().norm() > kShift_m) break;
    }
    if (best && (pairs.empty() || pairs.back().a != best->a)) pairs.push_back(*best);
  }
  return pairs;
}

/// Mean difference over all pairs whose frames have poses.
DepthDifference mean_difference(const std::vector<Pair>& pairs, Samples& samples, const PoseOf& pose_of_position,
                                double depth_factor = 1.0, double focal_factor = 1.0) {
  DepthDifference mean{0.0, 0.0};
  std::vector<double> medians_m;
  std::size_t count = 0;
  const Intrinsics camera = with_focal(samples.camera(), focal_factor);
  for (const Pair& pair : pairs) {
    const Sample *a = samples.at(pair.a), *b = samples.at(pair.b);
    const auto T_world_a = pose_of_position(pair.a), T_world_b = pose_of_position(pair.b);
    if (!a || !b || !T_world_a || !T_world_b) continue;
    // Scaling all depths is the same as scaling the camera's motion the other way.
    Eigen::Isometry3d T_b_a = T_world_b->inverse() * *T_world_a;
    T_b_a.translation() /= depth_factor;
    const DepthDifference one = depth_difference(a->depth_m, b->depth_m, camera, T_b_a);
    mean.disagreement += one.disagreement;
    medians_m.push_back(one.median_m * depth_factor);
    ++count;
  }
  if (count == 0) return {};
  mean.disagreement /= static_cast<double>(count);
  mean.median_m = median_of(medians_m);
  return mean;
}

std::string mm_text(double length_m) { return format_readable(1000.0 * length_m, 2) + " mm"; }

// ---- depth alone ----

/// Statistics of the depth of the sampled frames.
void measure_depth_range(const std::vector<Pair>& pairs, Samples& samples, DepthEvidence& evidence) {
  std::vector<double> depths_m;
  std::size_t pixels = 0;
  for (const Pair& pair : pairs) {
    const Sample* sample = samples.at(pair.a);
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
}

/// Measures the noise as the spread of depth about the line through a pixel's neighbours, where these are
/// smooth, relative to the sensor's model.
void measure_noise(const std::vector<Pair>& pairs, Samples& samples, const DepthNoise& noise,
                   DepthEvidence& evidence) {
  constexpr double kOfThree = 1.2247;  // sqrt(1 + 1/4 + 1/4)
  double sum = 0.0;
  std::size_t count = 0;
  for (const Pair& pair : pairs) {
    const Sample* sample = samples.at(pair.a);
    if (!sample) continue;
    const DepthImage& depth_m = sample->depth_m;
    for (int y = 4; y < depth_m.height - 4; y += 7)
      for (int x = 4; x < depth_m.width - 4; x += 7) {
        const float z = depth_m.at(x, y), left = depth_m.at(x - 1, y), right = depth_m.at(x + 1, y);
        if (!(z > 0.0F && left > 0.0F && right > 0.0F)) continue;
        const float sigma_m = depth_sigma_m(noise, z);
        const float difference_m = std::abs(z - 0.5F * (left + right));
        if (difference_m > 5.0F * sigma_m || std::abs(left - right) > 0.02F * z) continue;  // an edge
        const double ratio = static_cast<double>(difference_m / sigma_m) / kOfThree;
        sum += ratio * ratio;
        ++count;
      }
  }
  if (count >= 200) evidence.noise_ratio = std::sqrt(sum / static_cast<double>(count));
}

std::string unit_option(double unit_m) { return "--depth-unit " + format_general(unit_m, 4); }

/// Questions a unit that the depths alone contradict. Returns true if it did.
bool question_range(const DecidedRecording& recording, const DepthEvidence& evidence) {
  const RecordingFacts& facts = recording.facts;
  if (facts.unit_origin == Origin::kOption || evidence.measured_part == 0.0) return false;
  const std::string unit_text = "a unit of " + format_general(recording.depth_unit_m, 4) + " m" +
                                (facts.unit_source.empty() ? "" : " (" + facts.unit_source + ")");
  const auto ask = [&](const std::string& fact, double likely_unit_m) {
    recording.report->add({"unit",
                           "with " + unit_text + " " + fact + "; is the unit of depth another one, such as " +
                               format_general(likely_unit_m, 4) + " m?",
                           0, unit_option(likely_unit_m), true});
    return true;
  };
  const double unit_m = recording.depth_unit_m;
  constexpr double kFull = 0.4;  // of the pixels
  const bool is_fifth = std::abs(unit_m - 0.0002) < 1e-9;
  const bool is_phone = facts.rig.depth_noise == kPhoneLidarNoise, is_flight = facts.rig.depth_noise == kTimeOfFlightNoise;
  // People hold a phone close to things; other sensors measure nothing there.
  if (evidence.measured_part > kFull && evidence.median_depth_m < (is_phone ? 0.12 : 0.3))
    return ask("half of a full image is nearer than " + format_readable(evidence.median_depth_m, 2) + " m",
               is_fifth ? 0.001 : unit_m * (evidence.median_depth_m < 0.06 ? 10.0 : 5.0));
  if (is_flight && evidence.measured_part > 0.2 && evidence.near_depth_m < 0.18)
    return ask("depths down to " + format_readable(evidence.near_depth_m, 2) +
                   " m are nearer than such a sensor measures",
               unit_m * 5.0);
  const bool is_kinect = facts.rig.depth_noise == DepthNoise{} &&
                         (facts.camera_origin == Origin::kAssumed || facts.camera_source.ends_with("camera.json"));
  const double most_m = is_kinect ? 10.5 : is_phone ? 9.0 : is_flight ? 12.0 : 60.0;
  if (evidence.far_depth_m > most_m)
    return ask("a tenth of all depths is beyond " + format_readable(evidence.far_depth_m, 2) +
                   " m, farther than such a sensor measures",
               unit_m / 5.0);
  return false;
}

// ---- poses ----

/// Returns conventions under which poses of this recording may have been written.
std::vector<PoseConvention> conventions_to_try(const RecordingFacts& facts) {
  std::vector<PoseConvention> tried;
  for (const double unit_m : {1.0, 0.001, 0.01})
    for (const bool is_inverse : {false, true})
      for (const bool is_opengl : {false, true})
        for (const bool is_wxyz : {false, true}) {
          if (is_wxyz && !facts.pose_track) continue;  // matrices have no order of a quaternion's numbers
          const PoseConvention convention{is_inverse, is_opengl, is_wxyz, unit_m, 0};
          if (convention != PoseConvention{}) tried.push_back(convention);
        }
  if (!facts.pose_track && !facts.has_pose_times)
    for (const int later_by : {-1, 1}) tried.push_back({.later_by = later_by});
  return tried;
}

void question_poses(DecidedRecording& recording, const std::vector<Pair>& pairs, Samples& samples,
                    bool is_convention_given) {
  DepthEvidence& evidence = *recording.evidence;
  std::map<std::pair<std::size_t, int>, std::optional<Eigen::Isometry3d>> poses;  // as stated
  const auto stated_at = [&](std::size_t position, int later_by) {
    const auto [place, is_new] = poses.try_emplace({position, later_by});
    if (is_new) place->second = stated_pose_of(recording, position, later_by);
    return place->second;
  };
  const auto under = [&](const PoseConvention& convention) -> PoseOf {
    return [&stated_at, &recording, convention](std::size_t position) -> std::optional<Eigen::Isometry3d> {
      const auto stated = stated_at(position, convention.later_by);
      if (!stated) return std::nullopt;
      return in_world(recording.facts, *stated, convention);
    };
  };
  const DepthDifference now = mean_difference(pairs, samples, under(recording.pose_convention));
  evidence.pose_disagreement = now.disagreement;
  evidence.pose_difference_m = now.median_m;
  PoseConvention best = recording.pose_convention;
  DepthDifference best_difference = now;
  for (const PoseConvention& convention : conventions_to_try(recording.facts)) {
    const DepthDifference difference = mean_difference(pairs, samples, under(convention));
    // A shift by one frame changes little; a turn of the axes changes everything.
    const double margin = convention.later_by != 0 ? 0.06 : 0.15;
    if (difference.disagreement < now.disagreement - margin &&
        difference.disagreement < best_difference.disagreement) {
      best = convention;
      best_difference = difference;
    }
  }
  const bool is_better = best != recording.pose_convention && best_difference.disagreement < kAgrees;
  if (is_better && (now.disagreement > kDisagrees || best.later_by != 0)) {
    const std::string found = "depth of nearby frames differs by " + mm_text(now.median_m) + " under the recorded poses, but by " +
                              mm_text(best_difference.median_m) + " if they are " + describe(best);
    if (is_convention_given) {
      recording.report->add({"poses", found + "; they are used as stated", 0, "--poses-convention " + to_string(best), true});
    } else {
      recording.pose_convention = best;
      evidence.pose_disagreement = best_difference.disagreement;
      evidence.pose_difference_m = best_difference.median_m;
      recording.report->add({"poses", found + ", which is assumed", 0, "--poses-convention stated", true});
    }
    return;
  }
  if (now.disagreement > kDisagrees) {
    evidence.poses_disagree = true;
    recording.poses_are_used = is_convention_given;
    recording.report->add(
        {"poses",
         "depth of nearby frames differs by " + mm_text(now.median_m) +
             " under the recorded poses, and agrees under no convention that is tried" +
             (is_convention_given ? "; they are used as stated" : "; the poses are not used"),
         0, "--poses-convention", true});
  }
}

/// Questions unit and focal length by the recorded poses.
void question_scale(DecidedRecording& recording, const std::vector<Pair>& pairs, Samples& samples,
                    bool is_unit_questioned) {
  const PoseOf pose_at_position = [&](std::size_t position) { return pose_of(recording, position); };
  const double now = recording.evidence->pose_disagreement.value_or(1.0);
  double best_factor = 1.0, best = now;
  for (const double factor : {0.1, 0.2, 0.25, 0.4, 0.5, 0.7, 1.4, 2.0, 2.5, 4.0, 5.0, 10.0}) {
    const double difference = mean_difference(pairs, samples, pose_at_position, factor).disagreement;
    if (difference < best) best = difference, best_factor = factor;
  }
  if (best_factor != 1.0 && best < now - kClearlyBetter && best < kAgrees) {
    recording.report->add({"unit",
                           "depth agrees with the recorded poses if it is multiplied by about " +
                               format_general(best_factor, 2) + "; is the unit of depth " +
                               format_general(recording.depth_unit_m * best_factor, 3) +
                               " m, or that of the poses another one?",
                           0, unit_option(recording.depth_unit_m * best_factor), !is_unit_questioned});
    return;
  }
  best_factor = 1.0;
  best = now;
  for (const double factor : {0.6, 0.7, 0.8, 0.9, 1.1, 1.2, 1.3, 1.4}) {
    const double difference = mean_difference(pairs, samples, pose_at_position, 1.0, factor).disagreement;
    if (difference < best) best = difference, best_factor = factor;
  }
  if (best_factor != 1.0 && best < now - kClearlyBetter && best < kAgrees)
    recording.report->add(
        {"camera",
         "depth of nearby frames agrees better with a focal length of about " +
             format_general(best_factor * samples.camera().fx_px, 2) + " px than with " +
             format_general(samples.camera().fx_px, 4) + " px (" + recording.facts.camera_source + ")",
         0, "--camera FILE", true});
}

}  // namespace

DepthDifference depth_difference(const DepthImage& from, const DepthImage& to, const Intrinsics& camera,
                                 const Eigen::Isometry3d& T_to_from) {
  std::vector<double> differences_m;
  double sum = 0.0;
  std::size_t count = 0;
  const bool forward = add_differences(from, to, camera, T_to_from, differences_m, sum, count);
  const bool backward = add_differences(to, from, camera, T_to_from.inverse(), differences_m, sum, count);
  DepthDifference difference;
  difference.median_m = median_of(differences_m);
  if (forward || backward) difference.disagreement = sum / static_cast<double>(count);
  if (forward != backward) difference.disagreement = 0.5 * (difference.disagreement + 1.0);
  return difference;
}

void question_depth(DecidedRecording& recording, bool is_convention_given) {
  recording.evidence.emplace();
  DepthEvidence& evidence = *recording.evidence;
  Samples samples(recording);
  const std::size_t frames = recording.frames.size();
  const PoseOf pose_at_position = [&](std::size_t position) { return pose_of(recording, position); };
  const std::vector<Pair> pairs = choose_pairs(frames, pose_at_position);

  measure_depth_range(pairs, samples, evidence);
  measure_noise(pairs, samples, recording.facts.rig.depth_noise, evidence);
  std::vector<Pair> far_pairs;
  for (const Pair& pair : pairs)
    if (pair.a + kApart.back() < frames) far_pairs.push_back({pair.a, pair.a + kApart.back()});
  if (!far_pairs.empty()) {
    evidence.still_difference =
        mean_difference(far_pairs, samples, [](std::size_t) { return Eigen::Isometry3d::Identity(); }).disagreement;
    evidence.is_camera_still = *evidence.still_difference < 0.65;
  }

  const bool is_questioned = question_range(recording, evidence);
  const auto posed = std::count_if(pairs.begin(), pairs.end(), [&](const Pair& pair) {
    return pose_of(recording, pair.a) && pose_of(recording, pair.b);
  });
  evidence.posed_pairs = static_cast<std::size_t>(posed);
  if (posed >= 3) {
    question_poses(recording, pairs, samples, is_convention_given);
    if (recording.poses_are_used) question_scale(recording, pairs, samples, is_questioned);
  }
}

}  // namespace roomradar
