// contact.hpp: first contact of a moving object with the scene, and guaranteed bounds of the distance to
// contact.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <string_view>

namespace roomradar {

enum class ContactStatus {
  kInvalidInput,  ///< the query or the scene is invalid; see CyberRadar::query()
  kNoAnswer,      ///< the renderer failed (out of memory, context lost); nothing is known
  kNoTarget,      ///< no contact within the queried distance
  kContact,       ///< contact after contact_distance_m >= 0
  /// The object already overlaps a surface that faces against the motion. contact_distance_m < 0.
  kOverlap,
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

/// Returns true for the kinds of surfaces that are assumed, not observed. One-sided surfaces block motion
/// from their outside only, so an object that such a surface comes to enclose can leave.
constexpr bool is_one_sided(SurfaceKind touched) {
  return touched == SurfaceKind::kUnknownFrontier || touched == SurfaceKind::kInferredBack;
}

/// Returns the surface kind's name in reports.
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
  ContactStatus status = ContactStatus::kInvalidInput;  // unset: failed
  /// Distance to contact along the direction, m. Valid for kContact and kOverlap only. Negative for kOverlap:
  /// if the object is moved back by -contact_distance_m along the direction, it clears the surfaces that face
  /// against the motion.
  double contact_distance_m = 0.0;
  /// Lower bound of the true distance to contact, m. kNoTarget: distance that is certainly free, at most the
  /// queried distance. kOverlap: contact_distance_m, or -infinity if the overlap is too deep to be measured
  /// (see CyberRadar).
  double lower_m = 0.0;
  /// Upper bound of the true distance to contact, m. Infinite for kNoTarget; contact_distance_m for kOverlap.
  double upper_m = std::numeric_limits<double>::infinity();
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();  ///< contact point on the scene's surface, m
  /// Unit normal of the scene's triangle, negated if necessary so that it faces the object.
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();
  SurfaceKind touched = SurfaceKind::kNothing;
  /// Side length of a pixel of the query's images, perpendicular to the direction, m.
  double pixel_m = 0.0;

  /// Returns true for kContact and kOverlap.
  explicit operator bool() const {
    return status == ContactStatus::kContact || status == ContactStatus::kOverlap;
  }
};

}  // namespace roomradar
