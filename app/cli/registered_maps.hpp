// registered_maps.hpp: registers two maps of one room, prints the result and adds it to the report.
#pragma once
#include <string>
#include <vector>

#include "app/cli/report.hpp"
#include "mapping/map/map_diff.hpp"
#include "mapping/map/map_merge.hpp"

namespace roomradar {

/// Registers map b to map a (register_maps()), prints the result and adds it to the report. Throws Error if
/// the registration is not reliable.
/// @param name_a, name_b names of the maps in messages
Registration require_registered(const SavedMap& a, const SavedMap& b, const std::string& name_a,
                                const std::string& name_b, Report& report);

/// Differences between two maps.
struct MapChanges {
  /// Transforms points from b's to a's world frame.
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  std::vector<Change> changes;  ///< largest first
};

/// Returns the objects that appeared in map b or vanished since map a. Registers the maps first, unless they
/// are known to have the same world frame (share_world()). Throws Error as require_registered() does.
MapChanges changes_between(const SavedMap& a, const SavedMap& b, const std::string& name_a,
                           const std::string& name_b, Report& report);

}  // namespace roomradar
