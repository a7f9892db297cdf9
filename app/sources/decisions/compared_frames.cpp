// compared_frames.cpp: projects depth of one frame into another one, under different assumptions.
#include "app/sources/decisions/compared_frames.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/sources/formats/median.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

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

/// Motion of the camera between the frames of a pair, relative to one that leaves about two thirds of the
/// view.
double motion_of(const Eigen::Isometry3d& T_a_b) {
  constexpr double kTurn_rad = 0.3, kShift_m = 0.4;
  return Eigen::AngleAxisd(T_a_b.linear()).angle() / kTurn_rad + T_a_b.translation().norm() / kShift_m;
}
/// Calls use(a, b, T_b_a) for each pair whose frames can be read and have depth and poses, as if all depths
/// were multiplied by depth_factor: that is the same as scaling the camera's motion the other way.
template <typename Use>
void for_each_posed_pair(const std::vector<FramePair>& pairs, ComparedFrames& samples,
                         const PoseOf& pose_of_position, double depth_factor, const CameraError& error,
                         const Use& use) {
  const Eigen::Isometry3d T_recorded_camera = pose_error(error);
  for (const FramePair& pair : pairs) {
    const ComparedFrame *a = samples.at(pair.a), *b = samples.at(pair.b);
    const auto T_world_a = pose_of_position(pair.a), T_world_b = pose_of_position(pair.b);
    if (!a || !b || !a->has_depth || !b->has_depth || !T_world_a || !T_world_b) continue;
    Eigen::Isometry3d T_b_a =
        T_recorded_camera.inverse() * T_world_b->inverse() * *T_world_a * T_recorded_camera;
    T_b_a.translation() /= depth_factor;
    use(*a, *b, T_b_a);
  }
}

}  // namespace

