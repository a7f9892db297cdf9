// depth_evidence.cpp: projects depth of one frame into another one, under different assumptions.
#include "app/sources/decisions/depth_evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "app/sources/formats/median.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "mapping/alignment/align.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

constexpr std::size_t kPlaces = 14;  // of the recording at which frames are compared
constexpr std::array<std::size_t, 8> kApart = {1, 2, 4, 8, 16, 32, 64, 128};  // frames
// See DepthDifference::disagreement.
constexpr double kSurelyAgrees = 0.30, kAgrees = 0.72, kDisagrees = 0.75, kFarDisagrees = 0.80,
                 kDoubtful = 0.70, kClearlyBetter = 0.07;

/// An error of the stated depth camera, and of its pose relative to the recorded poses' camera.
struct CameraError {
  double fx_factor = 1.0, fy_factor = 1.0;  ///< times which the focal lengths are right
  /// To be added to the principal point, as part of the image's width.
  Eigen::Vector2d principal = {0.0, 0.0};
  Eigen::Vector3d turn_rad = {0.0, 0.0, 0.0};  ///< rotation vector, recorded camera -> camera
  Eigen::Vector3d shift_m = {0.0, 0.0, 0.0};   ///< position of the camera in the recorded camera's frame
};

Intrinsics without_error(const Intrinsics& camera, const CameraError& error) {
  Intrinsics right = camera;
  right.fx_px *= error.fx_factor;
  right.fy_px *= error.fy_factor;
  right.cx_px += error.principal.x() * camera.width_px;
  right.cy_px += error.principal.y() * camera.width_px;
  return right;
}

/// Returns T_recordedcamera_camera.
Eigen::Isometry3d pose_error(const CameraError& error) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = error.shift_m;
  if (const double angle_rad = error.turn_rad.norm(); angle_rad > 0.0)
    T.linear() = Eigen::AngleAxisd(angle_rad, error.turn_rad / angle_rad).toRotationMatrix();
  return T;
}

/// Differences of the points of one depth image to another.
struct PointDifferences {
  std::vector<double> differences_m;
  double clipped_sum = 0.0;  ///< of the differences relative to depth, each limited to 1
  std::size_t count = 0;     ///< number of summands
};

/// Adds the differences of the points of `from` to the image `to`. Returns false if too few points are seen
/// in both; then adds only to differences_m.
bool add_differences(const DepthImage& from, const DepthImage& to, const Intrinsics& camera,
                     const Eigen::Isometry3d& T_to_from, PointDifferences& all) {
  constexpr double kPoints = 1500.0, kTolerance = 0.02, kNear_m = 1e-3;
  const int step =
      std::max(1, static_cast<int>(std::sqrt(static_cast<double>(from.pixels.size()) / kPoints)));
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
      const float seen_m =
          to.at(static_cast<int>(std::lround(uv.x())), static_cast<int>(std::lround(uv.y())));
      if (!(seen_m > 0.0F)) continue;
      const double difference_m = std::abs(p.z() - static_cast<double>(seen_m));
      all.differences_m.push_back(difference_m);
      clipped += std::min(difference_m / (kTolerance * static_cast<double>(seen_m)), 1.0);
      ++both;
    }
  if (valid == 0 || both * 5 < valid) return false;
  all.clipped_sum += clipped;
  all.count += both;
  return true;
}

/// A frame that was read for the comparison.
struct Sample {
  DepthImage depth_m;
  bool has_depth = false;  ///< a hundredth of the pixels or more are measured; a covered lens measures none
  /// Brightness at each pixel of the depth image, 0..1; -1: unknown. Empty: there
  /// is no colour image.
  Image<float> brightness{};
};

