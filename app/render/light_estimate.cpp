// light_estimate.cpp: compares candidate lamps by the variance of albedo that they leave within each hue.
#include "app/render/light_estimate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mapping/types/system/config_check.hpp"

namespace roomradar {
namespace {

constexpr int kHuesAcross = 24;
constexpr int kHues = kHuesAcross * kHuesAcross;
constexpr float kHueWidth = 0.22F;  // of log ratios of linear colours
constexpr float kFromAbove = 0.2F;  // slope of the ambient light, over its mean
constexpr double kRound_s = 0.5;    // time in which each candidate is tested again

/// A lamp beside ambient light of mean irradiance 1.
struct Candidate {
  Eigen::Vector3f direction;
  float distance_m;
  float strength;  ///< irradiance at the place on a surface that faces the lamp
};

const std::vector<Candidate>& candidates() {
  static const std::vector<Candidate> all = [] {
    constexpr int kRings = 5;
    constexpr std::array<int, kRings> kCounts{12, 12, 12, 6, 1};
    constexpr std::array<float, kRings> kElevations_deg{15.0F, 35.0F, 55.0F, 75.0F, 90.0F};
    std::vector<Candidate> made;
    for (std::size_t ring = 0; ring < kRings; ++ring)
      for (int i = 0; i < kCounts[ring]; ++i) {
        const float up = kElevations_deg[ring] * std::numbers::pi_v<float> / 180.0F;
        const float around =
            2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(kCounts[ring]);
        const Eigen::Vector3f direction(std::cos(up) * std::cos(around), std::cos(up) * std::sin(around),
                                        std::sin(up));
        for (const float distance_m : {1.5F, 3.0F, 8.0F})
          for (const float strength : {0.5F, 1.2F, 2.5F}) made.push_back({direction, distance_m, strength});
      }
    return made;
  }();
  return all;
}

/// Returns the irradiance of a surface point from a candidate and the ambient light.
float irradiance_of(const Candidate& lamp, const Eigen::Vector3f& from_place_m,
                    const Eigen::Vector3f& normal) {
  constexpr float kNearest_m2 = 0.1F;
  const Eigen::Vector3f way = lamp.distance_m * lamp.direction - from_place_m;
  const float squared_m2 = std::max(way.squaredNorm(), kNearest_m2);
  const float facing = std::max(0.0F, normal.dot(way)) / std::sqrt(squared_m2);
  return 1.0F + kFromAbove * normal.z() +
         lamp.strength * lamp.distance_m * lamp.distance_m / squared_m2 * facing;
}

int hue_of(const Eigen::Vector3f& log_colour) {
  const auto bin = [](float ratio) {
    return static_cast<int>(std::clamp(ratio / kHueWidth + 0.5F * kHuesAcross, 0.0F, kHuesAcross - 1.0F));
  };
  return bin(log_colour.x() - log_colour.y()) * kHuesAcross + bin(log_colour.z() - log_colour.y());
}

/// Returns the squared residual of log albedo within the hues, with outliers limited, averaged over points.
template <typename Points>
float score_of(const Candidate& lamp, const Points& points, std::vector<float>& residuals) {
  constexpr float kOutlier2 = 0.36F;
  std::array<float, kHues> sums{}, counts{};
  residuals.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& point = points[i];
    residuals[i] = point.grey - std::log(irradiance_of(lamp, point.from_place_m, point.normal_world));
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
/// compared with that of usual rooms. The colour is drawn towards neutral, since cameras balance white, and
/// since the things of a room are yellowish on average.
template <typename Points>
Eigen::Vector3f log_level_of(const Candidate& lamp, const Points& points) {
  constexpr float kNorm = 6.0F, kUsualAlbedo = 0.5F, kTrustInColour = 0.6F;
  Eigen::Array<float, 3, Eigen::Dynamic> sums = Eigen::Array<float, 3, Eigen::Dynamic>::Zero(3, kHues);
  Eigen::ArrayXf counts = Eigen::ArrayXf::Zero(kHues);
  for (const auto& point : points) {
    const float log_light = std::log(irradiance_of(lamp, point.from_place_m, point.normal_world));
    sums.col(point.hue) += point.log_colour.array() - log_light;
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
  require(config.samples >= 0 && config.samples <= 100'000, "samples", static_cast<float>(config.samples),
          "in 0..100000");
  require(config.memory_s > 0.0 && config.memory_s <= 60.0, "memory_s", static_cast<float>(config.memory_s),
          "in 0..60, not 0");
}

float renewed_fraction(double seconds, const LightConfig& config) {
  return static_cast<float>(1.0 - std::exp(-std::max(seconds, 0.0) / config.memory_s));
}

void LightEstimator::take_points(std::span<const LightSample> samples, const Eigen::Vector3f& place_world_m) {
  points_.clear();
  for (const LightSample& sample : samples)
    if (sample.p_world_m.allFinite() && sample.normal_world.allFinite() && sample.log_colour.allFinite())
      points_.push_back({sample.p_world_m - place_world_m, sample.normal_world, sample.log_colour,
                         sample.log_colour.mean(), hue_of(sample.log_colour)});
}

void LightEstimator::add(std::span<const LightSample> samples, const Eigen::Vector3f& place_world_m,
                         double dt_s, const LightConfig& config) {
  constexpr std::size_t kFewest = 30;
  if (!place_world_m.allFinite() || !std::isfinite(dt_s)) return;
  take_points(samples, place_world_m);
  if (points_.size() < kFewest) return;
  const std::vector<Candidate>& lamps = candidates();
  const bool is_first = scores_.empty();
  scores_.resize(lamps.size());
  const auto part_after = [&](double seconds) { return is_first ? 1.0F : renewed_fraction(seconds, config); };
  const double round = std::clamp(dt_s / kRound_s, 1.0 / 64.0, 1.0);  // fraction tested in this frame
  const std::size_t tested =
      is_first ? lamps.size()
               : static_cast<std::size_t>(std::ceil(round * static_cast<double>(lamps.size())));
  const float score_part = part_after(dt_s / round);
  std::vector<float> residuals;
  for (std::size_t i = 0; i < tested; ++i) {
    float& score = scores_[next_candidate_];
    score += score_part * (score_of(lamps[next_candidate_], points_, residuals) - score);
    next_candidate_ = (next_candidate_ + 1) % lamps.size();
  }

  const std::vector<float> weights = weights_of(scores_);
  Candidate mean{Eigen::Vector3f::Zero(), 0.0F, 0.0F};
  LightBasis shape = LightBasis::Zero();
  shape(0) = 1.0F;
  shape(3) = kFromAbove;
  for (std::size_t i = 0; i < lamps.size(); ++i) {
    mean.direction += weights[i] * lamps[i].direction;
    mean.distance_m += weights[i] * lamps[i].distance_m;
    mean.strength += weights[i] * lamps[i].strength;
    shape += weights[i] * lamps[i].strength * directed_light(lamps[i].direction);
  }
  mean.direction.normalize();
  log_level_ += part_after(dt_s) * (log_level_of(mean, points_) - log_level_);
  const Eigen::Matrix<float, 9, 3> coefficients = shape * log_level_.array().exp().matrix().transpose();
  if (!coefficients.allFinite()) return;
  if (!light_) light_ = RoomLight{coefficients};
  light_->coefficients += part_after(dt_s) * (coefficients - light_->coefficients);
}

}  // namespace roomradar
