// table_tops.hpp: computes the fraction of table tops that is well known to a running scan.
#pragma once
#include <optional>
#include <vector>

#include "app/scan/live/anchors.hpp"
#include "app/scan/live/exploration_grid.hpp"
#include "app/scan/live/knowledge_grid.hpp"
#include "app/scan/live/live_model.hpp"

namespace roomradar {

/// Returns the fraction, by area, of the level surfaces between 0.25 and 1.4 m above the floor that is
/// Knowledge::kWell. Gaps of up to 0.4 m in such a surface count as part of the surface if no ray reached
/// them and no object stands on them. Returns nullopt below 0.1 m2 of such surfaces, or if no floor was seen.
/// @param T_level_world  rotates the up direction to +z
/// @param grid_level     the exploration grid, in the levelled world frame
std::optional<double> table_tops_known(const std::vector<LiveModelPart>& parts,
                                       const AnchorPoses& T_world_anchor,
                                       const Eigen::Isometry3d& T_level_world, const KnowledgeGrid& knowledge,
                                       const ExplorationGrid& grid_level);

}  // namespace roomradar
