// surface_look.hpp: colour of any surface point: textures and light worked out once, then looked up.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "app/sim/room/room.hpp"

namespace roomradar {

/// Textures with mip levels, and the light of the room's lamps (shadows and ambient occlusion by rays and
/// distances in the room) on a coarse grid, for every face of every solid that can be seen from inside the
/// room.
class SurfaceLook {
 public:
  /// The room's own solids.
  /// @param texel_m  finest texture detail; what is finer than a pixel is wasted
  SurfaceLook(const Room& room, double texel_m);
  /// Solids that move through the room: textures alone; their light is worked out for every pixel.
  SurfaceLook(const Room& room, std::span<const Solid> solids, std::span<const Material> materials,
              double texel_m);

  /// Colour of a surface point, in the frame of solid `index`.
  /// @param footprint_m     width that one pixel covers on the surface, which selects the mip level
  /// @param T_world_solid   where the solid is now (used for those that move)
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
    std::vector<Level> levels;  ///< each half of the one before; empty: the face cannot be seen
    int light_columns = 0, light_rows = 0;
    /// Factor on the colour at the nodes of a grid that spans the face; empty: moves.
    std::vector<float> light;
  };
  static constexpr int kFaces = 7;  ///< +x, -x, +y, -y, +z, -z, and a cylinder's side

  void add_solid(const Solid& solid, const Material& material, double texel_m, bool lit);
  void light_face(const Solid& solid, int face_index, Face& face) const;
  [[nodiscard]] float light_at(const Eigen::Vector3d& p_world, const Eigen::Vector3d& normal_world,
                               bool shadows) const;

  const Room& room_;
  std::vector<Solid> solids_;
  std::vector<Face> faces_;  ///< kFaces a solid
};

}  // namespace roomradar
