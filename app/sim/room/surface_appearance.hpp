// surface_appearance.hpp: colour of surface points from precomputed textures and lighting.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "app/sim/room/room.hpp"

namespace roomradar {

/// Textures with mip levels, and lighting on a coarse grid, for every face of every solid that is visible
/// inside the room. Lighting consists of the lamps' shadows, by ray casting, and ambient occlusion, by
/// distances to the room.
class SurfaceAppearance {
 public:
  /// For the room's own solids.
  /// @param texel_m  finest texture detail; detail below pixel size is wasted
  SurfaceAppearance(const Room& room, double texel_m);
  /// For solids that move through the room: only textures are precomputed; lighting is computed per pixel.
  SurfaceAppearance(const Room& room, std::span<const Solid> solids, std::span<const Material> materials,
                    double texel_m);

  /// Returns the colour of a surface point given in the frame of solid `index`.
  /// @param footprint_m     width of one pixel on the surface, which selects the mip level
  /// @param T_world_solid   current pose of the solid (used for moving solids)
  [[nodiscard]] Rgb shade(std::size_t index, const Eigen::Vector3d& p_solid,
                          const Eigen::Vector3d& normal_solid, double footprint_m,
                          const Eigen::Isometry3d& T_world_solid) const;

 private:
  struct Level {
    int width = 0;
    int height = 0;
    std::vector<Rgb> texels;
  };
  struct Face {
    float width_m = 0.0F, height_m = 0.0F;
    float texel_m = 0.0F;
    std::vector<Level> levels;  ///< each half the size of the previous one; empty: the face is hidden
    int light_columns = 0, light_rows = 0;
    /// Factors on the colour at the nodes of a grid over the face; empty for moving solids.
    std::vector<float> light;
  };
  static constexpr int kFaces = 7;  ///< +x, -x, +y, -y, +z, -z, and a cylinder's side

  void add_solid(const Solid& solid, const Material& material, double texel_m, bool lit);
  void light_face(const Solid& solid, int face_index, Face& face) const;
  [[nodiscard]] float light_at(const Eigen::Vector3d& p_world, const Eigen::Vector3d& normal_world,
                               bool shadows) const;

  const Room& room_;
  std::vector<Solid> solids_;
  std::vector<Face> faces_;  ///< kFaces per solid
};

}  // namespace roomradar
