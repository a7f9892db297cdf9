// room_light.cpp: evaluates and splits the irradiance of a room.
#include "app/render/room_light.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roomradar {
namespace {

using LampDirections = std::array<Eigen::Vector3f, kLampDirections>;

LampDirections directions_on_rings() {
  constexpr int kRings = 5;
  constexpr std::array<int, kRings> kCounts{12, 12, 12, 6, 1};
  constexpr std::array<float, kRings> kElevations_deg{15.0F, 35.0F, 55.0F, 75.0F, 90.0F};
  LampDirections directions;
  std::size_t made = 0;
  for (std::size_t ring = 0; ring < kRings; ++ring)
    for (int i = 0; i < kCounts[ring]; ++i) {
      const float up = kElevations_deg[ring] * std::numbers::pi_v<float> / 180.0F;
      const float around =
          2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(kCounts[ring]);
      directions[made++] = {std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up)};
    }
  return directions;
}

}  // namespace

std::span<const Eigen::Vector3f, kLampDirections> lamp_directions() {
  static const LampDirections directions = directions_on_rings();
  return directions;
}

LightBasis light_basis(const Eigen::Vector3f& n) {
  LightBasis basis;
  basis << 1.0F, n, n.x() * n.y(), n.y() * n.z(), n.z() * n.x(), 3.0F * n.z() * n.z() - 1.0F,
      n.x() * n.x() - n.y() * n.y();
  return basis;
}

LightBasis directed_light(const Eigen::Vector3f& l) {
  constexpr float kMean = 0.25F, kLinear = 0.5F, kSquare = 5.0F / 16.0F;
  LightBasis c;
  c << kMean, kLinear * l, 3.0F * kSquare * l.x() * l.y(), 3.0F * kSquare * l.y() * l.z(),
      3.0F * kSquare * l.z() * l.x(), 0.25F * kSquare * (3.0F * l.z() * l.z() - 1.0F),
      0.75F * kSquare * (l.x() * l.x() - l.y() * l.y());
  return c;
}

Eigen::Vector3f irradiance(const RoomLight& light, const Eigen::Vector3f& normal_world) {
  return (light.coefficients.transpose() * light_basis(normal_world)).cwiseMax(0.0F);
}

MainLight main_light(const RoomLight& light) {
  constexpr int kRounds = 4;  // the ambient light depends on the directed light, by kFromAbove / 4
  MainLight main;
  const Eigen::Matrix3f linear = light.coefficients.middleRows<3>(1);  // a column per channel
  const Eigen::Vector3f mean = light.coefficients.row(0).transpose().cwiseMax(0.0F);
  float directed = 0.0F;
  for (int round = 0; round < kRounds; ++round) {
    const float ambient = std::max(0.0F, mean.sum() - 0.25F * directed);
    const Eigen::Vector3f of_lamps = linear.rowwise().sum() - kFromAbove * ambient * Eigen::Vector3f::UnitZ();
    directed = 2.0F * of_lamps.norm();
    main.to_light_world = directed > 1e-6F ? of_lamps.cast<double>().normalized() : Eigen::Vector3d::UnitZ();
  }
  const Eigen::Vector3f to_light = main.to_light_world.cast<float>();
  const float rise = kFromAbove * to_light.z();
  // No channel gets more directed light than its mean allows without negative ambient light.
  main.directed = (2.0F * (linear.transpose() * to_light - rise * mean) / (1.0F - 0.5F * rise))
                      .cwiseMax(0.0F)
                      .cwiseMin(4.0F * mean);
  main.ambient = (mean - 0.25F * main.directed).cwiseMax(0.0F);
  return main;
}

}  // namespace roomradar
