// texture_bake.cpp: selects the best views per block of texels, and blends their colours; fills gaps by
// push-pull.
#include "mapping/texture/texture_bake.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "mapping/texture/chart_packing.hpp"
#include "mapping/texture/chart_texels.hpp"
#include "mapping/texture/mesh_raster.hpp"
#include "mapping/texture/texture_charts.hpp"
#include "mapping/texture/view_alignment.hpp"
#include "mapping/types/codecs/jpeg.hpp"
#include "mapping/types/system/parallel_for.hpp"

namespace roomradar {
namespace {

constexpr int kBlock_px = 16;  // blocks of texels share their candidate views
constexpr std::size_t kCandidates = 8;
constexpr float kMinTexelsPerM = 50.0F;   // 2 cm: surface that no view shows
constexpr float kDetailPower = 4.0F;      // a view with 80 % of the best score has 41 % of its weight
constexpr float kTexelsPerPixel = 1.25F;  // of the best view, since it is interpolated
constexpr float kOverexposed = 0.3F;      // factor of the score where a picture is white
constexpr float kMaxShift = 24.0F;        // of the colour without detail, from the best view's to the mean

using Earlier = std::span<const std::unique_ptr<const EarlierTexture>>;

/// Colour of the mesh's vertices at a point.
Eigen::Array3f mesh_colour(const Mesh& mesh, const MeshPoint& point) {
  Eigen::Array3f colour = Eigen::Array3f::Zero();
  if (mesh.colours.empty()) return colour;
  for (std::size_t k = 0; k < 3; ++k) {
    const Rgb& own = mesh.colours[mesh.triangles[point.triangle][k]];
    colour += point.weights[static_cast<Eigen::Index>(k)] * Eigen::Array3f(own.r, own.g, own.b);
  }
  return colour;
}

/// Returns texels per metre for each triangle: as many as its best view has pixels at its centre.
std::vector<float> texels_per_m(const Mesh& mesh, std::span<const TextureView> views, Earlier earlier,
                                double min_texel_m) {
  std::vector<float> wanted(mesh.triangles.size(), kMinTexelsPerM);
  const auto most = static_cast<float>(1.0 / min_texel_m);
  const Eigen::Vector3f middle = Eigen::Vector3f::Constant(1.0F / 3.0F);
  const auto set = [&](std::uint32_t t) {
    const MeshPoint point = mesh_point(mesh, t, middle);
    for (const TextureView& view : views)
      wanted[t] = std::max(wanted[t], shown(view, point.p_local, point.normal).px_per_m);
    wanted[t] *= kTexelsPerPixel;
    if (const auto found = find_densest(earlier, mesh.origin + point.p_local.cast<double>(), point.normal))
      wanted[t] = std::max(wanted[t], found->texels_per_m);
    wanted[t] = std::min(wanted[t], most);
  };
  constexpr std::size_t kTrianglesAtOnce = 1024;
  parallel_ranges(wanted.size(), kTrianglesAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) set(static_cast<std::uint32_t>(t));
  });
  return wanted;
}

/// Colour of one point in one view.
struct Look {
  float score = 0.0F;
  Eigen::Array3f full, low;

  [[nodiscard]] float brightness() const { return low.sum() / 3.0F; }
};

/// Returns the brightness at which the looks' weights are halved.
float median_brightness(std::span<const Look> looks) {
  std::vector<std::pair<float, float>> sorted;
  float sum = 0.0F;
  for (const Look& look : looks) {
    sorted.emplace_back(look.brightness(), look.score);
    sum += look.score;
  }
  std::sort(sorted.begin(), sorted.end());
  float below = 0.0F;
  for (const auto& [brightness, score] : sorted)
    if ((below += score) >= 0.5F * sum) return brightness;
  return sorted.back().first;
}

