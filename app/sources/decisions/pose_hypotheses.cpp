// pose_hypotheses.cpp: measures each hypothesis on the same pairs of frames, and fits amounts one by one.
#include "app/sources/decisions/pose_hypotheses.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

// See DepthDifference::disagreement.
constexpr double kSurelyAgrees = 0.30, kDisagrees = 0.75, kFarDisagrees = 0.80, kDoubtful = 0.70,
                 kClearlyBetter = 0.07;
std::string mm_text(double length_m) { return format_readable(1000.0 * length_m, 2) + " mm"; }
/// What may be wrong with a recording that has poses.
struct Hypothesis {
  PoseConvention convention{};
  double depth_factor = 1.0;  ///< times which depth is right
  CameraError camera{};
  double near = 1.0, far = 1.0;  ///< DepthDifference::disagreement over near and far pairs
  double brightness = 0.0;       ///< mean_brightness_disagreement() over far pairs; 0 if there is no texture
  double median_m = 0.0;         ///< DepthDifference::median_m over near pairs
  bool is_clear = true;          ///< most pairs agree better under it
  [[nodiscard]] double both() const { return 0.5 * (near + far + brightness); }
};

/// Returns the hypotheses other than that all is right.
std::vector<Hypothesis> hypotheses_of(const RecordingFacts& facts, const PoseConvention& now) {
  std::vector<Hypothesis> tried;
  const auto add = [&](const PoseConvention& convention) {
    if (convention != now) tried.push_back({.convention = convention});
  };
  for (const double unit_m : {1.0, 0.001, 0.01})
    for (const bool is_inverse : {false, true})
      for (const bool is_opengl : {false, true})
        for (const bool is_wxyz : {false, true})
          if (!is_wxyz || facts.pose_track ||
              facts.has_quaternions)  // matrices have no order of a quaternion's numbers
            add({is_inverse, is_opengl, is_wxyz, unit_m, 0});
  if (!facts.pose_track && !facts.has_pose_times)
    for (const int later_by : {-1, 1, -2, 2, -3, 3, -4, 4, -6, 6, -8, 8, -10, 10})
      add({.later_by = later_by});
  else  // poses with stamps belong to no frame, but their clock may be off
    for (const int later_by : {-2, 2, -3, 3, -4, 4, -6, 6, -8, 8}) add({.later_by = later_by});
  for (const double factor : {0.05, 0.1, 0.2, 0.25, 0.33, 0.5, 0.7, 1.4, 2.0, 3.0, 4.0, 5.0, 10.0, 20.0})
    tried.push_back({.convention = now, .depth_factor = factor});
  for (const double factor : {0.6, 0.7, 0.77, 0.85, 1.15, 1.3, 1.4, 1.6})
    tried.push_back({.convention = now, .camera = {.fx_factor = factor, .fy_factor = factor}});
  return tried;
}

/// A quantity that may be wrong by any amount, as a vector of up to three numbers.
struct Fitted {
  std::size_t numbers = 1;
  double step = 0.0;   ///< first step of the search
  double least = 0.0;  ///< amounts below are within what cameras and poses of working recordings differ by
  void (*add)(Hypothesis&, const Eigen::Vector3d&) = nullptr;
};

/// Fitted one by one, so that none of them explains the fault of another one.
constexpr std::array kFitted = {
    // scale of depth, logarithm
    Fitted{1, 0.07, 0.06,
           [](Hypothesis& h, const Eigen::Vector3d& by) { h.depth_factor *= std::exp(by.x()); }},
    // focal lengths, logarithms
    Fitted{2, 0.15, 0.1,
           [](Hypothesis& h, const Eigen::Vector3d& by) {
             h.camera.fx_factor *= std::exp(by.x());
             h.camera.fy_factor *= std::exp(by.y());
           }},
    // principal point, part of the image's width
    Fitted{2, 0.06, 0.05,
           [](Hypothesis& h, const Eigen::Vector3d& by) { h.camera.principal += by.head<2>(); }},
    // axes of the camera, rad
    Fitted{3, 0.05, 0.05, [](Hypothesis& h, const Eigen::Vector3d& by) { h.camera.turn_rad += by; }},
    // position of the camera, m
    Fitted{3, 0.05, 0.08, [](Hypothesis& h, const Eigen::Vector3d& by) { h.camera.shift_m += by; }},
};

