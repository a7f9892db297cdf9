// registration.hpp: how two maps of one room, or a map and a new scan, stand to each other.
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
  int views = 60;            ///< of b that are looked for in a, spread over all
  int candidates = 3;        ///< views of a that each is compared with
  int min_inliers = 20;      ///< features that must agree on how two views stand to each other
  int min_agreeing = 3;      ///< views of b that must agree on how the maps stand to each other
  double min_overlap = 0.1;  ///< of b's surface, the part that must lie where a knows what is there
  /// Of that, the part that must lie on a's surface, and not in its free space. Things that were moved leave
  /// more; another room with the same picture on its wall leaves less.
  double min_agreement = 0.75;
  std::size_t points = 12'000;  ///< of b's surface that are looked at
};

enum class RegistrationStatus {
  kRegistered,
  kNoFeatures,     ///< one of the two has no views with colour to recognise
  kNotRecognised,  ///< too few views of b are found in a, or they do not agree
  kNoOverlap,      ///< views are recognised, but hardly any surface is known to both
  kContradicted,   ///< views are recognised, but too much of b's surface would hang in a's free space
};

struct [[nodiscard]] Registration {
  RegistrationStatus status = RegistrationStatus::kNotRecognised;
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();  ///< only if registered
  int agreeing_views = 0;                                   ///< of b, found in a with this T_a_b
  double overlap = 0.0;     ///< part of b's surface that lies where a knows what is there
  double agreement = 0.0;   ///< of that, the part on a's surface
  double residual_m = 0.0;  ///< median distance of that part to a's surface
  explicit operator bool() const { return status == RegistrationStatus::kRegistered; }
};
/// A sentence's end for the user: why it is not certain, with the figures.
std::string describe(const Registration& registration);

/// Finds T_a_b. Views of b vote: each that is recognised among a's says where b's world stands. The transform
/// that most agree on is refined by laying b's surface on a's signed distances (directions that these do not
/// fix stay as the views have them), and must then be borne out by what a knows. Deterministic.
///
/// @param surface_b  points on b's surface, in b's world, evenly spread (sample_surface, surface_of)
Registration register_to(const StaticMap& octree_a, const Places& places_a, const Places& places_b,
                         std::span<const Eigen::Vector3d> surface_b, const RegistrationConfig& config = {});

/// Whether b's surface is borne out by what a knows, if T_a_b holds: registered, kNoOverlap or kContradicted,
/// with the figures.
Registration judge_registration(const StaticMap& octree_a, std::span<const Eigen::Vector3d> surface_b,
                                const Eigen::Isometry3d& T_a_b, const RegistrationConfig& config = {});

/// So many points evenly spread over a mesh's area. Deterministic. Empty for a mesh without area.
std::vector<Eigen::Vector3d> sample_surface(const Mesh& mesh, std::size_t count);

/// About so many points of what the views of some places saw, up to 3 m away, in their world.
std::vector<Eigen::Vector3d> surface_of(const Places& places, std::size_t count);

/// Signed distance and its gradient at a point, from the eight samples round it, each the less the farther.
/// None where one of them is not known.
struct DistanceAt {
  double distance_m = 0.0;                             ///< as the samples have it: along the viewing rays
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< towards the free side
};
std::optional<DistanceAt> distance_at(const StaticMap& map, const Eigen::Vector3d& p_world);

}  // namespace roomradar
