// texture_charts.cpp: grows charts over edges of triangles, orients them, and splits off overlaps.
#include "mapping/texture/texture_charts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "mapping/texture/chart_texels.hpp"
#include "mapping/texture/mesh_raster.hpp"

namespace roomradar {
namespace {

constexpr float kMinCosine = 0.64F;  // 50 degrees: a texel is then stretched by at most 1.6
constexpr float kMaxExtent_m = 1.0F;
constexpr int kDirections = 12;  // tried for the smallest rectangle around a chart

/// Neighbours of each triangle across its three edges; kNoTriangle: none.
std::vector<std::array<std::uint32_t, 3>> neighbours_of(const Mesh& mesh) {
  struct Edge {
    std::uint64_t ends;
    std::uint32_t triangle;
    std::uint32_t side;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::uint32_t side = 0; side < 3; ++side) {
      const auto [low, high] = std::minmax(mesh.triangles[t][side], mesh.triangles[t][(side + 1) % 3]);
      edges.push_back({(std::uint64_t{low} << 32U) | high, t, side});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::pair(a.ends, a.triangle) < std::pair(b.ends, b.triangle);
  });
  std::vector<std::array<std::uint32_t, 3>> neighbours(mesh.triangles.size(),
                                                       {kNoTriangle, kNoTriangle, kNoTriangle});
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const Edge &a = edges[i], &b = edges[i + 1];
    if (a.ends != b.ends) continue;
    neighbours[a.triangle][a.side] = b.triangle;
    neighbours[b.triangle][b.side] = a.triangle;
  }
  return neighbours;
}

/// Normal times twice the area, m2.
Eigen::Vector3f area_normal(const Mesh& mesh, std::uint32_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  const Eigen::Vector3f& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
}

/// Two unit vectors perpendicular to the normal and to each other; seen from outside, y points down if x
/// points right, so that an atlas is not mirrored.
Eigen::Matrix<float, 2, 3> axes_across(const Eigen::Vector3f& normal) {
  Eigen::Matrix<float, 2, 3> axes;
  axes.row(0) = normal.unitOrthogonal();
  axes.row(1) = Eigen::Vector3f(axes.row(0)).cross(normal);
  return axes;
}

/// Sets axes, low and size of the smallest rectangle, among a few directions, around the chart.
void set_rectangle(const Mesh& mesh, const Eigen::Vector3f& normal, TextureChart& chart) {
  const Eigen::Matrix<float, 2, 3> first = axes_across(normal);
  float least_m2 = std::numeric_limits<float>::infinity();
  for (int i = 0; i < kDirections; ++i) {
    const float angle = static_cast<float>(i) / kDirections * 1.5707963F;
    const Eigen::Matrix<float, 2, 3> axes = Eigen::Rotation2Df(angle).toRotationMatrix() * first;
    Eigen::AlignedBox2f box;
    for (const std::uint32_t t : chart.triangles)
      for (const std::uint32_t vertex : mesh.triangles[t]) box.extend(axes * mesh.vertices[vertex]);
    const Eigen::Vector2f size_m = box.sizes();
    const float area_m2 = (size_m.x() + 0.01F) * (size_m.y() + 0.01F);  // 1 cm: as padding, for thin charts
    if (!(area_m2 < least_m2)) continue;
    least_m2 = area_m2;
    chart.axes = axes;
    chart.low_m = box.min();
    chart.size_m = size_m;
  }
}

class Grower {
 public:
  Grower(const Mesh& mesh, std::span<const float> texels_per_m)
      : mesh_(mesh),
        texels_per_m_(texels_per_m),
        neighbours_(neighbours_of(mesh)),
        is_taken_(mesh.triangles.size(), false) {
    normals_.reserve(mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) normals_.push_back(area_normal(mesh, t));
  }

