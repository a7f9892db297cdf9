// registration.hpp: registers map b to map a of the same room, or a new scan b to a map a.
#pragma once
#include <Eigen/Geometry>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/octree/static_map.hpp"

namespace roomradar {

struct RegistrationConfig {
  int views = 60;            ///< max number of keyframes of b, evenly spaced, that are matched with a
  int candidates = 3;        ///< number of keyframes of a that are compared with each keyframe of b
  int min_inliers = 20;      ///< min number of features that agree on the relative pose of two keyframes
  int min_agreeing = 3;      ///< min number of keyframes of b that agree on T_a_b
  int hypotheses = 4;  ///< max number of transforms, found by keyframes, that are tested against a's surface
  double min_overlap = 0.1;  ///< min fraction of b's surface that is in space known to a
  /// Min fraction of b's surface in space known to a that is on a's surface, not in a's free space. The
  /// default tolerates moved objects, but rejects another room with the same picture on its wall.
  double min_agreement = 0.75;
  Eigen::Vector3d up_b = Eigen::Vector3d::UnitZ();  ///< unit direction in b's world frame; a's is +z
  std::size_t points = 12'000;  ///< number of points that register_maps() samples on a surface
};

enum class RegistrationStatus {
  kRegistered,
  kNoFeatures,     ///< a or b has no keyframes with colour
  kNotRecognised,  ///< too few keyframes of b are recognised in a, or they disagree
  kNoOverlap,      ///< almost no surface of b is in space known to a
  kContradicted,   ///< too much of b's surface would be in a's free space
};

struct [[nodiscard]] Registration {
  RegistrationStatus status = RegistrationStatus::kNotRecognised;
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();  ///< valid only if the status is kRegistered
  /// Inverse of T_a_b, set by register_maps(): equal, to the bit, to the T_a_b of register_maps(b, a).
  Eigen::Isometry3d T_b_a = Eigen::Isometry3d::Identity();
  int agreeing_views = 0;   ///< number of keyframes of b whose match in a agrees with T_a_b
  double overlap = 0.0;     ///< fraction of b's surface that is in space known to a
  double agreement = 0.0;   ///< fraction of that surface that is on a's surface, not in a's free space
  double residual_m = 0.0;  ///< median distance to a's surface, over b's points on it, m
  explicit operator bool() const { return status == RegistrationStatus::kRegistered; }
};
/// Returns the end of a sentence for the user with the result or the reason for failure. A result includes
/// the number of agreeing keyframes, overlap and agreement. A reason includes the value that was too low,
/// except for kNoFeatures.
std::string describe(const Registration& registration);

/// Computes T_a_b. Each keyframe of b that matches a keyframe of a votes for a transform, and the transforms
/// on which most keyframes agree are tried. All matching keyframes may show furniture that was moved, so the
/// room's shape proposes further transforms (correlative matching of the surfaces) if min_agreeing keyframes
/// agree on one; these count if the keyframes' patches look alike there. Each transform is refined by
/// aligning b's surface with a's signed distances. Directions that the surfaces do not constrain stay as
/// proposed. The result is the keyframes' transform that agrees best with a's surface and free space, or one
/// by shape that agrees 10 % better. Deterministic.
///
/// @param surface_b  points sampled uniformly on b's surface (sample_surface()), in b's world frame
Registration register_to(const StaticMap& octree_a, const KeyframeDatabase& database_a,
                         const KeyframeDatabase& database_b, std::span<const Eigen::Vector3d> surface_b,
                         const RegistrationConfig& config = {});

/// Refines an approximate T_a_b by aligning b's surface with a's, and verifies the result like
/// verify_registration(). Returns the approximate transform if that agrees better.
Registration refine_registration(const StaticMap& octree_a, std::span<const Eigen::Vector3d> surface_b,
                                 const Eigen::Isometry3d& T_a_b, const RegistrationConfig& config = {});

/// Verifies T_a_b by testing b's surface against a's surface and free space. Returns kRegistered, kNoOverlap
/// or kContradicted, and sets overlap and agreement.
Registration verify_registration(const StaticMap& octree_a, std::span<const Eigen::Vector3d> surface_b,
                                 const Eigen::Isometry3d& T_a_b, const RegistrationConfig& config = {});

}  // namespace roomradar