/// Returns the hypothesis with one quantity changed as long as that lowers both(): steps along each number,
/// which are halved when none lowers it. `measure` fills a hypothesis. Returns nullopt if the gain is small,
/// or the change.
std::optional<Hypothesis> fit(const Fitted& fitted, const Hypothesis& now,
                              const std::function<void(Hypothesis&)>& measure) {
  constexpr int kMostRounds = 8;
  constexpr double kLeastGain = 0.06, kLargeAmount = 3.6, kLeastMedianGain = 0.1;
  Hypothesis fit = now;
  Eigen::Vector3d amount = Eigen::Vector3d::Zero();
  double step = fitted.step;
  for (int round = 0; round < kMostRounds && step > 0.2 * fitted.step; ++round) {
    Hypothesis best = fit;
    Eigen::Vector3d best_by = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < fitted.numbers; ++k)
      for (const double sign : {-1.0, 1.0}) {
        const Eigen::Vector3d by = sign * step * Eigen::Vector3d::Unit(static_cast<Eigen::Index>(k));
        Hypothesis next = fit;
        fitted.add(next, by);
        measure(next);
        if (next.both() < best.both()) best = next, best_by = by;
      }
    if (best_by.isZero())
      step *= 0.5;
    else
      fit = best, amount += best_by;
  }
  // A large amount with a small gain is one that the motion does not determine.
  const double least_gain = kLeastGain * std::max(1.0, amount.norm() / (kLargeAmount * fitted.least));
  if (fit.both() > now.both() - least_gain || amount.norm() < fitted.least ||
      fit.median_m > (1.0 - kLeastMedianGain) * now.median_m)
    return std::nullopt;
  return fit;
}

/// Returns the words "turned by ..." or "about ... away ..."; nullopt if the camera is where the poses are.
std::optional<std::string> other_place(const CameraError& error) {
  constexpr double kDegrees = 57.29577951308232;
  if (!error.turn_rad.isZero())
    return "turned by about " + format_readable(kDegrees * error.turn_rad.norm(), 2) +
           " degrees from their axes";
  if (!error.shift_m.isZero())
    return "about " + format_readable(error.shift_m.norm(), 2) + " m from their origin";
  return std::nullopt;
}

void adopt_or_advise(DecidedRecording& recording, const Hypothesis& now, const Hypothesis& best,
                     const Intrinsics& camera, bool is_convention_given) {
  DepthEvidence& evidence = *recording.evidence;
  InputReport& report = *recording.report;
  const bool have_times = recording.facts.pose_track || recording.facts.has_pose_times;
  // A short recording is one motion, of which a fault of scale or camera may explain what noise has done.
  constexpr std::size_t kLong = 150;
  constexpr double kMuchBetter = 0.15;
  const bool is_sure =
      best.is_clear && (recording.frames.size() >= kLong || best.both() < now.both() - kMuchBetter);
  if (best.convention.later_by != 0 && have_times) {
    const std::size_t last = recording.frames.size() - 1;
    const double period_s =
        (recording.frames[last].stamp_s - recording.frames[0].stamp_s) / static_cast<double>(last);
    report.add({"poses",
                "depth of nearby frames differs by " + mm_text(now.median_m) +
                    " under the recorded poses, but by " + mm_text(best.median_m) + " under those " +
                    format_readable(std::abs(best.convention.later_by) * period_s, 2) + " s " +
                    (best.convention.later_by > 0 ? "later" : "earlier") +
                    "; is their clock another one than that of the images? They are used as stamped",
                0, "--poses tracked", true});
  } else if (best.depth_factor != 1.0) {
    const double unit_m = recording.depth_unit_m * best.depth_factor;
    report.add({"unit",
                "depth agrees with the recorded poses if it is multiplied by about " +
                    format_readable(best.depth_factor, 2) + "; is the unit of depth " +
                    format_readable(unit_m, 3) + " m, or that of the poses another one?",
                0, "--depth-unit " + format_readable(unit_m, 3), is_sure});
  } else if (const auto other = other_camera(camera, best.camera)) {
    report.add({"camera",
                "depth of nearby frames agrees better " + *other + " (" + recording.facts.camera_source + ")",
                0, "--camera FILE", is_sure});
  } else if (const auto place = other_place(best.camera)) {
    report.add({"poses",
                "depth of nearby frames differs by " + mm_text(now.median_m) +
                    " under the recorded poses, but by " + mm_text(best.median_m) +
                    " if the depth camera is " + *place +
                    "; are they the poses of another frame than the depth camera's?" +
                    (recording.poses_are_used ? "" : " They are not used"),
                0, "--poses tracked", is_sure});
  } else {
    const std::string found = "depth of nearby frames differs by " + mm_text(now.median_m) +
                              " under the recorded poses, but by " + mm_text(best.median_m) +
                              " if they are " + describe(best.convention);
    if (is_convention_given) {
      report.add({"poses", found + "; they are used as stated", 0,
                  "--poses-convention " + to_string(best.convention), true});
      return;
    }
    recording.pose_convention = best.convention;
    evidence.pose_disagreement = best.near;
    evidence.pose_difference_m = best.median_m;
    report.add({"poses", found + ", which is assumed", 0, "--poses-convention stated", true});
  }
}

