// sheet_vertex.hpp: the vertex of a surface sheet in a cell. Private to dual_marching_cubes.
#pragma once
#include <Eigen/Core>
#include <array>

#include "mapping/surface/cell_sheets.hpp"
#include "mapping/surface/tsdf_bricks.hpp"

namespace roomradar {

/// The eight samples of a dual cell. A mirrored corner of the voxels' grid has the sample of its coarse cell.
struct CellCorners {
  std::array<const TsdfSample*, 8> samples;
  /// Positions of the samples in the cell, 0..1. Coarse samples may be outside.
  std::array<Eigen::Vector3f, 8> positions;
};

struct SheetVertex {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< in the cell, 0..1
  Rgb colour{128, 128, 128};                           ///< grey if no sample has a colour
};

/// Returns the position of a corner in a cell: coordinates of 0 or 1.
Eigen::Vector3f corner_position(unsigned corner);

/// Returns the weighted mean of a sheet's zero crossings on the edges of a cell, with their mean colour. A
/// crossing beside an extrapolated sample has a weight of 0.05 instead of 1.
SheetVertex place_vertex(const CellCorners& corners, const Sheets& sheets, int sheet);

/// Returns the unit gradient of the trilinear distance at a position in the cell (0..1); zero if the
/// distances cancel.
Eigen::Vector3f normal_at(const std::array<const TsdfSample*, 8>& corners, const Eigen::Vector3f& position);

}  // namespace roomradar
