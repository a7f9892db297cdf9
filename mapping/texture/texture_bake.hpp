// texture_bake.hpp: bakes a texture of a mesh from pictures of the room.
#pragma once
#include <memory>
#include <span>

#include "mapping/texture/earlier_texture.hpp"
#include "mapping/texture/surface_texture.hpp"
#include "mapping/texture/texture_view.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

struct TextureConfig {
  /// Max side of the atlas, a multiple of 16. GPUs of the last ten years support 4096.
  int max_side_px = 4096;
  double min_texel_m = 0.001;  ///< > 0
  int jpeg_quality = 88;       ///< 1..100
};

/// Divides the mesh into charts and gives each texel the colour of the views that show it best, i.e. from
/// near, from the front, sharp, and away from the picture's border. A texel's side is 80 % of the best
/// picture's pixel on the surface, but at least min_texel_m.
///
/// Detail comes from the best view, or from views that are almost as good. The colour without detail is the
/// mean of all good views, so no seam shows where the best view changes. Views whose colour is far from the
/// median of three or more views are left out: they show a moved object or a reflection. Texels that no view
/// shows get the colours of earlier textures of the room, else the mesh's. The result does not depend on the
/// number of threads.
///
/// Time: about 1 s per million texels on one processor. Memory: about 10 bytes per texel besides the views.
/// @param mesh   with normals and colours
/// @param views  with gains from even_exposure()
/// @return an empty texture (no corners) if there are neither views nor earlier textures, or too many charts
///         for an atlas
/// Source: Waechter, Moehrle, Goesele, Let there be color!, ECCV 2014 (choice of views); Burt, Adelson, A
/// multiresolution spline with application to image mosaics, ACM TOG 1983 (two bands).
SurfaceTexture bake_texture(const Mesh& mesh, std::span<const TextureView> views,
                            std::span<const std::unique_ptr<const EarlierTexture>> earlier = {},
                            const TextureConfig& config = {});

}  // namespace roomradar