/// Measures hypotheses about one recording on pairs of its frames. All are measured with the frames that have
/// a pose as recorded. Else, where every second frame has one, poses that are a frame late would be compared
/// at other frames.
class Trial {
 public:
  /// Measures the recording as it is. Keeps references to all arguments.
  Trial(const DecidedRecording& recording, const std::vector<FramePair>& near_pairs, ComparedFrames& samples)
      : recording_(recording), near_pairs_(near_pairs), samples_(samples) {
    now_.convention = recording.pose_convention;
    far_pairs_ = far_pairs_of(now_.convention);
    measure_on(near_pairs_, far_pairs_, now_);
  }

  /// Returns the hypothesis that all is right.
  [[nodiscard]] const Hypothesis& now() const { return now_; }

  /// Returns the poses under a convention.
  PoseOf under(const PoseConvention& convention) {
    return [this, convention](std::size_t position) -> std::optional<Eigen::Isometry3d> {
      if (!stated(position, recording_.pose_convention.later_by)) return std::nullopt;
      const auto& pose = stated(position, convention.later_by);
      if (!pose) return std::nullopt;
      return in_world(recording_.facts, *pose, convention);
    };
  }

  /// Fills what a hypothesis is compared by. It has the recording's later_by.
  void measure(Hypothesis& hypothesis) {
    measure_on(near_pairs_,
               hypothesis.convention.unit_m == now_.convention.unit_m ? far_pairs_
                                                                      : far_pairs_of(hypothesis.convention),
               hypothesis);
  }

  /// The same for poses of other frames. They exist for other pairs: a shift is compared with the poses as
  /// recorded on the pairs that have both.
  void measure_shift(Hypothesis& hypothesis) {
    constexpr std::size_t kLeastShifted = 6;  // pairs
    const PoseOf pose = under(hypothesis.convention);
    const auto posed = [&](std::vector<FramePair> pairs) {
      std::erase_if(pairs, [&](const FramePair& pair) { return !pose(pair.a) || !pose(pair.b); });
      return pairs;
    };
    const std::vector<FramePair> near = posed(near_pairs_), far = posed(far_pairs_);
    if (near.size() < kLeastShifted) return;  // stays at its worst
    Hypothesis same{.convention = now_.convention};
    measure_on(near, far, hypothesis);
    measure_on(near, far, same);
    hypothesis.near += now_.near - same.near;
    hypothesis.far += now_.far - same.far;
    hypothesis.brightness += now_.brightness - same.brightness;
  }

  /// Returns whether depth agrees much less if it is halved or doubled.
  bool confirms_scale(const Hypothesis& right) {
    const std::vector<FramePair> far_of_right = far_pairs_of(right.convention);
    bool is_confirmed = true;
    for (const double factor : {0.5, 2.0}) {
      Hypothesis scaled{.convention = right.convention, .depth_factor = factor};
      measure_on(near_pairs_, far_of_right, scaled);
      is_confirmed &= scaled.both() > right.both() + kClearlyBetter;
    }
    return is_confirmed;
  }

