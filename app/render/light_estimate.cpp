// light_estimate.cpp: compares candidate lamps by the variance of albedo that they leave within each hue.
#include "app/render/light_estimate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "mapping/types/system/config_check.hpp"

namespace roomradar {
namespace {

constexpr int kReach_px = 2;  // distance of the neighbours that determine a normal

/// Returns the normal towards the camera at a pixel, in the camera's frame, if its neighbourhood is smooth.
std::optional<Eigen::Vector3d> normal_at(const DepthImage& depth_m, const Intrinsics& camera, int x, int y) {
  constexpr float kBend = 0.004F;  // fraction of depth by which a smooth surface deviates from its tangent
  constexpr double kGrazing = 0.15;
  const float z_m = depth_m.at(x, y);
  const float left_m = depth_m.at(x - kReach_px, y), right_m = depth_m.at(x + kReach_px, y);
  const float above_m = depth_m.at(x, y - kReach_px), below_m = depth_m.at(x, y + kReach_px);
  if (!(std::min({z_m, left_m, right_m, above_m, below_m}) > 0.0F)) return std::nullopt;
  // Inverse depth is linear in the image on a plane.
  const auto bend = [&](float a_m, float b_m) { return std::abs(z_m * (0.5F / a_m + 0.5F / b_m) - 1.0F); };
  if (!(bend(left_m, right_m) < kBend && bend(above_m, below_m) < kBend)) return std::nullopt;
  const auto point = [&](int u, int v, float at_m) { return back_project(camera, u, v, at_m); };
  const Eigen::Vector3d across = point(x + kReach_px, y, right_m) - point(x - kReach_px, y, left_m);
  const Eigen::Vector3d down = point(x, y + kReach_px, below_m) - point(x, y - kReach_px, above_m);
  const Eigen::Vector3d normal = down.cross(across).normalized();
  const double facing = -normal.dot(point(x, y, z_m).normalized());
  if (!(facing > kGrazing)) return std::nullopt;
  return normal;
}

/// Returns the logarithm of the mean linear colour of 3 x 3 pixels, unless one is saturated or it is almost
/// black.
std::optional<Eigen::Vector3f> log_colour_at(const ColourImage& colour, int x, int y) {
  constexpr int kSaturated = 251;
  constexpr float kBlack = 0.0015F;  // 10 of 255
  if (x < 1 || y < 1 || x + 1 >= colour.width || y + 1 >= colour.height) return std::nullopt;
  std::array<int, 3> sum{};
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u) {
      const Rgb& pixel = colour.at(u, v);
      if (std::max({pixel.r, pixel.g, pixel.b}) >= kSaturated) return std::nullopt;
      sum[0] += pixel.r * pixel.r;
      sum[1] += pixel.g * pixel.g;
      sum[2] += pixel.b * pixel.b;
    }
  Eigen::Vector3f linear(static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2]));
  linear /= 9.0F * 255.0F * 255.0F;
  if (linear.minCoeff() < kBlack) return std::nullopt;
  return linear.array().log().matrix();
}

bool agrees(const SurfaceView& surface, int x, int y) {
  if (!surface.dynamic_mask.empty() && surface.dynamic_mask.at(x, y) != 0) return false;
  const int factor = surface.measured_m.width / surface.expected_m.width;
  const float z_m = surface.expected_m.at(x, y);
  const float measured_m = surface.measured_m.at(x * factor, y * factor);
  return measured_m > 0.0F && std::abs(measured_m - z_m) < 0.02F + 0.01F * z_m * z_m;
}

bool sizes_match(const ColourView& colour, const SurfaceView& surface) {
  const DepthImage& expected_m = surface.expected_m;
  const DepthImage& measured_m = surface.measured_m;
  if (colour.colour.empty() || expected_m.empty() || measured_m.empty()) return false;
  if (colour.colour.width != colour.camera.width_px || colour.colour.height != colour.camera.height_px)
    return false;
  const int factor = measured_m.width / expected_m.width;
  return factor >= 1 && measured_m.height >= factor * expected_m.height &&
         (surface.dynamic_mask.empty() || (surface.dynamic_mask.width == expected_m.width &&
                                           surface.dynamic_mask.height == expected_m.height));
}

