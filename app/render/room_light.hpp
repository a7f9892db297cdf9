// room_light.hpp: irradiance of a room as a function of the surface normal, and its main direction.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <span>

namespace roomradar {

/// Relative slope of ambient light with the normal's z: a surface that faces up gets 1 + kFromAbove times the
/// mean.
inline constexpr float kFromAbove = 0.1F;

/// Number of candidate directions of lamps, on rings at 15 to 90 degrees above the horizon.
inline constexpr std::size_t kLampDirections = 43;
std::span<const Eigen::Vector3f, kLampDirections> lamp_directions();

/// Fractions, 0 to 1, of the light that the room's surfaces do not occlude at a place.
struct LightReach {
  float ambient = 1.0F;
  /// Fraction for a lamp in each of lamp_directions().
  std::array<float, kLampDirections> lamps = [] {
    std::array<float, kLampDirections> all{};
    all.fill(1.0F);
    return all;
  }();
};

/// Polynomials of a unit normal up to order 2: 1; x, y, z; xy, yz, zx, 3z^2 - 1, x^2 - y^2. They are the real
/// spherical harmonics up to constant factors. Source: Ramamoorthi and Hanrahan, An efficient representation
/// for irradiance environment maps, SIGGRAPH 2001: order 2 represents the irradiance of any distant light
/// with a mean error of 1 %.
using LightBasis = Eigen::Matrix<float, 9, 1>;
LightBasis light_basis(const Eigen::Vector3f& normal);
/// Returns the coefficients of max(0, n.l) up to order 2: 1/4 + t/2 + 5/16 P2(t) with t = n.l and the
/// Legendre polynomial P2.
/// @param l  unit
LightBasis directed_light(const Eigen::Vector3f& l);

/// Irradiance on a surface with a given normal, in the world, relative to the irradiance that shows a white
/// surface at 255.
struct RoomLight {
  /// Coefficients of light_basis(); a column per colour channel.
  Eigen::Matrix<float, 9, 3> coefficients = Eigen::Matrix<float, 9, 3>::Zero();
};

/// Returns red, green and blue irradiance, >= 0.
Eigen::Vector3f irradiance(const RoomLight& light, const Eigen::Vector3f& normal_world);

/// A light from one direction together with light from everywhere.
struct MainLight {
  /// Unit; +z if the light comes equally from everywhere.
  Eigen::Vector3d to_light_world = Eigen::Vector3d::UnitZ();
  /// Irradiance of a surface that faces the directed light, from that light alone, per channel.
  Eigen::Vector3f directed = Eigen::Vector3f::Zero();
  /// Irradiance from everywhere, per channel.
  Eigen::Vector3f ambient = Eigen::Vector3f::Zero();
};

/// Separates ambient and directed light: A (1 + kFromAbove z) + D max(0, n.l) has the mean A + D / 4 and the
/// linear coefficient kFromAbove A z + D / 2 l. The direction is that of the channels' sum.
MainLight main_light(const RoomLight& light);

/// A light, and its separation into directed and ambient light.
struct SplitLight {
  RoomLight whole;
  MainLight main;
};

}  // namespace roomradar