  /// A fault of the camera or the convention shows in nearly all pairs; noise helps some and harms others.
  bool is_better_in_most(const Hypothesis& hypothesis) {
    constexpr double kBetter = 0.01, kMostPairs = 0.7;
    if (as_recorded_.empty()) as_recorded_ = disagreements(now_);
    const std::vector<std::optional<double>> fitted = disagreements(hypothesis);
    std::size_t better = 0, compared = 0;
    for (std::size_t k = 0; k < fitted.size(); ++k) {
      if (!fitted[k] || !as_recorded_[k]) continue;
      ++compared;
      better += *fitted[k] < *as_recorded_[k] - kBetter ? 1 : 0;
    }
    return static_cast<double>(better) >= kMostPairs * static_cast<double>(compared);
  }

 private:
  const std::optional<Eigen::Isometry3d>& stated(std::size_t position, int later_by) {
    const auto [place, is_new] = stated_.try_emplace({position, later_by});
    if (is_new) place->second = stated_pose_of(recording_, position, later_by);
    return place->second;
  }

  /// By poses in millimetres all frames are far apart, so the far pairs of each unit are its own.
  std::vector<FramePair> far_pairs_of(const PoseConvention& convention) {
    std::vector<FramePair> chosen = choose_pairs(recording_.frames.size(), 0.8, under(convention));
    for (const FramePair& pair : choose_shifted_pairs(recording_.frames.size(), under(convention)))
      chosen.push_back(pair);
    return chosen;
  }

  void measure_on(const std::vector<FramePair>& near_of, const std::vector<FramePair>& far_of,
                  Hypothesis& hypothesis) {
    const PoseOf pose = under(hypothesis.convention);
    const DepthDifference near =
        mean_difference(near_of, samples_, pose, hypothesis.depth_factor, hypothesis.camera);
    hypothesis.near = near.disagreement;
    hypothesis.median_m = near.median_m;
    hypothesis.far =
        mean_difference(far_of, samples_, pose, hypothesis.depth_factor, hypothesis.camera).disagreement;
    hypothesis.brightness =
        mean_brightness_disagreement(far_of, samples_, pose, hypothesis.depth_factor, hypothesis.camera)
            .value_or(0.0);
  }

  /// Returns the disagreement of each near and far pair.
  std::vector<std::optional<double>> disagreements(const Hypothesis& hypothesis) {
    std::vector<std::optional<double>> all;
    for (const auto* pairs : {&near_pairs_, &std::as_const(far_pairs_)})
      for (const auto one : pair_disagreements(*pairs, samples_, under(hypothesis.convention),
                                               hypothesis.depth_factor, hypothesis.camera))
        all.push_back(one);
    return all;
  }

  const DecidedRecording& recording_;
  const std::vector<FramePair>& near_pairs_;
  ComparedFrames& samples_;
  std::map<std::pair<std::size_t, int>, std::optional<Eigen::Isometry3d>> stated_;  // by frame and later_by
  std::vector<FramePair> far_pairs_;                                                // as recorded
  Hypothesis now_;
  std::vector<std::optional<double>> as_recorded_;
};

/// Returns the best hypothesis of the list that is clearly better than the recording as it is; else that.
Hypothesis best_of(std::vector<Hypothesis> tried, Trial& trial) {
  const Hypothesis& now = trial.now();
  Hypothesis best = now;
  for (Hypothesis& hypothesis : tried) {
    if (hypothesis.convention.later_by != now.convention.later_by)
      trial.measure_shift(hypothesis);
    else
      trial.measure(hypothesis);
    if (hypothesis.both() < now.both() - kClearlyBetter && hypothesis.both() < best.both() &&
        trial.is_better_in_most(hypothesis))
      best = hypothesis;
  }
  return best;
}

/// Not all shifts were tried: goes on from a shifted hypothesis to the best one near by.
void refine_shift(Trial& trial, Hypothesis& best) {
  constexpr int kMostLate = 30;  // frames
  for (bool goes_on = best.convention.later_by != 0; goes_on;) {
    goes_on = false;
    for (const int step : {-1, 1}) {
      Hypothesis next = best;
      next.convention.later_by += step;
      if (std::abs(next.convention.later_by) > kMostLate) continue;
      trial.measure_shift(next);
      if (next.both() < best.both()) best = next, goes_on = true;
    }
  }
}