/// Returns the sample at a pixel of the depth image, without its reach.
std::optional<LightSample> sample_at(const ColourView& colour, const SurfaceView& surface,
                                     const Eigen::Isometry3d& T_colour_depth, int x, int y) {
  const float z_m = surface.expected_m.at(x, y);
  if (!(z_m > 0.0F) || !agrees(surface, x, y)) return std::nullopt;
  const std::optional<Eigen::Vector3d> normal = normal_at(surface.expected_m, surface.camera, x, y);
  if (!normal) return std::nullopt;
  const Eigen::Vector3d p_camera = back_project(surface.camera, x, y, z_m);
  const Eigen::Vector3d p_colour = T_colour_depth * p_camera;
  if (!(p_colour.z() > 0.0)) return std::nullopt;
  const Eigen::Vector2d pixel = project(colour.camera, p_colour);
  if (!(pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() < colour.camera.width_px &&
        pixel.y() < colour.camera.height_px))
    return std::nullopt;
  const auto log_colour =
      log_colour_at(colour.colour, static_cast<int>(pixel.x() + 0.5), static_cast<int>(pixel.y() + 0.5));
  if (!log_colour) return std::nullopt;
  return LightSample{(surface.T_world_camera * p_camera).cast<float>(),
                     (surface.T_world_camera.linear() * *normal).cast<float>(),
                     *log_colour,
                     {}};
}

}  // namespace

void take_light_samples(const ColourView& colour, const SurfaceView& surface, int wanted,
                        std::uint64_t& position, std::vector<LightSample>& samples) {
  constexpr int kLooks = 4;
  constexpr double kStepX = 0.7548776662466927, kStepY = 0.5698402909980532;
  samples.clear();
  if (wanted <= 0 || !sizes_match(colour, surface)) return;
  const int width = surface.expected_m.width - 2 * kReach_px;
  const int height = surface.expected_m.height - 2 * kReach_px;
  if (width <= 0 || height <= 0) return;
  const Eigen::Isometry3d T_colour_depth = colour.T_world_camera.inverse() * surface.T_world_camera;
  for (int look = 0; look < kLooks * wanted && samples.size() < static_cast<std::size_t>(wanted); ++look) {
    const auto at = static_cast<double>(++position);
    const auto pixel = [&](double step, int size) {
      return kReach_px + std::min(static_cast<int>(std::fmod(at * step, 1.0) * size), size - 1);
    };
    if (const auto sample =
            sample_at(colour, surface, T_colour_depth, pixel(kStepX, width), pixel(kStepY, height)))
      samples.push_back(*sample);
  }
}

namespace {

constexpr int kHuesAcross = 24;
constexpr int kHues = kHuesAcross * kHuesAcross;
constexpr std::size_t kMostPoints = 720;
constexpr float kHueWidth = 0.22F;  // of log ratios of linear colours
constexpr double kRound_s = 1.0;    // time in which each candidate is tested again

/// A lamp beside ambient light of mean irradiance 1.
struct Candidate {
  std::size_t number;  ///< of its direction
  Eigen::Vector3f direction;
  float distance_m;
  float strength;  ///< irradiance at the place on a surface that faces the lamp
};

const std::vector<Candidate>& candidates() {
  static const std::vector<Candidate> all = [] {
    std::vector<Candidate> made;
    for (std::size_t i = 0; i < kLampDirections; ++i)
      for (const float distance_m : {1.5F, 3.0F, 8.0F})
        for (const float strength : {0.5F, 1.2F, 2.5F})
          made.push_back({i, lamp_directions()[i], distance_m, strength});
    return made;
  }();
  return all;
}

float ambient_of(const LightSample& sample) {
  return (1.0F + kFromAbove * sample.normal_world.z()) * sample.reach.ambient;
}

/// Returns the irradiance of a surface point from a candidate that nothing shades.
float lamplight_of(const Candidate& lamp, const LightSample& sample, const Eigen::Vector3f& place_world_m) {
  constexpr float kNearest_m2 = 0.1F;
  const Eigen::Vector3f way = place_world_m + lamp.distance_m * lamp.direction - sample.p_world_m;
  const float squared_m2 = std::max(way.squaredNorm(), kNearest_m2);
  const float facing = std::max(0.0F, sample.normal_world.dot(way)) / std::sqrt(squared_m2);
  return lamp.strength * lamp.distance_m * lamp.distance_m / squared_m2 * facing;
}

float log_irradiance(float irradiance) {
  constexpr float kDarkest = 0.02F;
  return std::log(std::max(irradiance, kDarkest));
}

int hue_of(const Eigen::Vector3f& log_colour) {
  const auto bin = [](float ratio) {
    return static_cast<int>(std::clamp(ratio / kHueWidth + 0.5F * kHuesAcross, 0.0F, kHuesAcross - 1.0F));
  };
  return bin(log_colour.x() - log_colour.y()) * kHuesAcross + bin(log_colour.z() - log_colour.y());
}

/// Returns the squared residual of log albedo within the hues, with outliers limited, averaged over points.
template <typename Points>
float score_of(const Candidate& lamp, const Points& points, const Eigen::Vector3f& place_world_m,
               std::vector<float>& residuals) {
  constexpr float kOutlier2 = 0.36F;
  std::array<float, kHues> sums{}, counts{};
  residuals.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& point = points[i];
    const float lamplight =
        point.sample.reach.lamps[lamp.number] > 0.0F ? lamplight_of(lamp, point.sample, place_world_m) : 0.0F;
    residuals[i] = point.grey - log_irradiance(ambient_of(point.sample) +
                                               point.sample.reach.lamps[lamp.number] * lamplight);
    sums[static_cast<std::size_t>(point.hue)] += residuals[i];
    counts[static_cast<std::size_t>(point.hue)] += 1.0F;
  }
  float total = 0.0F;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto hue = static_cast<std::size_t>(points[i].hue);
    const float residual = residuals[i] - sums[hue] / counts[hue];
    total += residual * residual / (1.0F + residual * residual / kOutlier2);
  }
  return total / static_cast<float>(points.size());
}

