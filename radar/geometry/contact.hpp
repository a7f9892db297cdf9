// contact.hpp: what a moving object would touch first, and after how far, between bounds that hold.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <string_view>

namespace roomradar {

enum class ContactStatus {
  kInvalidInput,  ///< direction zero or not finite, distance not finite or <= 0, object empty, a pose not
                  ///< finite
  kNoAnswer,      ///< the renderer failed (out of memory, context lost): nothing is known
  kNoTarget,      ///< nothing found in the way within the distance
  kContact,       ///< touches after travel_m >= 0
  kOverlap,       ///< a surface that opposes the motion is inside the object already; travel_m < 0
};

/// Which kind of surface was touched.
enum class Touched {
  kNothing,
  kStatic,           ///< the prescanned room
  kDynamic,          ///< what moved since
  kObject,           ///< another virtual object
  kUnknownFrontier,  ///< where seen free space ends and unseen space begins
  kInferredBack,     ///< the back and the sides that a thing that moved is taken to have
};
constexpr std::size_t kTouchedKinds = 6;

/// Surfaces that nobody has seen are met from their outside only: they keep nothing in, so that what they
/// came about, or was put behind them, can leave.
constexpr bool is_one_sided(Touched touched) {
  return touched == Touched::kUnknownFrontier || touched == Touched::kInferredBack;
}

/// As reports call it.
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
  /// Along the direction until touch; negative: depth of the overlap, how far back along the direction the
  /// object is free again of what opposes the motion; kContact and kOverlap only.
  double travel_m = 0.0;
  /// The true way to contact is not shorter than lower_m and not longer than upper_m. Where nothing was found
  /// lower_m is what is free for certain, at most the distance asked for, and upper_m infinite. In an overlap
  /// both are travel_m; where that is too deep to be told (see CyberRadar) lower_m is minus infinity.
  double lower_m = 0.0;
  double upper_m = std::numeric_limits<double>::infinity();
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();  ///< on the scene's surface
  /// Unit, of the scene's triangle, turned to face the object.
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();
  Touched touched = Touched::kNothing;
  double pixel_m = 0.0;  ///< side of a radar pixel: how far apart the samples are across the direction

  /// Whether there is something to react to.
  explicit operator bool() const {
    return status == ContactStatus::kContact || status == ContactStatus::kOverlap;
  }
};

}  // namespace roomradar