Intrinsics without_error(const Intrinsics& camera, const CameraError& error) {
  Intrinsics right = camera;
  right.fx_px *= error.fx_factor;
  right.fy_px *= error.fy_factor;
  right.cx_px += error.principal.x() * camera.width_px;
  right.cy_px += error.principal.y() * camera.width_px;
  return right;
}
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
void ComparedFrames::NoiseMeasure::add(const DepthImage& depth_m, const DepthNoise& noise) {
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

std::optional<double> ComparedFrames::NoiseMeasure::ratio() const {
  return count_ < 200 ? std::nullopt : std::optional(std::sqrt(sum_ / static_cast<double>(count_)));
}

ComparedFrames::ComparedFrames(const DecidedRecording& recording)
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

const ComparedFrame* ComparedFrames::at(std::size_t position) {
  const auto [place, is_new] = samples_.try_emplace(position);
  if (is_new) {
    try {
      read_depth(recording_, position, full_m_);
      if (correction_) correction_->correct(full_m_);
      noise_.add(full_m_, recording_.facts.rig.depth_noise);
      ComparedFrame sample{DepthImage(camera_.width_px, camera_.height_px)};
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

void ComparedFrames::read_brightness(std::size_t position, ComparedFrame& sample) {
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

std::vector<FramePair> choose_pairs(std::size_t frames, double least_motion, const PoseOf& pose_of_position) {
  constexpr std::size_t kPlaces = 14;  // of the recording at which frames are compared
  constexpr std::array<std::size_t, 8> kApart = {1, 2, 4, 8, 16, 32, 64, 128};  // frames
  constexpr double kMostMotion = 1.8;
  std::vector<FramePair> pairs;
  for (std::size_t k = 0; k < kPlaces && frames > 1; ++k) {
    const std::size_t a = k * (frames - 1) / kPlaces;
    const auto T_world_a = pose_of_position(a);
    std::optional<FramePair> best;
    for (const std::size_t apart : kApart) {
      const std::size_t b = a + apart;
      if (b >= frames) break;
      const auto T_world_b = pose_of_position(b);
      if (!T_world_a || !T_world_b) {
        if (!T_world_a && apart <= 4) best = FramePair{a, b};
        continue;
      }
      const double motion = motion_of(T_world_a->inverse() * *T_world_b);
      if (motion > kMostMotion && best) break;
      best = FramePair{a, b};
      if (motion >= least_motion) break;
    }
    if (best && (pairs.empty() || pairs.back().a != best->a)) pairs.push_back(*best);
  }
  return pairs;
}
std::vector<FramePair> choose_shifted_pairs(std::size_t frames, const PoseOf& pose_of_position) {
  constexpr std::size_t kTried = 40, kMost = 8, kMostApart = 300;
  constexpr double kMostTurn_rad = 0.25, kLeastShift_m = 0.1, kMostShift_m = 0.5;
  std::vector<std::pair<double, FramePair>> found;  // by shift
  const std::size_t tried = std::min(kTried, frames);
  for (std::size_t i = 0; i < tried; ++i)
    for (std::size_t j = i + 1; j < tried; ++j) {
      const FramePair pair{i * frames / tried, j * frames / tried};
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
  std::vector<FramePair> pairs;
  for (const auto& [shift_m, pair] : found) {
    const bool is_near_another =
        std::any_of(pairs.begin(), pairs.end(),
                    [&, p = pair](const FramePair& other) { return other.a == p.a || other.b == p.b; });
    if (!is_near_another) pairs.push_back(pair);
    if (pairs.size() == kMost) break;
  }
  return pairs;
}

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

std::optional<double> brightness_disagreement(const ComparedFrame& from, const ComparedFrame& to,
                                              const Intrinsics& camera, const Eigen::Isometry3d& T_to_from) {
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

DepthDifference mean_difference(const std::vector<FramePair>& pairs, ComparedFrames& samples,
                                const PoseOf& pose_of_position, double depth_factor,
                                const CameraError& error) {
  DepthDifference mean{0.0, 0.0};
  std::vector<double> medians_m;
  std::size_t count = 0;
  const Intrinsics camera = without_error(samples.camera(), error);
  for_each_posed_pair(pairs, samples, pose_of_position, depth_factor, error,
                      [&](const ComparedFrame& a, const ComparedFrame& b, const Eigen::Isometry3d& T_b_a) {
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

std::optional<double> mean_brightness_disagreement(const std::vector<FramePair>& pairs,
                                                   ComparedFrames& samples, const PoseOf& pose_of_position,
                                                   double depth_factor, const CameraError& error) {
  double sum = 0.0;
  std::size_t count = 0;
  const Intrinsics camera = without_error(samples.camera(), error);
  for_each_posed_pair(pairs, samples, pose_of_position, depth_factor, error,
                      [&](const ComparedFrame& a, const ComparedFrame& b, const Eigen::Isometry3d& T_b_a) {
                        if (const auto one = brightness_disagreement(a, b, camera, T_b_a))
                          sum += *one, ++count;
                      });
  if (count * 2 < pairs.size()) return std::nullopt;
  return sum / static_cast<double>(count);
}
std::vector<std::optional<double>> pair_disagreements(const std::vector<FramePair>& pairs,
                                                      ComparedFrames& samples, const PoseOf& pose_of_position,
                                                      double depth_factor, const CameraError& error) {
  std::vector<std::optional<double>> disagreements;
  const Intrinsics camera = without_error(samples.camera(), error);
  for (const FramePair& pair : pairs) {
    disagreements.emplace_back();
    for_each_posed_pair({pair}, samples, pose_of_position, depth_factor, error,
                        [&](const ComparedFrame& a, const ComparedFrame& b, const Eigen::Isometry3d& T_b_a) {
                          disagreements.back() =
                              depth_difference(a.depth_m, b.depth_m, camera, T_b_a).disagreement +
                              brightness_disagreement(a, b, camera, T_b_a).value_or(0.0);
                        });
  }
  return disagreements;
}
std::pair<std::size_t, std::size_t> count_agreeing(const std::vector<FramePair>& pairs,
                                                   ComparedFrames& samples, const PoseOf& pose_of_position) {
  std::size_t agreeing = 0, compared = 0;
  for_each_posed_pair(pairs, samples, pose_of_position, 1.0, {},
                      [&](const ComparedFrame& a, const ComparedFrame& b, const Eigen::Isometry3d& T_b_a) {
                        const DepthDifference one =
                            depth_difference(a.depth_m, b.depth_m, samples.camera(), T_b_a);
                        agreeing += one.disagreement < DepthDifference::kAgrees ? 1 : 0;
                        ++compared;
                      });
  return {agreeing, compared};
}

}  // namespace roomradar
