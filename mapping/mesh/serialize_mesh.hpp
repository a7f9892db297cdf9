// serialize_mesh.hpp: binary serialization of meshes and of other large arrays.
#pragma once
#include <cstdint>
#include <type_traits>
#include <vector>

#include "mapping/types/mesh.hpp"
#include "mapping/types/serialize.hpp"

namespace roomradar {

/// Copies all items as one block, since copying a large mesh item by item would take seconds.
template <typename Archive, typename Item>
void serialize_items(Archive& archive, std::vector<Item>& items) {
  static_assert(std::is_standard_layout_v<Item>);
  std::uint64_t count = items.size();
  serialize(archive, count);
  if constexpr (Archive::kReads) {
    archive.require(count, sizeof(Item));
    items.resize(count);
  }
  archive.raw(items.data(), count * sizeof(Item));
}

/// Reads or writes a mesh. Reading checks sizes only; triangles may have indices past the last vertex.
template <typename Archive>
void serialize(Archive& archive, Mesh& mesh) {
  archive.raw(mesh.origin.data(), 3 * sizeof(double));
  serialize_items(archive, mesh.normals);
  serialize_items(archive, mesh.vertices);
  serialize_items(archive, mesh.colours);
  serialize_items(archive, mesh.triangles);
}

}  // namespace roomradar
