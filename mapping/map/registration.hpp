// registration.hpp: registers two maps of one room, or a new scan to a map.
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

struct RegistrationConfig {
  int views = 60;            ///< max views of b that are searched for in a, evenly selected
  int candidates = 3;        ///< views of a that are compared with each of them
  int min_inliers = 20;      ///< min features that agree on two views' relative pose
  int min_agreeing = 3;      ///< min views of b that agree on T_a_b
  double min_overlap = 0.1;  ///< min fraction of b's surface in space that a knows
  /// Min fraction of this overlap that is on a's surface, not in its free space. Moved objects leave a larger
  /// fraction; another room with the same picture on its wall leaves a smaller one.
  double min_agreement = 0.75;
  std::size_t points = 12'000;  ///< number of points tested on b's surface
};

enum class RegistrationStatus {
  kRegistered,
  kNoFeatures,     ///< one of the two has no keyframes with colour
  kNotRecognised,  ///< too few views of b are found in a, or they disagree
  kNoOverlap,      ///< views match, but almost no surface is known to both
  kContradicted,   ///< views match, but too much of b's surface would be in a's free space
};

struct [[nodiscard]] Registration {
  RegistrationStatus status = RegistrationStatus::kNotRecognised;
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();  ///< valid only if registered
  int agreeing_views = 0;                                   ///< views of b that match a with this T_a_b
  double overlap = 0.0;                                     ///< fraction of b's surface in space that a knows
  double agreement = 0.0;   ///< fraction of this overlap that is on a's surface
  double residual_m = 0.0;  ///< median distance of that part to a's surface
  explicit operator bool() const { return status == RegistrationStatus::kRegistered; }
};
/// Returns the result, or the reason for failure, with its numbers, as the end of a sentence for the user.
std::string describe(const Registration& registration);

/// Computes T_a_b. Each view of b that matches a view of a votes for a transform. The transform that most
/// views agree on is refined by aligning b's surface with a's signed distances; unconstrained directions keep
/// the views' value. The result must then agree with a's surface and free space. Deterministic.
///
/// @param surface_b  points on b's surface, in b's world, evenly spread (sample_surface, surface_of)
Registration register_to(const StaticMap& octree_a, const KeyframeDatabase& database_a,
                         const KeyframeDatabase& database_b, std::span<const Eigen::Vector3d> surface_b,
                         const RegistrationConfig& config = {});

/// Verifies T_a_b by testing b's surface against a's surface and free space. Returns kRegistered, kNoOverlap
/// or kContradicted, with the numbers.
Registration verify_registration(const StaticMap& octree_a, std::span<const Eigen::Vector3d> surface_b,
                                 const Eigen::Isometry3d& T_a_b, const RegistrationConfig& config = {});

/// Returns `count` points evenly spread over a mesh's area. Deterministic. Empty for a mesh without area.
std::vector<Eigen::Vector3d> sample_surface(const Mesh& mesh, std::size_t count);

/// Returns about `count` points from the keyframes' depth, at most 3 m away, in the keyframes' world.
std::vector<Eigen::Vector3d> surface_of(const KeyframeDatabase& keyframe_database, std::size_t count);

/// Signed distance and its gradient at a point, interpolated trilinearly from the eight samples around it.
/// distance_at() returns nullopt if one of them is unknown.
struct DistanceAt {
  double distance_m = 0.0;                             ///< along the viewing rays, as in the samples
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< towards the free side
};
std::optional<DistanceAt> distance_at(const StaticMap& map, const Eigen::Vector3d& p_world);

}  // namespace roomradar