  std::vector<TextureChart> grow_all() {
    std::vector<std::uint32_t> seeds(mesh_.triangles.size());
    std::iota(seeds.begin(), seeds.end(), 0U);
    std::stable_sort(seeds.begin(), seeds.end(), [&](std::uint32_t a, std::uint32_t b) {
      return normals_[a].squaredNorm() > normals_[b].squaredNorm();
    });
    std::vector<TextureChart> charts;
    // Triangles that overlap others of their chart are seeds of the next round.
    while (!seeds.empty()) {
      std::vector<std::uint32_t> overlapping;
      for (const std::uint32_t seed : seeds) {
        if (is_taken_[seed]) continue;
        TextureChart chart = grow(seed);
        const std::vector<std::uint32_t> split = overlapping_triangles(mesh_, chart);
        if (!split.empty()) {
          for (const std::uint32_t t : split) is_taken_[t] = false;
          std::erase_if(chart.triangles, [&](std::uint32_t t) { return !is_taken_[t]; });
          overlapping.insert(overlapping.end(), split.begin(), split.end());
        }
        charts.push_back(std::move(chart));
      }
      seeds = std::move(overlapping);
    }
    return charts;
  }

 private:
  TextureChart grow(std::uint32_t seed) {
    TextureChart chart;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    Eigen::AlignedBox3f box;
    const auto take = [&](std::uint32_t t) {
      is_taken_[t] = true;
      chart.triangles.push_back(t);
      sum += normals_[t];
      for (const std::uint32_t vertex : mesh_.triangles[t]) box.extend(mesh_.vertices[vertex]);
    };
    take(seed);
    for (std::size_t next = 0; next < chart.triangles.size(); ++next) {
      for (const std::uint32_t t : neighbours_[chart.triangles[next]]) {
        if (t == kNoTriangle || is_taken_[t]) continue;
        if (!(normals_[t].dot(sum) > kMinCosine * normals_[t].norm() * sum.norm())) continue;
        Eigen::AlignedBox3f grown = box;
        for (const std::uint32_t vertex : mesh_.triangles[t]) grown.extend(mesh_.vertices[vertex]);
        if (grown.sizes().maxCoeff() > std::max(kMaxExtent_m, box.sizes().maxCoeff())) continue;
        take(t);
      }
    }
    // The mean may have turned since the first triangles were taken.
    const float length = sum.norm();
    const Eigen::Vector3f normal = length > 0.0F ? Eigen::Vector3f(sum / length) : Eigen::Vector3f::UnitZ();
    release_turned(normal, chart);
    set_rectangle(mesh_, normal, chart);
    chart.texel_m = texel_of(chart);
    return chart;
  }

  /// Gives back triangles that the projection would hardly show, except the seed.
  void release_turned(const Eigen::Vector3f& normal, TextureChart& chart) {
    constexpr float kHardly = 0.4F;
    for (std::size_t i = 1; i < chart.triangles.size(); ++i) {
      const std::uint32_t t = chart.triangles[i];
      if (normals_[t].dot(normal) < kHardly * normals_[t].norm()) is_taken_[t] = false;
    }
    std::erase_if(chart.triangles, [&](std::uint32_t t) { return !is_taken_[t]; });
  }

  [[nodiscard]] float texel_of(const TextureChart& chart) const {
    double sum = 0.0, area = 0.0;
    for (const std::uint32_t t : chart.triangles) {
      const double weight = double{normals_[t].norm()} + 1e-12;
      sum += weight * double{texels_per_m_[t]};
      area += weight;
    }
    return static_cast<float>(area / sum);
  }

  const Mesh& mesh_;
  std::span<const float> texels_per_m_;
  std::vector<std::array<std::uint32_t, 3>> neighbours_;
  std::vector<Eigen::Vector3f> normals_;  // area_normal() of each triangle
  std::vector<bool> is_taken_;
};

}  // namespace

std::vector<TextureChart> texture_charts(const Mesh& mesh, std::span<const float> texels_per_m) {
  return Grower(mesh, texels_per_m).grow_all();
}

}  // namespace roomradar