/// Returns the brightness of the colour image at the points of the depth image.
Image<float> brightness_of(const DepthImage& depth_m, const Intrinsics& camera, const ColourImage& colour,
                           const Intrinsics& colour_camera, const Eigen::Isometry3d& T_colour_depth) {
  Image<float> brightness(depth_m.width, depth_m.height, -1.0F);
  // Colour images are often finer than depth: the mean over a depth pixel.
  const int half = std::clamp(colour.width / std::max(depth_m.width, 1), 1, 4);
  for (int y = 0; y < brightness.height; ++y)
    for (int x = 0; x < brightness.width; ++x) {
      const float z = depth_m.at(x, y);
      if (!(z > 0.0F)) continue;
      const Eigen::Vector3d p = T_colour_depth * back_project(camera, x, y, z);
      if (!(p.z() > 0.01)) continue;
      const Eigen::Vector2d uv = project(colour_camera, p);
      if (!(uv.x() >= half && uv.y() >= half && uv.x() < colour.width - half - 1 &&
            uv.y() < colour.height - half - 1))
        continue;
      const int u = static_cast<int>(std::lround(uv.x())), v = static_cast<int>(std::lround(uv.y()));
      int sum = 0, count = 0;
      for (int dv = -half; dv <= half; dv += half)
        for (int du = -half; du <= half; du += half, ++count) {
          const Rgb& pixel = colour.at(u + du, v + dv);
          sum += pixel.r + 2 * pixel.g + pixel.b;
        }
      brightness.at(x, y) = static_cast<float>(sum) / (1020.0F * static_cast<float>(count));
    }
  return brightness;
}

/// Returns 1 - the correlation of brightness between the points of `from` and the pixels of `to` where they
/// are seen; nullopt if too few points are seen in both, or a surface without texture.
std::optional<double> brightness_disagreement(const Sample& from, const Sample& to, const Intrinsics& camera,
                                              const Eigen::Isometry3d& T_to_from) {
  constexpr double kPoints = 3000.0, kLeastContrast = 0.02;
  constexpr double kLeastPoints = 200.0;
  if (from.brightness.pixels.empty() || to.brightness.pixels.empty()) return std::nullopt;
  const int step =
      std::max(1, static_cast<int>(std::sqrt(static_cast<double>(from.brightness.pixels.size()) / kPoints)));
  double n = 0, sum_a = 0, sum_b = 0, sum_aa = 0, sum_bb = 0, sum_ab = 0;
  for (int y = step / 2; y < from.brightness.height; y += step)
    for (int x = step / 2; x < from.brightness.width; x += step) {
      const double a = static_cast<double>(from.brightness.at(x, y));
      if (a < 0.0) continue;
      const Eigen::Vector3d p =
          T_to_from * back_project(camera, x, y, static_cast<double>(from.depth_m.at(x, y)));
      if (!(p.z() > 1e-3)) continue;
      const Eigen::Vector2d uv = project(camera, p);
      if (!(uv.x() > 0.0 && uv.y() > 0.0 && uv.x() < to.brightness.width - 1 &&
            uv.y() < to.brightness.height - 1))
        continue;
      const double b = static_cast<double>(
          to.brightness.at(static_cast<int>(std::lround(uv.x())), static_cast<int>(std::lround(uv.y()))));
      if (b < 0.0) continue;
      n += 1.0, sum_a += a, sum_b += b, sum_aa += a * a, sum_bb += b * b, sum_ab += a * b;
    }
  if (n < kLeastPoints) return std::nullopt;
  const double var_a = sum_aa / n - sum_a * sum_a / (n * n), var_b = sum_bb / n - sum_b * sum_b / (n * n);
  if (!(var_a > kLeastContrast * kLeastContrast && var_b > kLeastContrast * kLeastContrast))
    return std::nullopt;
  return 1.0 - (sum_ab / n - sum_a * sum_b / (n * n)) / std::sqrt(var_a * var_b);
}

/// Two frames that overlap.
struct Pair {
  std::size_t a = 0, b = 0;  ///< positions
};

/// Poses of a position under an assumption; nullopt: none.
using PoseOf = std::function<std::optional<Eigen::Isometry3d>(std::size_t)>;

