// room_light.cpp: evaluates and splits the irradiance of a room.
#include "app/render/room_light.hpp"

#include <algorithm>

namespace roomradar {
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
  MainLight main;
  const Eigen::Matrix3f linear = light.coefficients.middleRows<3>(1);  // a column per channel
  const Eigen::Vector3f mean = light.coefficients.row(0).transpose();
  const Eigen::Vector3f sum = linear.rowwise().sum();
  if (sum.norm() > 1e-6F) main.to_light_world = sum.cast<double>().normalized();
  const Eigen::Vector3f to_light = main.to_light_world.cast<float>();
  // No channel gets more directed light than its mean allows without negative ambient light.
  main.directed = (2.0F * linear.transpose() * to_light).cwiseMax(0.0F).cwiseMin(4.0F * mean.cwiseMax(0.0F));
  main.ambient = (mean - 0.25F * main.directed).cwiseMax(0.0F);
  return main;
}

RoomLight shaded(const RoomLight& light, float directed_fraction, float ambient_fraction) {
  const MainLight main = main_light(light);
  const Eigen::Matrix<float, 9, 3> directed =
      directed_light(main.to_light_world.cast<float>()) * main.directed.transpose();
  return {ambient_fraction * (light.coefficients - directed) + directed_fraction * directed};
}

}  // namespace roomradar