/// Returns the weights of candidates from their scores, sum 1.
std::vector<float> weights_of(const std::vector<float>& scores) {
  constexpr float kScale = 0.001F;  // twice the variance of log albedo over about 100 independent points
  const float best = *std::min_element(scores.begin(), scores.end());
  std::vector<float> weights;
  float sum = 0.0F;
  for (const float score : scores) sum += weights.emplace_back(std::exp((best - score) / kScale));
  for (float& weight : weights) weight /= sum;
  return weights;
}

/// Returns the logarithm of the light's level and colour: the Minkowski norm of the hues' apparent albedos,
/// compared with that of typical rooms. The colour is drawn towards neutral, since cameras balance white, and
/// since the things of a room are yellowish on average.
/// @param mean   the mean lamp
/// @param lamps  strength in each direction
template <typename Points>
Eigen::Vector3f log_level_of(const Candidate& mean, const std::array<float, kLampDirections>& lamps,
                             const Points& points, const Eigen::Vector3f& place_world_m) {
  constexpr float kNorm = 6.0F, kUsualAlbedo = 0.65F, kTrustInColour = 0.6F;
  Eigen::Array<float, 3, Eigen::Dynamic> sums = Eigen::Array<float, 3, Eigen::Dynamic>::Zero(3, kHues);
  Eigen::ArrayXf counts = Eigen::ArrayXf::Zero(kHues);
  const Eigen::Map<const Eigen::Array<float, kLampDirections, 1>> strengths(lamps.data());
  const float all = std::max(strengths.sum(), 1e-6F);
  for (const auto& point : points) {
    const Eigen::Map<const Eigen::Array<float, kLampDirections, 1>> reach(point.sample.reach.lamps.data());
    const float part = (strengths * reach).sum() / all;
    const float light = ambient_of(point.sample) + part * lamplight_of(mean, point.sample, place_world_m);
    sums.col(point.hue) += point.sample.log_colour.array() - log_irradiance(light);
    counts(point.hue) += 1.0F;
  }
  Eigen::Array3f norm = Eigen::Array3f::Zero();
  for (int hue = 0; hue < kHues; ++hue)
    if (counts(hue) > 0.0F) norm += counts(hue) * (kNorm * sums.col(hue) / counts(hue)).exp();
  const Eigen::Array3f level = (norm / counts.sum()).log() / kNorm - std::log(kUsualAlbedo);
  return (level.mean() + kTrustInColour * (level - level.mean())).matrix();
}

}  // namespace

void require_valid(const LightConfig& config) {
  const ConfigCheck require{"light"};
  require(config.samples_per_s >= 0 && config.samples_per_s <= 100'000, "samples_per_s",
          static_cast<float>(config.samples_per_s), "in 0..100000");
  require(config.memory_s > 0.0 && config.memory_s <= 60.0, "memory_s", static_cast<float>(config.memory_s),
          "in 0..60, not 0");
}