/// The spread of depth about the line through a pixel's neighbours, where these are smooth, relative to the
/// sensor's model.
class NoiseMeasure {
 public:
  void add(const DepthImage& depth_m, const DepthNoise& noise) {
    constexpr double kOfThree = 1.2247;  // sqrt(1 + 1/4 + 1/4)
    for (int y = 4; y < depth_m.height - 4; y += 7)
      for (int x = 4; x < depth_m.width - 4; x += 7) {
        const float z = depth_m.at(x, y), left = depth_m.at(x - 1, y), right = depth_m.at(x + 1, y);
        if (!(z > 0.0F && left > 0.0F && right > 0.0F)) continue;
        const float sigma_m = depth_sigma_m(noise, z);
        const float difference_m = std::abs(z - 0.5F * (left + right));
        if (difference_m > 5.0F * sigma_m || std::abs(left - right) > 0.02F * z) continue;  // an edge
        const double ratio = static_cast<double>(difference_m / sigma_m) / kOfThree;
        sum_ += ratio * ratio;
        ++count_;
      }
  }
  /// Returns nullopt for fewer than 200 smooth pixels.
  [[nodiscard]] std::optional<double> ratio() const {
    return count_ < 200 ? std::nullopt : std::optional(std::sqrt(sum_ / static_cast<double>(count_)));
  }

 private:
  double sum_ = 0.0;
  std::size_t count_ = 0;
};

/// Reads frames, each once. Their images are at most 320 pixels wide, so that a hundred of them take 60 MB.
class Samples {
 public:
  explicit Samples(const DecidedRecording& recording)
      : recording_(recording), full_camera_(recording.facts.rig.depth_camera) {
    if (recording.facts.depth_lens != RationalLens{}) {
      correction_.emplace(full_camera_, recording.facts.depth_lens, recording.facts.name.c_str());
      full_camera_ = correction_->ideal();
    }
    constexpr int kMostWidth_px = 320;
    stride_ = std::max(1, (full_camera_.width_px + kMostWidth_px - 1) / kMostWidth_px);
    const double middle = stride_ / 2;  // pixel that is taken of each square
    camera_ = {full_camera_.width_px / stride_,
               full_camera_.height_px / stride_,
               full_camera_.fx_px / stride_,
               full_camera_.fy_px / stride_,
               (full_camera_.cx_px - middle) / stride_,
               (full_camera_.cy_px - middle) / stride_};
  }
  /// Returns the frame; null if it cannot be read.
  const Sample* at(std::size_t position) {
    const auto [place, is_new] = samples_.try_emplace(position);
    if (is_new) {
      try {
        read_depth(recording_, position, full_m_);
        if (correction_) correction_->correct(full_m_);
        noise_.add(full_m_, recording_.facts.rig.depth_noise);
        Sample sample{DepthImage(camera_.width_px, camera_.height_px)};
        for (int y = 0; y < camera_.height_px; ++y)
          for (int x = 0; x < camera_.width_px; ++x)
            sample.depth_m.at(x, y) = full_m_.at(x * stride_ + stride_ / 2, y * stride_ + stride_ / 2);
        const auto& pixels = sample.depth_m.pixels;
        const auto measured = std::count_if(pixels.begin(), pixels.end(), [](float z) { return z > 0.0F; });
        sample.has_depth = static_cast<std::size_t>(measured) * 100 >= pixels.size();
        read_brightness(position, sample);
        place->second = std::move(sample);
      } catch (const Error&) {  // counted when the frame's turn comes
      }
    }
    return place->second ? &*place->second : nullptr;
  }
  /// Returns the camera of the samples.
  [[nodiscard]] const Intrinsics& camera() const { return camera_; }
  /// Returns the camera of the recording's images, without their lens.
  [[nodiscard]] const Intrinsics& full_camera() const { return full_camera_; }
  /// Returns the noise of the frames read so far relative to the sensor's model; nullopt if unknown.
  [[nodiscard]] std::optional<double> noise_ratio() const { return noise_.ratio(); }

 private:
  /// Leaves the brightness empty if there is no colour image, or it cannot be read.
  void read_brightness(std::size_t position, Sample& sample) {
    const RecordingFacts& facts = recording_.facts;
    const auto& colour = recording_.frames[position].colour;
    if (!colour || !facts.rig.colour_camera) return;
    try {
      facts.read_colour(*colour, colour_);
      const Intrinsics& camera = *facts.rig.colour_camera;
      if (colour_.width == camera.width_px && colour_.height == camera.height_px)
        sample.brightness = brightness_of(sample.depth_m, camera_, colour_, camera, facts.rig.T_colour_depth);
    } catch (const Error&) {  // counted when the frame's turn comes
    }
  }

