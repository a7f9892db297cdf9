// texture_scene.hpp: a wall of known colours, its mesh, and frames that see it.
#pragma once
#include <cmath>
#include <vector>

#include "mapping/texture/surface_texture.hpp"
#include "mapping/texture/texture_view.hpp"
#include "mapping/types/codecs/jpeg.hpp"
#include "mapping/types/mesh.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/painted_frame.hpp"

namespace roomradar::test {

inline constexpr Intrinsics kTextureCamera{320, 240, 290.0, 290.0, 159.5, 119.5};

/// Square of the plane x = 2 around y = z = 0, seen from the origin, in `cells` x `cells` squares of two
/// triangles; grey.
inline Mesh wall_mesh(float size_m = 1.2F, std::uint32_t cells = 4) {
  Mesh mesh;
  mesh.origin = {2.0, 0.0, 0.0};
  for (std::uint32_t i = 0; i <= cells; ++i)
    for (std::uint32_t k = 0; k <= cells; ++k) {
      const auto at = [&](std::uint32_t n) {
        return size_m * (static_cast<float>(n) / static_cast<float>(cells) - 0.5F);
      };
      mesh.vertices.emplace_back(0.0F, at(i), at(k));
      mesh.normals.emplace_back(-1.0F, 0.0F, 0.0F);
      mesh.colours.push_back({128, 128, 128});
    }
  for (std::uint32_t i = 0; i < cells; ++i)
    for (std::uint32_t k = 0; k < cells; ++k) {
      const std::uint32_t a = i * (cells + 1) + k, b = a + cells + 1;
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
    }
  return mesh;
}

/// Smooth pattern of the wall, with waves of 20 and 13 cm.
inline double wall_grey(const Eigen::Vector3d& p_world) {
  return 120.0 + 50.0 * std::sin(p_world.y() * 31.4) + 40.0 * std::sin(p_world.z() * 48.3 + 0.5);
}

inline Scene wall_scene() { return plane(Eigen::Vector3d::UnitX(), 2.0); }

/// Frame of the scene, painted with wall_grey() times the gain.
inline Frame wall_frame(const Scene& scene, const Eigen::Isometry3d& T_world_camera, double gain = 1.0) {
  Frame frame = exact_frame(scene, kTextureCamera, T_world_camera);
  paint_with(wall_grey, frame, T_world_camera, gain);
  return frame;
}

/// Poses that look at the wall from different places.
inline std::vector<Eigen::Isometry3d> wall_poses() {
  return {looking_at({0.8, 0.0, 0.0}, {2.0, 0.0, 0.0}), looking_at({0.7, 0.5, 0.2}, {2.0, 0.1, 0.0}),
          looking_at({0.6, -0.5, -0.2}, {2.0, -0.1, 0.0}), looking_at({0.5, 0.1, 0.5}, {2.0, 0.0, 0.1})};
}

/// A red texture of 32 x 32 pixels that fits the mesh; every triangle shows half of it.
inline SurfaceTexture red_texture(const Mesh& mesh) {
  SurfaceTexture texture;
  texture.width_px = texture.height_px = 32;
  texture.atlas_jpeg = jpeg_of(ColourImage(32, 32, {200, 40, 40}), 90);
  texture.corners.assign(mesh.triangles.size(),
                         {AtlasPoint{0, 0}, AtlasPoint{65535, 0}, AtlasPoint{0, 65535}});
  texture.mesh_fingerprint = fingerprint(mesh);
  return texture;
}

}  // namespace roomradar::test
