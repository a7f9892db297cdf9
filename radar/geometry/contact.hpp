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
  kContact,       ///< contact after travel_m >= 0
  kOverlap,       ///< a surface facing against the motion is already inside the object; travel_m < 0
};

/// Kind of a surface that can be touched.
enum class Touched {
  kNothing,
  kStatic,           ///< the prescanned room
  kDynamic,          ///< dynamic foreground: things that moved since the prescan
  kObject,           ///< another virtual object
  kUnknownFrontier,  ///< boundary between observed free space and unobserved space
  kInferredBack,     ///< assumed back and sides of a dynamic object
};
constexpr std::size_t kTouchedKinds = 6;

/// Returns true for surfaces that were never observed. They block from their outside only, so an object that
/// is inside when they appear, or is placed behind them, can leave.
constexpr bool is_one_sided(Touched touched) {
  return touched == Touched::kUnknownFrontier || touched == Touched::kInferredBack;
}

/// Returns the name used in reports.
constexpr std::string_view to_string(Touched touched) {
  switch (touched) {
    case Touched::kNothing:
      break;
    case Touched::kStatic:
      return "seen static";
    case Touched::kDynamic:
      return "seen dynamic";
    case Touched::kObject:
      return "virtual object";
    case Touched::kUnknownFrontier:
      return "unknown frontier";
    case Touched::kInferredBack:
      return "inferred back";
  }
  return "nothing";
}

struct [[nodiscard]] Contact {
  ContactStatus status = ContactStatus::kInvalidInput;  // unset means failed
  /// Distance along the direction to contact, m; set for kContact and kOverlap only. Negative for an overlap:
  /// minus the distance back along the direction until the object is clear of surfaces that face against the
  /// motion.
  double travel_m = 0.0;
  /// Bounds of the true distance to contact, m. kNoTarget: lower_m is certainly free, at most the queried
  /// distance, and upper_m is infinite. kOverlap: both are travel_m; if the overlap is too deep to be
  /// measured (see CyberRadar), lower_m is -infinity.
  double lower_m = 0.0;
  double upper_m = std::numeric_limits<double>::infinity();
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();  ///< contact point on the scene's surface
  /// Unit normal of the scene's triangle, turned to face the object.
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();
  Touched touched = Touched::kNothing;
  double pixel_m = 0.0;  ///< side of a radar pixel: sample spacing across the direction

  /// Returns true for kContact and kOverlap.
  explicit operator bool() const {
    return status == ContactStatus::kContact || status == ContactStatus::kOverlap;
  }
};

}  // namespace roomradar