  const DecidedRecording& recording_;
  Intrinsics full_camera_, camera_;
  int stride_ = 1;
  DepthImage full_m_;   // scratch
  ColourImage colour_;  // scratch
  NoiseMeasure noise_;
  std::optional<LensCorrection> correction_;
  std::map<std::size_t, std::optional<Sample>> samples_;
};

/// Motion of the camera between the frames of a pair, relative to one that leaves about two thirds of the
/// view.
double motion_of(const Eigen::Isometry3d& T_a_b) {
  constexpr double kTurn_rad = 0.3, kShift_m = 0.4;
  return Eigen::AngleAxisd(T_a_b.linear()).angle() / kTurn_rad + T_a_b.translation().norm() / kShift_m;
}

/// Returns pairs of frames between which the camera has moved by `least_motion` or more, see motion_of(), by
/// the poses. Takes the frames nearest in time. Without poses, frames four apart.
std::vector<Pair> choose_pairs(std::size_t frames, std::size_t places, double least_motion,
                               const PoseOf& pose_of_position) {
  constexpr double kMostMotion = 1.8;
  std::vector<Pair> pairs;
  for (std::size_t k = 0; k < places && frames > 1; ++k) {
    const std::size_t a = k * (frames - 1) / places;
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
      const double motion = motion_of(T_world_a->inverse() * *T_world_b);
      if (motion > kMostMotion && best) break;
      best = Pair{a, b};
      if (motion >= least_motion) break;
    }
    if (best && (pairs.empty() || pairs.back().a != best->a)) pairs.push_back(*best);
  }
  return pairs;
}

/// Returns up to eight pairs of frames, not necessarily near in time, between which the camera has moved
/// sideways but hardly turned. They tell the scale of a camera that mostly turns.
std::vector<Pair> choose_shifted_pairs(std::size_t frames, const PoseOf& pose_of_position) {
  constexpr std::size_t kTried = 40, kMost = 8, kMostApart = 300;
  constexpr double kMostTurn_rad = 0.25, kLeastShift_m = 0.1, kMostShift_m = 0.5;
  std::vector<std::pair<double, Pair>> found;  // by shift
  const std::size_t tried = std::min(kTried, frames);
  for (std::size_t i = 0; i < tried; ++i)
    for (std::size_t j = i + 1; j < tried; ++j) {
      const Pair pair{i * frames / tried, j * frames / tried};
      if (pair.b - pair.a > kMostApart) break;
      const auto T_world_a = pose_of_position(pair.a), T_world_b = pose_of_position(pair.b);
      if (!T_world_a || !T_world_b) continue;
      const Eigen::Isometry3d T_a_b = T_world_a->inverse() * *T_world_b;
      const double shift_m = T_a_b.translation().norm();
      if (shift_m > kLeastShift_m && shift_m < kMostShift_m &&
          Eigen::AngleAxisd(T_a_b.linear()).angle() < kMostTurn_rad)
        found.emplace_back(shift_m, pair);
    }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Pair> pairs;
  for (const auto& [shift_m, pair] : found) {
    const bool is_near_another = std::any_of(pairs.begin(), pairs.end(), [&, p = pair](const Pair& other) {
      return other.a == p.a || other.b == p.b;
    });
    if (!is_near_another) pairs.push_back(pair);
    if (pairs.size() == kMost) break;
  }
  return pairs;
}

/// Calls use(a, b, T_b_a) for each pair whose frames can be read and have depth and poses, as if all depths
/// were multiplied by depth_factor: that is the same as scaling the camera's motion the other way.
template <typename Use>
void for_each_posed_pair(const std::vector<Pair>& pairs, Samples& samples, const PoseOf& pose_of_position,
                         double depth_factor, const CameraError& error, const Use& use) {
  const Eigen::Isometry3d T_recorded_camera = pose_error(error);
  for (const Pair& pair : pairs) {
    const Sample *a = samples.at(pair.a), *b = samples.at(pair.b);
    const auto T_world_a = pose_of_position(pair.a), T_world_b = pose_of_position(pair.b);
    if (!a || !b || !a->has_depth || !b->has_depth || !T_world_a || !T_world_b) continue;
    Eigen::Isometry3d T_b_a =
        T_recorded_camera.inverse() * T_world_b->inverse() * *T_world_a * T_recorded_camera;
    T_b_a.translation() /= depth_factor;
    use(*a, *b, T_b_a);
  }
}

