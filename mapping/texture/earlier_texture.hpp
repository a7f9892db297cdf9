// earlier_texture.hpp: colours of a texture that was baked for an earlier mesh of the same room.
#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mapping/mesh/mesh_distance.hpp"
#include "mapping/texture/surface_texture.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Looks up colours of an earlier surface by position and normal.
class EarlierTexture {
 public:
  /// @param mesh  mesh for which the texture was baked, in the world frame of the look-ups
  /// @throws Error if the texture's image cannot be decoded
  EarlierTexture(Mesh mesh, const SurfaceTexture& texture);
  EarlierTexture(const EarlierTexture&) = delete;
  EarlierTexture& operator=(const EarlierTexture&) = delete;

  /// Colour and density at the nearest surface that faces the same way and is at most 2 cm away.
  struct Found {
    Eigen::Array3f colour;      ///< 0..255
    float texels_per_m = 0.0F;  ///< of the earlier texture
  };
  /// @param p_world  m
  /// @param normal   unit
  [[nodiscard]] std::optional<Found> find(const Eigen::Vector3d& p_world,
                                          const Eigen::Vector3f& normal) const;

 private:
  Mesh mesh_;
  MeshDistanceQuery query_;
  ColourImage atlas_;
  std::vector<std::array<AtlasPoint, 3>> corners_;
};

/// Returns the result of find() with the most texels per metre, over all textures; nullopt if no texture has
/// a colour there.
std::optional<EarlierTexture::Found> find_densest(std::span<const std::unique_ptr<const EarlierTexture>> all,
                                                  const Eigen::Vector3d& p_world,
                                                  const Eigen::Vector3f& normal);

}  // namespace roomradar