/// Returns the colour of a point; unset if no view shows it.
/// @param looks  scratch
std::optional<Eigen::Array3f> colour_of(const MeshPoint& point, std::span<const TextureView> views,
                                        std::span<const std::uint32_t> candidates, std::vector<Look>& looks) {
  looks.clear();
  for (const std::uint32_t v : candidates) {
    const ShownPoint seen = shown(views[v], point.p_local, point.normal);
    if (!(seen.score > 0.0F)) continue;
    const float exposure = is_overexposed(views[v], seen.pixel) ? kOverexposed : 1.0F;
    looks.push_back(
        {exposure * seen.score, colour_at(views[v], seen.pixel), low_colour_at(views[v], seen.pixel)});
  }
  if (looks.empty()) return std::nullopt;
  if (looks.size() >= 3) {
    const float median = median_brightness(looks);
    std::erase_if(looks, [&](const Look& look) {
      return std::abs(look.brightness() - median) > 25.0F + 0.12F * median;
    });
  }
  float best = 0.0F;
  for (const Look& look : looks) best = std::max(best, look.score);
  Eigen::Array3f detail = Eigen::Array3f::Zero(), best_low = detail, mean_low = detail;
  float detail_weights = 0.0F, weights = 0.0F;
  for (const Look& look : looks) {
    const float share = look.score / best;
    const float detail_weight = std::pow(share, kDetailPower), weight = share * share;
    detail += detail_weight * look.full;
    best_low += detail_weight * look.low;
    detail_weights += detail_weight;
    mean_low += weight * look.low;
    weights += weight;
  }
  const Eigen::Array3f shift = mean_low / weights - best_low / detail_weights;
  return detail / detail_weights + shift.min(kMaxShift).max(-kMaxShift);
}

/// Bakes one chart into the atlas.
class ChartBaker {
 public:
  ChartBaker(const Mesh& mesh, std::span<const TextureView> views, Earlier earlier, ColourImage& atlas,
             MaskImage& has_colour)
      : mesh_(mesh), views_(views), earlier_(earlier), atlas_(atlas), has_colour_(has_colour) {}

  void bake(const TextureChart& chart) {
    const Image<std::uint32_t> owners = triangles_of_texels(mesh_, chart);
    for (int top = 0; top < owners.height; top += kBlock_px)
      for (int left = 0; left < owners.width; left += kBlock_px) bake_block(chart, owners, left, top);
  }

 private:
  const Mesh& mesh_;
  std::span<const TextureView> views_;
  Earlier earlier_;
  ColourImage& atlas_;
  MaskImage& has_colour_;
  std::vector<MeshPoint> points_;          // of a block
  std::vector<Eigen::Vector2i> texels_;    // of points_, in the atlas
  std::vector<std::uint32_t> candidates_;  // of a block
  std::vector<Look> looks_;

  void bake_block(const TextureChart& chart, const Image<std::uint32_t>& owners, int left, int top) {
    points_.clear();
    texels_.clear();
    for (int y = top; y < std::min(top + kBlock_px, owners.height); ++y)
      for (int x = left; x < std::min(left + kBlock_px, owners.width); ++x) {
        const std::uint32_t triangle = owners.at(x, y);
        if (triangle == kNoTriangle) continue;
        const Eigen::Vector2i texel = chart.corner_px + Eigen::Vector2i(x, y);
        const Eigen::Vector2f centre = texel.cast<float>().array() + 0.5F;
        points_.push_back(mesh_point(mesh_, triangle, weights_at(mesh_, chart, triangle, centre)));
        texels_.push_back(texel);
      }
    if (points_.empty()) return;
    choose_candidates();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Eigen::Array3f colour =
          colour_of(points_[i], views_, candidates_, looks_).value_or(colour_without_views(points_[i]));
      const Eigen::Array3f rounded = (colour + 0.5F).min(255.0F).max(0.0F);
      atlas_.at(texels_[i].x(), texels_[i].y()) = {static_cast<std::uint8_t>(rounded.x()),
                                                   static_cast<std::uint8_t>(rounded.y()),
                                                   static_cast<std::uint8_t>(rounded.z())};
      has_colour_.at(texels_[i].x(), texels_[i].y()) = 255;
    }
  }

  [[nodiscard]] Eigen::Array3f colour_without_views(const MeshPoint& point) const {
    const auto found = find_densest(earlier_, mesh_.origin + point.p_local.cast<double>(), point.normal);
    return found ? found->colour : mesh_colour(mesh_, point);
  }

  /// Sets candidates_ to the views with the highest sum of scores at some points of the block.
  void choose_candidates() {
    constexpr std::size_t kSamples = 9;
    const std::size_t step = std::max<std::size_t>(1, points_.size() / kSamples);
    std::vector<std::pair<float, std::uint32_t>> scores;
    for (std::uint32_t v = 0; v < views_.size(); ++v) {
      float sum = 0.0F;
      for (std::size_t i = step / 2; i < points_.size(); i += step)
        sum += shown(views_[v], points_[i].p_local, points_[i].normal).score;
      if (sum > 0.0F) scores.emplace_back(-sum, v);
    }
    std::sort(scores.begin(), scores.end());
    candidates_.clear();
    for (std::size_t i = 0; i < std::min(scores.size(), kCandidates); ++i)
      candidates_.push_back(scores[i].second);
  }
};

