// tile_contact.hpp: the contact of a query, from the least gap of its tile.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "radar/batch/gl_query.hpp"
#include "radar/batch/least_gap.hpp"
#include "radar/batch/radar_volume.hpp"
#include "radar/batch/scene_mesh.hpp"
#include "radar/geometry/contact.hpp"

namespace roomradar {

/// A run of scene triangles that reaches a query's volume. Its triangles have keys from first_key on.
struct SceneRun {
  std::size_t scene_index = 0;
  std::uint32_t first_triangle = 0;
  std::uint32_t first_key = 0;
};

/// Returns the contact of a query that was drawn: status, bounds, point, normal and kind.
/// @param runs  the query's runs, by ascending first_key
Contact contact_of(const GlQuery& query, const RadarOutline& outline, const TileResult& result,
                   std::span<const SceneRun> runs, std::span<const SceneMesh> scene);

}  // namespace roomradar
