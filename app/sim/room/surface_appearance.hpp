// surface_appearance.hpp: colour of surface points from cached textures and lighting.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "app/sim/room/room.hpp"

namespace roomradar {

/// Textures with mip levels, and lighting on a coarse grid, for each face that is visible inside the room.
/// Lighting includes the lamps' shadows (by ray casting) and ambient occlusion (from distances to the room's
/// surface). The textures of a face and the lighting of a grid node are computed on first use, since a whole
/// room takes more than half a second.
class SurfaceAppearance {
 public:
  /// Shows the room's solids. The room must outlive this.
  /// @param texel_m  size of the finest texture detail. Should be at least a pixel's width on the surface
  SurfaceAppearance(const Room& room, double texel_m);
  /// Shows solids that move through the room. Lighting is computed per pixel.
  SurfaceAppearance(const Room& room, std::span<const Solid> solids, std::span<const Material> materials,
                    double texel_m);

  /// Returns the colour of a surface point of the solid with this index. One thread at a time.
  /// @param p_solid         the point in the solid's frame, m
  /// @param normal_solid    surface normal in the solid's frame
  /// @param footprint_m     width of one pixel on the surface, m; selects the mip level
  /// @param T_world_solid   current pose of the solid; used for moving solids
  [[nodiscard]] Rgb shade(std::size_t index, const Eigen::Vector3d& p_solid,
                          const Eigen::Vector3d& normal_solid, double footprint_m,
                          const Eigen::Isometry3d& T_world_solid);

 private:
  struct Level {
    int width = 0;
    int height = 0;
    std::vector<Rgb> texels;
  };
  struct Face {
    bool is_prepared = false;  ///< false: the members below are not filled
    float width_m = 0.0F, height_m = 0.0F;
    float texel_m = 0.0F;
    /// Mip levels, each half as wide and high as the previous one. Empty if the face is hidden.
    std::vector<Level> levels;
    int light_columns = 0, light_rows = 0;
    /// Brightness factors at the nodes of a grid over the face, row by row, negative where not computed yet.
    /// Empty for moving solids.
    std::vector<float> light;
  };
  /// Faces of a solid: +x, -x, +y, -y, +z, -z, and a cylinder's side.
  static constexpr int kFaces = 7;

  /// Makes the textures of a face, unless it is hidden.
  void prepare(std::size_t index, int face_index, Face& face) const;
  /// Returns the brightness factor at a node of a face's grid.
  float light_of(std::size_t index, int face_index, Face& face, int column, int row) const;
  /// @param part  index of the building's part whose lamps are used; -1: all lamps of the room are used
  [[nodiscard]] float light_at(const Eigen::Vector3d& p_world, const Eigen::Vector3d& normal_world,
                               bool shadows, int part) const;

  const Room& room_;
  double texel_m_;
  bool is_lit_;  ///< true: lighting is cached at grid nodes; false: computed per pixel
  std::vector<Solid> solids_;
  std::vector<Material> materials_;
  /// Faces, kFaces per solid.
  std::vector<Face> faces_;
};

}  // namespace roomradar