/// Returns the positions of the triangles' corners in the atlas.
std::vector<std::array<AtlasPoint, 3>> corners_of(const Mesh& mesh, const std::vector<TextureChart>& charts,
                                                  const Eigen::Vector2i& size_px) {
  std::vector<std::array<AtlasPoint, 3>> corners(mesh.triangles.size());
  const Eigen::Array2f scale = 65535.0F / size_px.cast<float>().array();
  for (const TextureChart& chart : charts)
    for (const std::uint32_t t : chart.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Array2f p = atlas_point(chart, mesh.vertices[mesh.triangles[t][k]]).array() * scale;
        for (std::size_t axis = 0; axis < 2; ++axis)
          corners[t][k][axis] = static_cast<std::uint16_t>(
              std::clamp(p[static_cast<Eigen::Index>(axis)] + 0.5F, 0.0F, 65535.0F));
      }
  return corners;
}

}  // namespace

SurfaceTexture bake_texture(const Mesh& mesh, std::span<const TextureView> views,
                            std::span<const std::unique_ptr<const EarlierTexture>> earlier,
                            const TextureConfig& config) {
  if ((views.empty() && earlier.empty()) || mesh.triangles.empty() || mesh.normals.empty()) return {};
  std::vector<TextureChart> charts =
      texture_charts(mesh, texels_per_m(mesh, views, earlier, config.min_texel_m));
  const Eigen::Vector2i size_px = pack(charts, config.max_side_px);
  if (size_px.isZero()) return {};
  ColourImage atlas(size_px.x(), size_px.y());
  MaskImage has_colour(size_px.x(), size_px.y());
  const unsigned threads = hardware_threads();
  std::vector<ChartBaker> bakers(threads, ChartBaker(mesh, views, earlier, atlas, has_colour));
  parallel_for(charts.size(), threads,
               [&](std::size_t i, unsigned thread) { bakers[thread].bake(charts[i]); });
  fill_gaps(atlas, has_colour);
  return {size_px.x(), size_px.y(), jpeg_of(atlas, config.jpeg_quality), corners_of(mesh, charts, size_px),
          fingerprint(mesh)};
}

void fill_gaps(ColourImage& atlas, const MaskImage& has_colour) {
  if (std::all_of(has_colour.pixels.begin(), has_colour.pixels.end(), [](auto mask) { return mask != 0; }))
    return;
  constexpr Rgb kGrey = {128, 128, 128};
  ColourImage half((atlas.width + 1) / 2, (atlas.height + 1) / 2, kGrey);
  MaskImage half_has(half.width, half.height);
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x) {
      int r = 0, g = 0, b = 0, count = 0;
      for (int v = 2 * y; v < std::min(2 * y + 2, atlas.height); ++v)
        for (int u = 2 * x; u < std::min(2 * x + 2, atlas.width); ++u) {
          if (has_colour.at(u, v) == 0) continue;
          const Rgb& pixel = atlas.at(u, v);
          r += pixel.r;
          g += pixel.g;
          b += pixel.b;
          ++count;
        }
      if (count == 0) continue;
      half.at(x, y) = {static_cast<std::uint8_t>(r / count), static_cast<std::uint8_t>(g / count),
                       static_cast<std::uint8_t>(b / count)};
      half_has.at(x, y) = 255;
    }
  if (half.width < atlas.width || half.height < atlas.height) fill_gaps(half, half_has);
  for (int y = 0; y < atlas.height; ++y)
    for (int x = 0; x < atlas.width; ++x)
      if (has_colour.at(x, y) == 0) atlas.at(x, y) = half.at(x / 2, y / 2);
}

}  // namespace roomradar
