// earlier_texture.cpp: nearest triangle of the earlier mesh, and look-up in the earlier atlas.
#include "mapping/texture/earlier_texture.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "mapping/types/codecs/jpeg.hpp"

namespace roomradar {
namespace {

constexpr float kSameSurface_m = 0.02F;

/// Weights of the triangle's vertices at the point of the triangle's plane next to p, moved into the
/// triangle.
Eigen::Vector3f weights_beside(const Eigen::Vector3f& p, const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                               const Eigen::Vector3f& c) {
  const Eigen::Vector3f ab = b - a, ac = c - a, n = ab.cross(ac);
  const float area2 = n.squaredNorm();
  if (!(area2 > 0.0F)) return {1.0F, 0.0F, 0.0F};
  const float of_b = (p - a).cross(ac).dot(n) / area2, of_c = ab.cross(p - a).dot(n) / area2;
  const Eigen::Vector3f weights = Eigen::Vector3f(1.0F - of_b - of_c, of_b, of_c).cwiseMax(0.0F);
  return weights / weights.sum();
}

}  // namespace

EarlierTexture::EarlierTexture(Mesh mesh, const SurfaceTexture& texture)
    : mesh_(std::move(mesh)),
      query_(mesh_, kSameSurface_m),
      atlas_(picture_of_jpeg(texture.atlas_jpeg, texture.width_px, texture.height_px, "an earlier texture")),
      corners_(texture.corners) {}

std::optional<EarlierTexture::Found> EarlierTexture::find(const Eigen::Vector3d& p_world,
                                                          const Eigen::Vector3f& normal) const {
  const Eigen::Vector3f p = (p_world - mesh_.origin).cast<float>();
  std::uint32_t guess = MeshDistanceQuery::kNoGuess;
  const std::optional<std::uint32_t> nearest = query_.nearest_facing(p, normal, guess);
  if (!nearest) return std::nullopt;
  const Triangle& t = mesh_.triangles[*nearest];
  const Eigen::Vector3f &a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]], &c = mesh_.vertices[t[2]];
  const Eigen::Vector3f weights = weights_beside(p, a, b, c);
  std::array<Eigen::Vector2f, 3> corners_px;
  const Eigen::Array2f size_px(static_cast<float>(atlas_.width), static_cast<float>(atlas_.height));
  Eigen::Vector2f at_px = Eigen::Vector2f::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const AtlasPoint& corner = corners_[*nearest][k];
    corners_px[k] = (Eigen::Array2f(corner[0], corner[1]) / 65535.0F * size_px).matrix();
    at_px += weights[static_cast<Eigen::Index>(k)] * corners_px[k];
  }
  const Eigen::Vector2f u = corners_px[1] - corners_px[0], v = corners_px[2] - corners_px[0];
  const float texels = std::abs(u.x() * v.y() - u.y() * v.x());
  const float area_m2 = (b - a).cross(c - a).norm();
  const Rgb& colour = atlas_.at(std::clamp(static_cast<int>(at_px.x()), 0, atlas_.width - 1),
                                std::clamp(static_cast<int>(at_px.y()), 0, atlas_.height - 1));
  return Found{{static_cast<float>(colour.r), static_cast<float>(colour.g), static_cast<float>(colour.b)},
               area_m2 > 0.0F ? std::sqrt(texels / area_m2) : 0.0F};
}

std::optional<EarlierTexture::Found> find_densest(std::span<const std::unique_ptr<const EarlierTexture>> all,
                                                  const Eigen::Vector3d& p_world,
                                                  const Eigen::Vector3f& normal) {
  std::optional<EarlierTexture::Found> densest;
  for (const auto& texture : all)
    if (const auto found = texture->find(p_world, normal);
        found && (!densest || found->texels_per_m > densest->texels_per_m))
      densest = found;
  return densest;
}

}  // namespace roomradar
