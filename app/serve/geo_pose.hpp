// geo_pose.hpp: a camera's pose on the earth, as OGC GeoPose.
#pragma once
#include <Eigen/Geometry>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace roomradar {

/// Position and heading of a map's world frame on the earth (WGS 84).
struct GeoAnchor {
  double latitude_deg = 0.0, longitude_deg = 0.0;  ///< position of the world's origin
  double height_m = 0.0;                           ///< height of the world's origin above the ellipsoid
  double heading_deg = 0.0;                        ///< direction of the world's +y axis, clockwise from north
};

/// Parses "LATITUDE,LONGITUDE,HEIGHT,HEADING". Throws Error naming the fault.
GeoAnchor parse_geo_anchor(const std::string& text);

struct GeoPose {
  double latitude_deg = 0.0, longitude_deg = 0.0, height_m = 0.0;
  /// Rotation from the camera (x right, y down, z forward) to east, north, up at the camera's position.
  Eigen::Quaterniond R_enu_camera = Eigen::Quaterniond::Identity();
};

/// Returns the pose of a camera in a map's world frame. The world's z axis must point up. Exact for any
/// distance from the anchor. Source: NIMA TR8350.2, World Geodetic System 1984 (ellipsoid).
GeoPose geo_pose_of(const GeoAnchor& anchor, const Eigen::Isometry3d& T_world_camera);

/// Returns the Basic-Quaternion form. Source: Open Geospatial Consortium, GeoPose 1.0, 21-056r11.
nlohmann::json json_of(const GeoPose& pose);

}  // namespace roomradar
