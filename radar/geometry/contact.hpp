// contact.hpp: first contact of a moving object, with its distance between guaranteed bounds.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <string_view>

namespace roomradar {

enum class ContactStatus {
  kInvalidInput,  ///< direction zero or not finite, distance not finite or <= 0, object empty, or a pose not
                  ///< finite
  kNoAnswer,      ///< the renderer failed (out of memory, context lost); nothing is known
  kNoTarget,      ///< no contact found within the distance
  kContact,       ///< contact after contact_distance_m >= 0
  kOverlap,  ///< a surface facing against the motion is already inside the object; contact_distance_m < 0
};

/// Kind of a surface that can be touched.
enum class SurfaceKind {
  kNothing,
  kStatic,           ///< the prescanned room
  kDynamic,          ///< dynamic foreground: things that moved since the prescan
  kObject,           ///< another virtual object
  kUnknownFrontier,  ///< boundary between observed free space and unobserved space
  kInferredBack,     ///< assumed back and sides of a dynamic object
};
constexpr std::size_t kSurfaceKinds = 6;

/// Returns true for surfaces that were never observed. They block from their outside only, so an object that
/// is inside when they appear, or is placed behind them, can leave.
constexpr bool is_one_sided(SurfaceKind touched) {
  return touched == SurfaceKind::kUnknownFrontier || touched == SurfaceKind::kInferredBack;
}

/// Returns the name used in reports.
constexpr std::string_view to_string(SurfaceKind touched) {
  switch (touched) {
    case SurfaceKind::kNothing:
      break;
    case SurfaceKind::kStatic:
      return "seen static";
    case SurfaceKind::kDynamic:
      return "seen dynamic";
    case SurfaceKind::kObject:
      return "virtual object";
    case SurfaceKind::kUnknownFrontier:
      return "unknown frontier";
    case SurfaceKind::kInferredBack:
      return "inferred back";
  }
  return "nothing";
}

struct [[nodiscard]] Contact {
  ContactStatus status = ContactStatus::kInvalidInput;  // unset means failed
  /// Distance along the direction to contact, m; set for kContact and kOverlap only. Negative for an overlap:
  /// minus the distance back along the direction until the object is clear of surfaces that face against the
  /// motion.
  double contact_distance_m = 0.0;
  /// Bounds of the true distance to contact, m. kNoTarget: lower_m is certainly free, at most the queried
  /// distance, and upper_m is infinite. kOverlap: both are contact_distance_m; if the overlap is too deep to
  /// be measured (see CyberRadar), lower_m is -infinity.
  double lower_m = 0.0;
  double upper_m = std::numeric_limits<double>::infinity();
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();  ///< contact point on the scene's surface
  /// Unit normal of the scene's triangle, turned to face the object.
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();
  SurfaceKind touched = SurfaceKind::kNothing;
  double pixel_m = 0.0;  ///< side of a radar pixel: sample spacing across the direction

  /// Returns true for kContact and kOverlap.
  explicit operator bool() const {
    return status == ContactStatus::kContact || status == ContactStatus::kOverlap;
  }
};

}  // namespace roomradar