/// Mean difference over all pairs whose frames have poses.
DepthDifference mean_difference(const std::vector<Pair>& pairs, Samples& samples,
                                const PoseOf& pose_of_position, double depth_factor = 1.0,
                                const CameraError& error = {}) {
  DepthDifference mean{0.0, 0.0};
  std::vector<double> medians_m;
  std::size_t count = 0;
  const Intrinsics camera = without_error(samples.camera(), error);
  for_each_posed_pair(pairs, samples, pose_of_position, depth_factor, error,
                      [&](const Sample& a, const Sample& b, const Eigen::Isometry3d& T_b_a) {
                        const DepthDifference one = depth_difference(a.depth_m, b.depth_m, camera, T_b_a);
                        mean.disagreement += one.disagreement;
                        medians_m.push_back(one.median_m * depth_factor);
                        ++count;
                      });
  if (count == 0) return {};
  mean.disagreement /= static_cast<double>(count);
  mean.median_m = median_of(std::move(medians_m));
  return mean;
}

/// Returns the number of pairs whose depth agrees, and that of all pairs whose frames have poses.
std::pair<std::size_t, std::size_t> count_agreeing(const std::vector<Pair>& pairs, Samples& samples,
                                                   const PoseOf& pose_of_position) {
  std::size_t agreeing = 0, compared = 0;
  for_each_posed_pair(pairs, samples, pose_of_position, 1.0, {},
                      [&](const Sample& a, const Sample& b, const Eigen::Isometry3d& T_b_a) {
                        const DepthDifference one =
                            depth_difference(a.depth_m, b.depth_m, samples.camera(), T_b_a);
                        agreeing += one.disagreement < kAgrees ? 1 : 0;
                        ++compared;
                      });
  return {agreeing, compared};
}

/// Returns the disagreement of depth plus that of brightness of each pair; unset: a frame has no pose.
std::vector<std::optional<double>> pair_disagreements(const std::vector<Pair>& pairs, Samples& samples,
                                                      const PoseOf& pose_of_position, double depth_factor,
                                                      const CameraError& error) {
  std::vector<std::optional<double>> disagreements;
  const Intrinsics camera = without_error(samples.camera(), error);
  for (const Pair& pair : pairs) {
    disagreements.emplace_back();
    for_each_posed_pair({pair}, samples, pose_of_position, depth_factor, error,
                        [&](const Sample& a, const Sample& b, const Eigen::Isometry3d& T_b_a) {
                          disagreements.back() =
                              depth_difference(a.depth_m, b.depth_m, camera, T_b_a).disagreement +
                              brightness_disagreement(a, b, camera, T_b_a).value_or(0.0);
                        });
  }
  return disagreements;
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
  // Depths that are all equal, and apart from the ones before.
  constexpr double kBelow = 0.97;
  const auto most = std::lower_bound(depths_m.begin(), depths_m.end(), depths_m.back());
  const auto below = std::lower_bound(depths_m.begin(), most, kBelow * depths_m.back());
  const auto equal = static_cast<double>(depths_m.end() - most);
  if (equal > 0.02 * static_cast<double>(depths_m.size()) &&
      static_cast<double>(most - below) < 0.02 * equal && most != depths_m.begin())
    evidence.equal_most_m = depths_m.back();
}

std::string unit_option(double unit_m) { return "--depth-unit " + format_readable(unit_m, 3); }

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
                           0, unit_option(likely_unit_m), true});
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

// ---- poses ----

