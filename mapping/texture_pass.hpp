// texture_pass.hpp: the stage of a prescan that bakes the texture of its surface.
#pragma once
#include <memory>

#include "mapping/map/map_texture.hpp"
#include "mapping/prescan_passes.hpp"
#include "mapping/texture/surface_texture.hpp"

namespace roomradar {

/// Reads at most 160 frames of pass.fused again, chosen by choose_views(), and bakes a texture of the mesh
/// from their colours. Their pictures take at most 80 MB, unless a single one is larger.
/// Returns null, and reads nothing, if the memory would exceed config.max_memory_bytes. Returns null if
/// pass.fused is empty, or if no frame has colour and `earlier` is empty.
///
/// Surface that these frames do not show keeps the colours of `earlier` textures. Stages timed: read (per
/// frame), texture (per frame, then the whole).
/// @param mesh        surface of the map, in the world frame of `trajectory`
/// @param trajectory  poses of the frames, with their stamps
/// @throws Error if the source cannot be rewound
std::shared_ptr<const SurfaceTexture> run_texture_pass(PrescanWork& work,
                                                       const std::vector<TimedPose>& trajectory,
                                                       const FusionPass& pass, const EarlierTextures& earlier,
                                                       const Mesh& mesh);

}  // namespace roomradar
