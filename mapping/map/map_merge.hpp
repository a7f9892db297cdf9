// map_merge.hpp: two maps of one room become one.
#pragma once
#include <Eigen/Geometry>

#include "mapping/map/map_folder.hpp"
#include "mapping/map/registration.hpp"
#include "mapping/surface/surface_extraction.hpp"

namespace roomradar {

/// Adds all that `from` knows to `into`: log-odds are added, signed distances averaged by weight. Each voxel
/// of `into` takes what holds its centre, and its distance from the eight samples round it. Exact where the
/// grids coincide. `into` must not be coarser than `from`, else parts of a thin surface are passed over.
/// Throws Error if a part of `from` would lie past `into`'s reach.
void add_map(const StaticMap& from, const Eigen::Isometry3d& T_into_from, StaticMap& into);

/// Adds another session's views, poses and counts to a map, whose world they are in: its stamps go on after
/// the map's. The octree and the mesh are as they were.
void append_session(SavedMap& map, const SavedMap& session);

/// Where b's world stands in a's: b's surface must fit a and a's must fit b.
Registration register_maps(const SavedMap& a, const SavedMap& b, const RegistrationConfig& config = {});

/// Both in one, in a's world, with the finer resolution of the two; the surface is extracted anew, as
/// closely as a's. Throws Error if either lies past the reach of such cells, or has cells of more than
/// four times the other's.
SavedMap merge_maps(SavedMap a, const SavedMap& b, const Eigen::Isometry3d& T_a_b);

}  // namespace roomradar