/// Mean disagreement in brightness over all pairs whose frames have poses; nullopt: none has texture.
std::optional<double> mean_brightness_disagreement(const std::vector<Pair>& pairs, Samples& samples,
                                                   const PoseOf& pose_of_position, double depth_factor,
                                                   const CameraError& error) {
  double sum = 0.0;
  std::size_t count = 0;
  const Intrinsics camera = without_error(samples.camera(), error);
  for_each_posed_pair(pairs, samples, pose_of_position, depth_factor, error,
                      [&](const Sample& a, const Sample& b, const Eigen::Isometry3d& T_b_a) {
                        if (const auto one = brightness_disagreement(a, b, camera, T_b_a))
                          sum += *one, ++count;
                      });
  if (count * 2 < pairs.size()) return std::nullopt;
  return sum / static_cast<double>(count);
}

/// What may be wrong with a recording that has poses.
struct Hypothesis {
  PoseConvention convention{};
  double depth_factor = 1.0;     ///< times which depth is right
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

/// Returns the words "with a focal length of about ... than with ..."; nullopt if the camera is as stated.
std::optional<std::string> other_camera(const Intrinsics& stated, const CameraError& error) {
  const auto focal_text = [](double fx_px, double fy_px, int digits) {
    const std::string x = format_readable(fx_px, digits), y = format_readable(fy_px, digits);
    return x + (x == y ? "" : " x " + y) + " px";
  };
  const Intrinsics right = without_error(stated, error);
  if (error.fx_factor != 1.0 || error.fy_factor != 1.0) {
    const bool is_one = error.fx_factor == error.fy_factor;
    return "with a focal length of about " + focal_text(right.fx_px, is_one ? right.fx_px : right.fy_px, 2) +
           " than with " + focal_text(stated.fx_px, is_one ? stated.fx_px : stated.fy_px, 4);
  }
  const auto point_text = [](const Intrinsics& camera, int digits) {
    return "(" + format_readable(camera.cx_px, digits) + ", " + format_readable(camera.cy_px, digits) +
           ") px";
  };
  if (!error.principal.isZero())
    return "with a principal point of about " + point_text(right, 2) + " than of " + point_text(stated, 4);
  return std::nullopt;
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
                0, unit_option(unit_m), is_sure});
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

