// map_merge.hpp: merges two maps of one room.
#pragma once
#include <Eigen/Geometry>

#include "mapping/map/map_folder.hpp"
#include "mapping/map/registration.hpp"
#include "mapping/surface/surface_extraction.hpp"

namespace roomradar {

/// Adds map `from` to map `into`: adds log-odds, and averages signed distances by weight. Each voxel of
/// `into` gets the log-odds of `from` at its centre, and the distance interpolated from the samples of `from`
/// around it. The result is exact if the grids coincide. If `into` is coarser than `from`, parts of thin
/// surfaces are lost. Throws Error if a part of `from` is outside the octree of `into`.
void add_map(const StaticMap& from, const Eigen::Isometry3d& T_into_from, StaticMap& into);

/// Appends another session's keyframes, poses and counts to a map. The session must be in the map's world.
/// The session's timestamps are shifted to follow the map's, unless they already do. Octree and mesh are
/// unchanged.
void append_session(SavedMap& map, const SavedMap& session);

/// Estimates T_a_b between two maps' worlds. b's surface must agree with a's surface and free space.
/// Conversely, a's surface must agree with b's, unless almost none of it is in space known to b.
Registration register_maps(const SavedMap& a, const SavedMap& b, const RegistrationConfig& config = {});

/// Merges two maps in a's world, at the finer of their resolutions, and re-extracts the surface with a's
/// settings. Throws Error if the octree at this resolution cannot cover both maps, or if the resolutions
/// differ by more than a factor of four.
SavedMap merge_maps(SavedMap a, const SavedMap& b, const Eigen::Isometry3d& T_a_b);

}  // namespace roomradar
