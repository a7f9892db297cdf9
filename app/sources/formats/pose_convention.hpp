// pose_convention.hpp: conventions in which programs write camera poses, and conversion to T_world_camera.
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <string_view>

namespace roomradar {

/// How stated poses differ from the convention of the recording's format. All false and 1: not at all.
struct PoseConvention {
  bool is_inverse = false;  ///< poses are world to camera instead of camera to world
  bool is_opengl = false;   ///< the camera's axes are OpenGL's: x right, y up, z backwards
  bool is_wxyz = false;     ///< quaternions are w x y z instead of x y z w
  double unit_m = 1.0;      ///< length of a unit of the translations: 1, 0.01 or 0.001
  int later_by = 0;         ///< the pose of frame i is that of frame i + later_by
  friend bool operator==(const PoseConvention&, const PoseConvention&) = default;
};

/// Returns T_world_camera (camera: x right, y down, z forward) of a stated pose. `later_by` has no effect.
Eigen::Isometry3d converted(const Eigen::Isometry3d& stated, const PoseConvention& convention);

/// Parses "stated", or a comma-separated list of: inverse, opengl, wxyz, mm, cm. Returns nullopt for other
/// text.
std::optional<PoseConvention> parse_pose_convention(std::string_view text);
/// Returns the text that parse_pose_convention() reads; "stated" for the default. Omits later_by.
std::string to_string(const PoseConvention& convention);
/// Describes the convention in words: "world to camera, with OpenGL's axes".
std::string describe(const PoseConvention& convention);

}  // namespace roomradar