/// Finds what explains best how the depth of nearby frames differs: the recording as it is, or a hypothesis.
void question_poses(DecidedRecording& recording, const std::vector<Pair>& near_pairs, Samples& samples,
                    bool is_convention_given) {
  DepthEvidence& evidence = *recording.evidence;
  constexpr int kMostLate = 30;                                                   // frames
  constexpr std::size_t kLeastShifted = 6;                                        // pairs
  std::map<std::pair<std::size_t, int>, std::optional<Eigen::Isometry3d>> poses;  // as stated
  const auto stated = [&](std::size_t position, int later_by) -> const std::optional<Eigen::Isometry3d>& {
    const auto [place, is_new] = poses.try_emplace({position, later_by});
    if (is_new) place->second = stated_pose_of(recording, position, later_by);
    return place->second;
  };
  // All hypotheses are measured with the frames that have a pose as recorded. Else, where every second frame
  // has one, poses that are a frame late would be compared at other frames.
  const auto under = [&](const PoseConvention& convention) -> PoseOf {
    return [&, convention](std::size_t position) -> std::optional<Eigen::Isometry3d> {
      if (!stated(position, recording.pose_convention.later_by)) return std::nullopt;
      const auto& pose = stated(position, convention.later_by);
      if (!pose) return std::nullopt;
      return in_world(recording.facts, *pose, convention);
    };
  };
  const auto measure = [&](Hypothesis& hypothesis, const std::vector<Pair>& near_of,
                           const std::vector<Pair>& far_of) {
    const PoseOf pose = under(hypothesis.convention);
    const DepthDifference near =
        mean_difference(near_of, samples, pose, hypothesis.depth_factor, hypothesis.camera);
    hypothesis.near = near.disagreement;
    hypothesis.median_m = near.median_m;
    hypothesis.far =
        mean_difference(far_of, samples, pose, hypothesis.depth_factor, hypothesis.camera).disagreement;
    hypothesis.brightness =
        mean_brightness_disagreement(far_of, samples, pose, hypothesis.depth_factor, hypothesis.camera)
            .value_or(0.0);
  };
  Hypothesis now{.convention = recording.pose_convention};
  // By poses in millimetres all frames are far apart, so the far pairs of each unit are its own.
  const auto far_pairs_of = [&](const PoseConvention& convention) {
    std::vector<Pair> chosen = choose_pairs(recording.frames.size(), kPlaces, 0.8, under(convention));
    for (const Pair& pair : choose_shifted_pairs(recording.frames.size(), under(convention)))
      chosen.push_back(pair);
    return chosen;
  };
  const std::vector<Pair> far_pairs = far_pairs_of(now.convention);
  measure(now, near_pairs, far_pairs);
  evidence.pose_disagreement = now.near;
  evidence.far_pose_disagreement = now.far;
  evidence.pose_difference_m = now.median_m;
  const auto confirm_scale = [&](const Hypothesis& right) {
    evidence.is_scale_confirmed = true;
    const std::vector<Pair> far_of_right = far_pairs_of(right.convention);
    for (const double factor : {0.5, 2.0}) {
      Hypothesis scaled{.convention = right.convention, .depth_factor = factor};
      measure(scaled, near_pairs, far_of_right);
      evidence.is_scale_confirmed &= scaled.both() > right.both() + kClearlyBetter;
    }
  };
  confirm_scale(now);
  if (now.near < kSurelyAgrees && now.far < kSurelyAgrees) return;

  // Poses of other frames exist for other pairs: a shift is compared with the poses as recorded on the pairs
  // that have both.
  const auto measure_shift = [&](Hypothesis& hypothesis) {
    const PoseOf pose = under(hypothesis.convention);
    const auto posed = [&](std::vector<Pair> pairs) {
      std::erase_if(pairs, [&](const Pair& pair) { return !pose(pair.a) || !pose(pair.b); });
      return pairs;
    };
    const std::vector<Pair> near = posed(near_pairs), far = posed(far_pairs);
    if (near.size() < kLeastShifted) return;  // stays at its worst
    Hypothesis same{.convention = now.convention};
    measure(hypothesis, near, far);
    measure(same, near, far);
    hypothesis.near += now.near - same.near;
    hypothesis.far += now.far - same.far;
    hypothesis.brightness += now.brightness - same.brightness;
  };
  const auto of_all_pairs = [&](const Hypothesis& hypothesis) {
    std::vector<std::optional<double>> all;
    for (const auto* pairs : {&near_pairs, &far_pairs})
      for (const auto one : pair_disagreements(*pairs, samples, under(hypothesis.convention),
                                               hypothesis.depth_factor, hypothesis.camera))
        all.push_back(one);
    return all;
  };
  const std::vector<std::optional<double>> as_recorded = of_all_pairs(now);
  // A fault of the camera or the convention shows in nearly all pairs; noise helps some and harms others.
  const auto is_better_in_most = [&](const Hypothesis& hypothesis) {
    constexpr double kBetter = 0.01, kMostPairs = 0.7;
    const std::vector<std::optional<double>> fitted = of_all_pairs(hypothesis);
    std::size_t better = 0, compared = 0;
    for (std::size_t k = 0; k < fitted.size(); ++k) {
      if (!fitted[k] || !as_recorded[k]) continue;
      ++compared;
      better += *fitted[k] < *as_recorded[k] - kBetter ? 1 : 0;
    }
    return static_cast<double>(better) >= kMostPairs * static_cast<double>(compared);
  };
  Hypothesis best = now;
  for (Hypothesis& hypothesis : hypotheses_of(recording.facts, now.convention)) {
    if (hypothesis.convention.later_by != now.convention.later_by)
      measure_shift(hypothesis);
    else
      measure(hypothesis, near_pairs,
              hypothesis.convention.unit_m == now.convention.unit_m ? far_pairs
                                                                    : far_pairs_of(hypothesis.convention));
    if (hypothesis.both() < now.both() - kClearlyBetter && hypothesis.both() < best.both() &&
        is_better_in_most(hypothesis))
      best = hypothesis;
  }
  // Not all shifts were tried: goes on to the best one near by.
  for (bool goes_on = best.convention.later_by != 0; goes_on;) {
    goes_on = false;
    for (const int step : {-1, 1}) {
      Hypothesis next = best;
      next.convention.later_by += step;
      if (std::abs(next.convention.later_by) > kMostLate) continue;
      measure_shift(next);
      if (next.both() < best.both()) best = next, goes_on = true;
    }
  }
  // Different faults may explain the differences alike: all that come near the best one are named.
  constexpr double kAlike = 0.03;
  std::vector<Hypothesis> fits;
  for (const Fitted& fitted : kFitted)
    if (const auto fitting =
            fit(fitted, now, [&](Hypothesis& next) { measure(next, near_pairs, far_pairs); });
        fitting) {
      fits.push_back(*fitting);
      fits.back().is_clear = is_better_in_most(*fitting);
    }
  std::sort(fits.begin(), fits.end(),
            [](const Hypothesis& a, const Hypothesis& b) { return a.both() < b.both(); });
  if (!fits.empty() && fits.front().both() < best.both()) best = fits.front();
  std::erase_if(fits, [&](const Hypothesis& each) { return each.both() > best.both() + kAlike; });
  if (best.both() < now.both() && best.near < kAgrees) {
    if (fits.empty() || fits.front().both() > best.both()) {
      confirm_scale(best);
      return adopt_or_advise(recording, now, best, samples.full_camera(), is_convention_given);
    }
    for (const Hypothesis& each : fits)
      adopt_or_advise(recording, now, each, samples.full_camera(), is_convention_given);
    return;
  }
  const bool disagrees = now.near > kDisagrees || now.far > kFarDisagrees;
  // A hand before the lens, or a stretch of wrong poses, makes some pairs disagree, and wrong poses all of
  // them.
  constexpr double kMostAgree = 0.5;
  const auto [agreeing, compared] = count_agreeing(near_pairs, samples, under(now.convention));
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
    evidence.poses_disagree = true;
    recording.poses_are_used = is_convention_given;
    recording.report->add(
        {"poses",
         "depth of nearby frames differs by " + mm_text(now.median_m) +
             " under the recorded poses, and agrees under no convention that is tried" +
             (is_convention_given ? "; they are used as stated" : "; the poses are not used"),
         0, "--poses-convention stated", true});
  }
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
                                                                 Samples& samples, const DepthNoise& noise,
                                                                 const CameraError& error) {
  constexpr std::array<std::size_t, 3> kSteps = {3, 6, 12};
  const Intrinsics camera = without_error(samples.camera(), error);
  std::vector<std::optional<double>> disagreements;
  for (const std::size_t place : places) {
    const Sample* a = samples.at(place);
    Eigen::Isometry3d T_b_a = Eigen::Isometry3d::Identity();
    std::optional<double> last;
    for (const std::size_t step : kSteps) {
      const Sample* b = a ? samples.at(place + step) : nullptr;
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
void question_camera(const DecidedRecording& recording, Samples& samples) {
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

DepthDifference depth_difference(const DepthImage& from, const DepthImage& to, const Intrinsics& camera,
                                 const Eigen::Isometry3d& T_to_from) {
  PointDifferences all;
  const bool forward = add_differences(from, to, camera, T_to_from, all);
  const bool backward = add_differences(to, from, camera, T_to_from.inverse(), all);
  DepthDifference difference;
  if (!all.differences_m.empty()) difference.median_m = median_of(std::move(all.differences_m));
  if (forward || backward) difference.disagreement = all.clipped_sum / static_cast<double>(all.count);
  if (forward != backward) difference.disagreement = 0.5 * (difference.disagreement + 1.0);
  return difference;
}

void question_depth(DecidedRecording& recording, bool is_convention_given) {
  recording.evidence.emplace();
  DepthEvidence& evidence = *recording.evidence;
  Samples samples(recording);
  const std::size_t frames = recording.frames.size();
  const PoseOf pose_at_position = [&](std::size_t position) { return pose_of(recording, position); };
  const std::vector<Pair> pairs = choose_pairs(frames, kPlaces, 0.35, pose_at_position);

  measure_depth_range(pairs, samples, evidence);
  evidence.noise_ratio = samples.noise_ratio();
  std::vector<Pair> far_pairs;
  constexpr std::size_t kSecondApart = 32;
  for (const Pair& pair : pairs)
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
  const auto posed = std::count_if(pairs.begin(), pairs.end(), [&](const Pair& pair) {
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
