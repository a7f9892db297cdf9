// exposure_gains.cpp: alternates between the colours of points and the gains of views.
#include "mapping/texture/exposure_gains.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/texture/view_alignment.hpp"
#include "mapping/types/system/parallel_for.hpp"

namespace roomradar {
namespace {

constexpr std::size_t kPoints = 6000;
constexpr std::size_t kMinShared = 20;
constexpr int kRounds = 20;
constexpr float kDark = 12.0F, kBright = 243.0F;  // noise and saturation beyond
constexpr float kMaxLog = 0.7F;                   // a factor of two

struct Sample {
  std::uint32_t view = 0;
  Eigen::Array3f log_colour;
};

float median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Returns the colours of the centres of evenly chosen triangles, in all views that show them. Leaves out
/// centres that fewer than two views show.
std::vector<std::vector<Sample>> shared_points(const Mesh& mesh, std::span<const TextureView> views) {
  const std::size_t step = std::max<std::size_t>(1, mesh.triangles.size() / kPoints);
  std::vector<std::vector<Sample>> points((mesh.triangles.size() + step - 1) / step);
  const auto collect = [&](std::size_t i) {
    const MeshPoint centre =
        mesh_point(mesh, static_cast<std::uint32_t>(i * step), Eigen::Vector3f::Constant(1.0F / 3.0F));
    std::vector<Sample>& samples = points[i];
    for (std::uint32_t v = 0; v < views.size(); ++v) {
      const ShownPoint point = shown(views[v], centre.p_local, centre.normal);
      if (!(point.score > 0.0F)) continue;
      const Eigen::Array3f colour = low_colour_at(views[v], point.pixel);
      if (colour.minCoeff() > kDark && colour.maxCoeff() < kBright)
        samples.push_back({v, Eigen::Array3f(colour.log())});
    }
  };
  constexpr std::size_t kPointsAtOnce = 128;
  parallel_ranges(points.size(), kPointsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) collect(i);
  });
  std::erase_if(points, [](const std::vector<Sample>& samples) { return samples.size() < 2; });
  return points;
}

/// Scales all gains such that 98 % of the points' brightest channels are below white in their median view.
void keep_highlights(const std::vector<std::vector<Sample>>& points, std::span<TextureView> views) {
  constexpr float kWhite = 240.0F, kMinScale = 0.6F;
  std::vector<float> brightest, values;
  for (const std::vector<Sample>& samples : points) {
    values.clear();
    for (const Sample& sample : samples) {
      const std::array<float, 3>& gain = views[sample.view].gain;
      values.push_back((sample.log_colour.exp() * Eigen::Array3f(gain[0], gain[1], gain[2])).maxCoeff());
    }
    brightest.push_back(median(values));
  }
  if (brightest.empty()) return;
  const auto high = brightest.begin() + static_cast<std::ptrdiff_t>(brightest.size() * 98 / 100);
  std::nth_element(brightest.begin(), high, brightest.end());
  const float scale = std::clamp(kWhite / *high, kMinScale, 1.0F);
  for (TextureView& view : views)
    for (float& gain : view.gain) gain *= scale;
}

}  // namespace

void even_exposure(const Mesh& mesh, std::span<TextureView> views) {
  const std::vector<std::vector<Sample>> points = shared_points(mesh, views);
  std::vector<std::size_t> shared(views.size(), 0);
  for (const std::vector<Sample>& samples : points)
    for (const Sample& sample : samples) ++shared[sample.view];
  constexpr std::size_t kChannels = 3;
  parallel_for(kChannels, hardware_threads(), [&](std::size_t c, unsigned) {
    const auto channel = static_cast<Eigen::Index>(c);
    std::vector<float> values;
    std::vector<float> log_gain(views.size(), 0.0F);
    for (int round = 0; round < kRounds; ++round) {
      std::vector<std::vector<float>> residuals(views.size());
      for (const std::vector<Sample>& samples : points) {
        values.clear();
        for (const Sample& sample : samples)
          values.push_back(sample.log_colour[channel] + log_gain[sample.view]);
        const float point = median(values);
        for (const Sample& sample : samples)
          residuals[sample.view].push_back(point - sample.log_colour[channel]);
      }
      float sum = 0.0F;
      float count = 0.0F;
      for (std::size_t v = 0; v < views.size(); ++v) {
        if (shared[v] < kMinShared) continue;
        log_gain[v] = std::clamp(median(residuals[v]), -kMaxLog, kMaxLog);
        sum += log_gain[v];
        count += 1.0F;
      }
      for (std::size_t v = 0; v < views.size(); ++v)
        if (shared[v] >= kMinShared) log_gain[v] -= sum / count;
    }
    for (std::size_t v = 0; v < views.size(); ++v) views[v].gain[c] = std::exp(log_gain[v]);
  });
  keep_highlights(points, views);
}

}  // namespace roomradar