float renewed_fraction(double seconds, const LightConfig& config) {
  return static_cast<float>(1.0 - std::exp(-std::max(seconds, 0.0) / config.memory_s));
}

int wanted_samples(bool is_first, double dt_s, const LightConfig& config) {
  constexpr int kOfFirst = 120, kMost = 60;
  if (config.samples_per_s == 0) return 0;
  if (is_first) return kOfFirst;
  return std::clamp(static_cast<int>(std::lround(std::clamp(dt_s, 0.0, 1.0) * config.samples_per_s)), 1,
                    kMost);
}

void LightEstimator::keep_points(std::span<const LightSample> samples) {
  constexpr float kCorner = 0.3F;  // darker places are lit by their surroundings, in unknown ways
  for (const LightSample& sample : samples) {
    if (!sample.p_world_m.allFinite() || !sample.normal_world.allFinite() || !sample.log_colour.allFinite() ||
        !(sample.reach.ambient > kCorner))
      continue;
    const Point point{sample, sample.log_colour.mean(), hue_of(sample.log_colour)};
    if (points_.size() < kMostPoints)
      points_.push_back(point);
    else
      points_[next_point_] = point;
    next_point_ = (next_point_ + 1) % kMostPoints;
  }
}

void LightEstimator::test_candidates(const Eigen::Vector3f& place_world_m, double dt_s,
                                     const LightConfig& config) {
  const std::vector<Candidate>& lamps = candidates();
  const bool is_first = scores_.empty();
  scores_.resize(lamps.size());
  const double round = is_first ? 1.0 : std::clamp(dt_s / kRound_s, 1.0 / 64.0, 1.0);  // part tested now
  const auto tested = static_cast<std::size_t>(std::ceil(round * static_cast<double>(lamps.size())));
  const float part = is_first ? 1.0F : renewed_fraction(dt_s / round, config);
  std::vector<float> residuals;
  for (std::size_t i = 0; i < tested; ++i) {
    float& score = scores_[next_candidate_];
    score += part * (score_of(lamps[next_candidate_], points_, place_world_m, residuals) - score);
    next_candidate_ = (next_candidate_ + 1) % lamps.size();
  }
}

void LightEstimator::add(std::span<const LightSample> samples, const Eigen::Vector3f& place_world_m,
                         double dt_s, const LightConfig& config) {
  constexpr std::size_t kFewest = 30;
  if (!place_world_m.allFinite() || !std::isfinite(dt_s)) return;
  keep_points(samples);
  if (points_.size() < kFewest) return;
  // While points are few, an estimate from more of them replaces an earlier one sooner.
  const float of_points =
      points_.size() < kMostPoints
          ? std::min(1.0F, static_cast<float>(samples.size()) / static_cast<float>(points_.size()))
          : 0.0F;
  const float part = light_ ? std::max(renewed_fraction(dt_s, config), of_points) : 1.0F;
  test_candidates(place_world_m, dt_s, config);
  const std::vector<float> weights = weights_of(scores_);
  Candidate mean{0, Eigen::Vector3f::Zero(), 0.0F, 0.0F};
  std::array<float, kLampDirections> lamps{};
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const Candidate& lamp = candidates()[i];
    mean.direction += weights[i] * lamp.direction;
    mean.distance_m += weights[i] * lamp.distance_m;
    mean.strength += weights[i] * lamp.strength;
    lamps[lamp.number] += weights[i] * lamp.strength;
  }
  mean.direction.normalize();
  log_level_ += part * (log_level_of(mean, lamps, points_, place_world_m) - log_level_);
  for (std::size_t i = 0; i < kLampDirections; ++i) lamps_[i] += part * (lamps[i] - lamps_[i]);
  light_ = light_at({});
}

RoomLight LightEstimator::light_at(const LightReach& reach) const {
  if (scores_.empty()) return {};
  LightBasis shape = LightBasis::Zero();
  shape(0) = reach.ambient;
  shape(3) = kFromAbove * reach.ambient;
  for (std::size_t i = 0; i < kLampDirections; ++i)
    shape += reach.lamps[i] * lamps_[i] * directed_light(lamp_directions()[i]);
  return {shape * log_level_.array().exp().matrix().transpose()};
}

}  // namespace roomradar
