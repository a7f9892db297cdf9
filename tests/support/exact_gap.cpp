// exact_gap.cpp: corners of the patch that two projected triangles share, one kind after the other.
#include "tests/support/exact_gap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roomradar {
namespace {

constexpr Exact kOnOutline = 1e-12L;  // relative to the size: this far outside is still on the outline
constexpr Exact kNoArea = 1e-15L;     // relative to the size squared: an outline with less area is a line

Exact cross2(const ExactPoint& a, const ExactPoint& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Height of the triangle at p's projection, nullopt outside the outline; points on the outline are inside.
std::optional<Exact> height_at(const ExactTriangle& t, const ExactPoint& p) {
  const ExactPoint a = t[1] - t[0], b = t[2] - t[0], c = p - t[0];
  const Exact area = cross2(a, b);
  if (std::abs(area) <= kNoArea * std::max(a.squaredNorm(), b.squaredNorm())) return std::nullopt;
  const Exact v = cross2(c, b) / area, w = cross2(a, c) / area, u = 1.0L - v - w;
  if (u < -kOnOutline || v < -kOnOutline || w < -kOnOutline) return std::nullopt;
  return u * t[0].z() + v * t[1].z() + w * t[2].z();
}

class Gaps {
 public:
  void put(Exact gap) {
    least_ = std::min(least_, gap);
    most_ = std::max(most_, gap);
  }
  [[nodiscard]] std::optional<TravelSpan> span() const {
    if (least_ > most_) return std::nullopt;
    return TravelSpan{static_cast<double>(least_), static_cast<double>(most_)};
  }

 private:
  Exact least_ = std::numeric_limits<Exact>::infinity();
  Exact most_ = -std::numeric_limits<Exact>::infinity();
};

/// Calls put(height of the edge) if p projects onto the edge a b; twice if the edge is parallel to z.
template <typename Put>
void heights_on_edge(const ExactPoint& a, const ExactPoint& b, const ExactPoint& p, const Put& put) {
  const ExactPoint d = b - a, c = p - a;
  const Exact length2 = d.head<2>().squaredNorm();
  const Exact size2 = d.squaredNorm();
  if (length2 <= kNoArea * kNoArea * size2) {
    if (c.head<2>().squaredNorm() > kNoArea * kNoArea * size2) return;
    put(a.z());
    put(b.z());
    return;
  }
  const Exact s = c.head<2>().dot(d.head<2>()) / length2;
  if (s < -kOnOutline || s > 1.0L + kOnOutline) return;
  if (std::abs(cross2(d, c)) > kOnOutline * length2) return;
  put(a.z() + s * d.z());
}

void gap_of_edges(const ExactPoint& a0, const ExactPoint& a1, const ExactPoint& b0, const ExactPoint& b1,
                  Gaps& gaps) {
  const ExactPoint d = a1 - a0, e = b1 - b0, c = b0 - a0;
  const Exact crossing = cross2(d, e);
  if (std::abs(crossing) > kNoArea * d.head<2>().norm() * e.head<2>().norm()) {
    const Exact s = cross2(c, e) / crossing, t = cross2(c, d) / crossing;
    constexpr Exact kLow = -kOnOutline, kHigh = 1.0L + kOnOutline;
    if (s < kLow || s > kHigh || t < kLow || t > kHigh) return;
    gaps.put(c.z() + t * e.z() - s * d.z());
    return;
  }
  // Parallel: the patch is a line segment whose ends are ends of the edges.
  for (const ExactPoint& a : {a0, a1}) heights_on_edge(b0, b1, a, [&](Exact z) { gaps.put(z - a.z()); });
  for (const ExactPoint& b : {b0, b1}) heights_on_edge(a0, a1, b, [&](Exact z) { gaps.put(b.z() - z); });
}

}  // namespace

std::optional<TravelSpan> exact_gap(const ExactTriangle& object, const ExactTriangle& scene) {
  Gaps gaps;
  for (std::size_t i = 0; i < 3; ++i) {
    if (const auto z = height_at(scene, object[i])) gaps.put(*z - object[i].z());
    if (const auto z = height_at(object, scene[i])) gaps.put(scene[i].z() - *z);
    for (std::size_t j = 0; j < 3; ++j) {
      gap_of_edges(object[i], object[(i + 1) % 3], scene[j], scene[(j + 1) % 3], gaps);
    }
  }
  return gaps.span();
}

}  // namespace roomradar
