// map_merge.hpp: merges two maps of one room.
#pragma once
#include <Eigen/Geometry>

#include "mapping/map/map_folder.hpp"
#include "mapping/map/registration.hpp"
#include "mapping/surface/surface_extraction.hpp"

namespace roomradar {

/// Adds map `from` to map `into`: adds log-odds, and averages signed distances and colours by weight. The
/// log-odds added to a voxel of `into` are those of `from` at the voxel's centre. The averaged distance is
/// interpolated from the samples of `from` around that centre, or extrapolated at the border of the samples.
/// The result is exact if the grids coincide. If `into` is coarser than `from`, parts of thin surfaces are
/// lost. Throws Error if a part of `from` is outside the octree of `into`.
void add_map(const StaticMap& from, const Eigen::Isometry3d& T_into_from, StaticMap& into);

/// Appends another session's keyframes, poses, source name, frame counts (read and fused) and kStoppedSetting
/// to a map. The session's poses must be in the map's world frame. The session's timestamps are shifted to
/// begin at least 1/30 s after the map's last one. Octree, mesh and look-alikes are unchanged.
void append_session(SavedMap& map, const SavedMap& session);

/// Estimates T_a_b between the world frames of two maps. Registers b to a, and tests b's surface against a's
/// surface and free space; see register_to(). If almost no surface of b is in space known to a, registers a
/// to b and tests a's surface instead. Overlap and agreement are then those of a's surface. Returns
/// kNoOverlap if this fails, too.
Registration register_maps(const SavedMap& a, const SavedMap& b, const RegistrationConfig& config = {});

/// Merges two maps in a's world frame, at the finer of their resolutions, and re-extracts the surface with
/// a's settings. Throws Error if the octree at this resolution cannot cover both maps, or if the resolutions
/// differ by more than a factor of four.
SavedMap merge_maps(SavedMap a, const SavedMap& b, const Eigen::Isometry3d& T_a_b);

}  // namespace roomradar