/// Returns what fits with one quantity changed, best first.
std::vector<Hypothesis> fits_of(Trial& trial) {
  std::vector<Hypothesis> fits;
  for (const Fitted& fitted : kFitted)
    if (const auto fitting = fit(fitted, trial.now(), [&](Hypothesis& next) { trial.measure(next); });
        fitting) {
      fits.push_back(*fitting);
      fits.back().is_clear = trial.is_better_in_most(*fitting);
    }
  std::sort(fits.begin(), fits.end(),
            [](const Hypothesis& a, const Hypothesis& b) { return a.both() < b.both(); });
  return fits;
}

/// Reports that nothing explains how the depth differs under the recorded poses, and whether they are used.
void report_unexplained(DecidedRecording& recording, const Hypothesis& now, std::size_t agreeing,
                        std::size_t compared, bool is_convention_given) {
  const bool disagrees = now.near > kDisagrees || now.far > kFarDisagrees;
  // A hand before the lens, or a stretch of wrong poses, makes some pairs disagree, and wrong poses all of
  // them.
  constexpr double kMostAgree = 0.5;
  if (disagrees && static_cast<double>(agreeing) >= kMostAgree * static_cast<double>(compared)) {
    recording.report->add({"poses",
                           "depth of nearby frames disagrees under the recorded poses in " +
                               std::to_string(compared - agreeing) + " of " + std::to_string(compared) +
                               " places, and agrees in the others; they are used",
                           0, "--poses tracked", true});
  } else if (!disagrees && now.far > kDoubtful) {
    recording.report->add(
        {"poses",
         "depth of frames some way apart differs more than usual under the recorded poses, by " +
             mm_text(now.median_m) + " between near ones; they are used",
         0, "--poses tracked", true});
  } else if (disagrees) {
    recording.evidence->poses_disagree = true;
    recording.poses_are_used = is_convention_given;
    recording.report->add(
        {"poses",
         "depth of nearby frames differs by " + mm_text(now.median_m) +
             " under the recorded poses, and agrees under no convention that is tried" +
             (is_convention_given ? "; they are used as stated" : "; the poses are not used"),
         0, "--poses-convention stated", true});
  }
}

}  // namespace

void question_poses(DecidedRecording& recording, const std::vector<FramePair>& near_pairs,
                    ComparedFrames& samples, bool is_convention_given) {
  DepthEvidence& evidence = *recording.evidence;
  Trial trial(recording, near_pairs, samples);
  const Hypothesis& now = trial.now();
  evidence.pose_disagreement = now.near;
  evidence.far_pose_disagreement = now.far;
  evidence.pose_difference_m = now.median_m;
  evidence.is_scale_confirmed = trial.confirms_scale(now);
  if (now.near < kSurelyAgrees && now.far < kSurelyAgrees) return;

  Hypothesis best = best_of(hypotheses_of(recording.facts, now.convention), trial);
  refine_shift(trial, best);
  // Different faults may explain the differences alike: all that come near the best one are named.
  constexpr double kAlike = 0.03;
  std::vector<Hypothesis> fits = fits_of(trial);
  if (!fits.empty() && fits.front().both() < best.both()) best = fits.front();
  std::erase_if(fits, [&](const Hypothesis& each) { return each.both() > best.both() + kAlike; });
  if (best.both() < now.both() && best.near < DepthDifference::kAgrees) {
    if (fits.empty() || fits.front().both() > best.both()) {
      evidence.is_scale_confirmed = trial.confirms_scale(best);
      return adopt_or_advise(recording, now, best, samples.full_camera(), is_convention_given);
    }
    for (const Hypothesis& each : fits)
      adopt_or_advise(recording, now, each, samples.full_camera(), is_convention_given);
    return;
  }
  const auto [agreeing, compared] = count_agreeing(near_pairs, samples, trial.under(now.convention));
  report_unexplained(recording, now, agreeing, compared, is_convention_given);
}

}  // namespace roomradar
