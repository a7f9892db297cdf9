// tile_contact.hpp: converts a GlRadar query's least gap and touched triangle into a Contact.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "radar/batch/gl_query.hpp"
#include "radar/batch/gpu_scene_mesh.hpp"
#include "radar/batch/least_gap.hpp"
#include "radar/batch/radar_volume.hpp"
#include "radar/geometry/contact.hpp"

namespace roomradar {

/// A contiguous range of a scene mesh's triangles, in chunks whose bounding boxes intersect a query's volume.
/// Every triangle in a range has a key that is unique within the query. Triangle first_triangle + k of the
/// mesh has the key first_key + k.
struct SceneRun {
  /// Index into the scene of contact_of().
  std::size_t scene_index = 0;
  std::uint32_t first_triangle = 0;
  std::uint32_t first_key = 0;
};

/// Returns the contact (status, bounds, point, normal and kind) of a query that was drawn.
/// @param outline  bounding rectangle and pixel grid of the object, seen along its direction of motion
/// @param result   least gap over the query's pixels, its pixel, and the key of the triangle touched
/// @param runs     triangle ranges that intersect the query's volume, by ascending first_key
/// @param scene    meshes for which the query was drawn; SceneRun::scene_index is an index into it
Contact contact_of(const GlQuery& query, const RadarOutline& outline, const TileResult& result,
                   std::span<const SceneRun> runs, std::span<const GpuSceneMesh> scene);

}  // namespace roomradar
