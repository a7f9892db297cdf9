// geo_pose.cpp: converts poses through earth-centred coordinates.
#include "app/serve/geo_pose.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "app/sources/formats/parse_numbers.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr double kSemiMajor_m = 6'378'137.0, kFlattening = 1.0 / 298.257223563;
constexpr double kEccentricity2 = kFlattening * (2.0 - kFlattening);
constexpr double kRadPerDeg = std::numbers::pi / 180.0;

/// Axes east, north and up at a point of the earth, as columns, in earth-centred coordinates.
Eigen::Matrix3d R_earth_enu(double latitude_rad, double longitude_rad) {
  const double sin_lat = std::sin(latitude_rad), cos_lat = std::cos(latitude_rad);
  const double sin_lon = std::sin(longitude_rad), cos_lon = std::cos(longitude_rad);
  Eigen::Matrix3d R;
  R.col(0) << -sin_lon, cos_lon, 0.0;
  R.col(1) << -sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat;
  R.col(2) << cos_lat * cos_lon, cos_lat * sin_lon, sin_lat;
  return R;
}

double prime_vertical_m(double latitude_rad) {
  const double sin_lat = std::sin(latitude_rad);
  return kSemiMajor_m / std::sqrt(1.0 - kEccentricity2 * sin_lat * sin_lat);
}

Eigen::Vector3d earth_point(double latitude_rad, double longitude_rad, double height_m) {
  const double n = prime_vertical_m(latitude_rad), across = (n + height_m) * std::cos(latitude_rad);
  return {across * std::cos(longitude_rad), across * std::sin(longitude_rad),
          (n * (1.0 - kEccentricity2) + height_m) * std::sin(latitude_rad)};
}

}  // namespace

GeoAnchor parse_geo_anchor(const std::string& text) {
  const auto fail = [&](const std::string& why) {
    throw Error("--anchor '" + text + "': " + why +
                "; give LATITUDE,LONGITUDE,HEIGHT,HEADING such as 48.137,11.575,520,90");
  };
  std::vector<double> numbers;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const auto number = parse_number(text.substr(at, end - at));
    if (!number || !std::isfinite(*number)) fail("'" + text.substr(at, end - at) + "' is not a number");
    numbers.push_back(*number);
    at = end + 1;
  }
  if (numbers.size() != 4) fail("has " + std::to_string(numbers.size()) + " numbers");
  if (std::abs(numbers[0]) > 90.0) fail("the latitude must be within -90..90 degrees");
  if (std::abs(numbers[1]) > 180.0) fail("the longitude must be within -180..180 degrees");
  if (std::abs(numbers[2]) > 20'000.0) fail("the height must be within -20000..20000 m");
  if (std::abs(numbers[3]) > 360.0) fail("the heading must be within -360..360 degrees");
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

GeoPose geo_pose_of(const GeoAnchor& anchor, const Eigen::Isometry3d& T_world_camera) {
  const double latitude = anchor.latitude_deg * kRadPerDeg, longitude = anchor.longitude_deg * kRadPerDeg;
  const Eigen::AngleAxisd R_enu_world(-anchor.heading_deg * kRadPerDeg, Eigen::Vector3d::UnitZ());
  const Eigen::Matrix3d R_earth_world = R_earth_enu(latitude, longitude) * R_enu_world.toRotationMatrix();
  const Eigen::Vector3d p =
      earth_point(latitude, longitude, anchor.height_m) + R_earth_world * T_world_camera.translation();

  // Fixed point of the latitude; each turn gains more than two digits.
  const double across = std::hypot(p.x(), p.y());
  double lat = std::atan2(p.z(), across * (1.0 - kEccentricity2));
  for (int i = 0; i < 8; ++i)
    lat = std::atan2(p.z() + kEccentricity2 * prime_vertical_m(lat) * std::sin(lat), across);
  const double lon = std::atan2(p.y(), p.x());
  // Along the normal, which is well defined at the poles, too.
  const double height =
      across * std::cos(lat) + p.z() * std::sin(lat) - kSemiMajor_m * kSemiMajor_m / prime_vertical_m(lat);
  GeoPose pose{lat / kRadPerDeg, lon / kRadPerDeg, height};
  pose.R_enu_camera =
      Eigen::Quaterniond(R_earth_enu(lat, lon).transpose() * R_earth_world * T_world_camera.linear());
  pose.R_enu_camera.normalize();
  return pose;
}

nlohmann::json json_of(const GeoPose& pose) {
  const Eigen::Quaterniond& q = pose.R_enu_camera;
  return {{"position", {{"lat", pose.latitude_deg}, {"lon", pose.longitude_deg}, {"h", pose.height_m}}},
          {"quaternion", {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}}}};
}

}  // namespace roomradar
