// texture_bake.hpp: bakes a texture of a mesh from pictures of the room, and fills the gaps of its atlas.
#pragma once
#include <memory>
#include <span>

#include "mapping/texture/earlier_texture.hpp"
#include "mapping/texture/surface_texture.hpp"
#include "mapping/texture/texture_view.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

struct TextureConfig {
  /// Max side of the atlas, a multiple of 16. GPUs of the last ten years support 4096.
  int max_side_px = 4096;
  double min_texel_m = 0.001;  ///< > 0
  int jpeg_quality = 88;       ///< 1..100
};

/// Divides the mesh into charts and gives each texel the colour of the views that show it best, i.e. from
/// near, from the front, sharp, and away from the picture's border. A chart's texel size is 80 % of the best
/// view's pixel size on the surface, or that of an earlier texture if smaller. The texel size is at least
/// min_texel_m, and is enlarged if the atlas would exceed max_side_px.
///
/// Blends in two frequency bands: high frequencies come from the best views, low frequencies are a mean over
/// all good views. No seam thus shows where the best view changes. If three or more views show a texel, views
/// far from the median colour are outliers (a moved object, a reflection) and are left out. Texels that no
/// view shows get the colours of earlier textures of the room, else the mesh's. The result does not depend on
/// the number of threads.
///
/// Time: about 1 s per million texels on one processor. Memory: about 10 bytes per texel besides the views.
/// @param mesh   with normals and colours
/// @param views  with gains from even_exposure()
/// @return an empty texture (no corners) if the mesh has no triangles or normals, if there are neither views
///         nor earlier textures, or if there are too many charts for an atlas
/// Source: Waechter, Moehrle, Goesele, Let there be color!, ECCV 2014 (choice of views); Burt, Adelson, A
/// multiresolution spline with application to image mosaics, ACM TOG 1983 (two bands).
SurfaceTexture bake_texture(const Mesh& mesh, std::span<const TextureView> views,
                            std::span<const std::unique_ptr<const EarlierTexture>> earlier = {},
                            const TextureConfig& config = {});

/// Fills the gaps of an atlas, so that neither interpolation nor compression shows its seams. Gives pixels
/// without colour the mean of their nearest neighbours with colour: the picture is halved until all pixels
/// have a colour, and the gaps are filled on the way back. A picture without any colour becomes grey.
/// @param has_colour  255: the pixel has a colour; 0: the pixel is filled. Same size as the atlas
/// Source: Gortler et al., The Lumigraph, SIGGRAPH 1996 (push-pull).
void fill_gaps(ColourImage& atlas, const MaskImage& has_colour);

}  // namespace roomradar
