// sheet_vertex.cpp: zero crossings, weighted by whether they are measured.
#include "mapping/surface/sheet_vertex.hpp"

#include <cmath>
#include <cstdint>
#include <utility>

namespace roomradar {
namespace {

// Weight of an extrapolated crossing in a vertex's position. Above 0, so two cells that share their only
// measured crossing get distinct vertices along the surface.
constexpr float kOfGuess = 0.05F;

bool is_measured_crossing(const TsdfSample& from, const TsdfSample& to) {
  return !from.extrapolated && !to.extrapolated && (from.distance_m < 0.0F) != (to.distance_m < 0.0F);
}

}  // namespace

Eigen::Vector3f corner_position(unsigned corner) {
  return {static_cast<float>(corner & 1U), static_cast<float>(corner >> 1U & 1U),
          static_cast<float>(corner >> 2U & 1U)};
}

SheetVertex place_vertex(const CellCorners& corners, const Sheets& sheets, int sheet) {
  SheetVertex vertex;
  Eigen::Vector3f colour_sum = Eigen::Vector3f::Zero();
  float colour_weight = 0.0F;
  float crossings = 0.0F;
  for (unsigned e = 0; e < 12; ++e) {
    const auto [a, b] = kCellEdges[e];
    const TsdfSample& from = *corners.samples[a];
    const TsdfSample& to = *corners.samples[b];
    if ((from.distance_m < 0.0F) == (to.distance_m < 0.0F) || sheets.of_edge[e] != sheet) continue;
    const float weight = is_measured_crossing(from, to) ? 1.0F : kOfGuess;
    const float t = from.distance_m / (from.distance_m - to.distance_m);
    vertex.position += weight * (corners.positions[a] + t * (corners.positions[b] - corners.positions[a]));
    crossings += weight;
    for (const auto& [sample, share] : {std::pair{&from, 1.0F - t}, std::pair{&to, t}}) {
      if (!sample->has_colour) continue;
      colour_sum += (share + 1e-3F) * Eigen::Vector3f(sample->colour.r, sample->colour.g, sample->colour.b);
      colour_weight += share + 1e-3F;
    }
  }
  vertex.position /= crossings;
  if (colour_weight > 0.0F) {
    const Eigen::Vector3f mean = colour_sum / colour_weight;
    const auto channel = [](float value) { return static_cast<std::uint8_t>(std::lround(value)); };
    vertex.colour = {channel(mean.x()), channel(mean.y()), channel(mean.z())};
  }
  return vertex;
}

Eigen::Vector3f normal_at(const std::array<const TsdfSample*, 8>& corners, const Eigen::Vector3f& position) {
  Eigen::Vector3f gradient = Eigen::Vector3f::Zero();
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3f towards = corner_position(corner);
    const Eigen::Vector3f share =
        towards.array() * position.array() + (1.0F - towards.array()) * (1.0F - position.array());
    const Eigen::Vector3f sign = 2.0F * towards - Eigen::Vector3f::Ones();
    gradient += corners[corner]->distance_m * Eigen::Vector3f(sign.x() * share.y() * share.z(),
                                                              share.x() * sign.y() * share.z(),
                                                              share.x() * share.y() * sign.z());
  }
  return gradient.normalized();  // Eigen keeps zero
}

}  // namespace roomradar
