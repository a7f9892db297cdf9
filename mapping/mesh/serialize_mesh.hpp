// serialize_mesh.hpp: binary serialization of meshes.
#pragma once
#include "mapping/types/mesh.hpp"
#include "mapping/types/serialize.hpp"

namespace roomradar {

/// Reads or writes a mesh. Reading checks sizes only; triangles may have indices past the last vertex.
template <typename Archive>
void serialize(Archive& archive, Ref<Archive, Mesh> mesh) {
  archive(mesh.origin);
  serialize_items(archive, mesh.normals);
  serialize_items(archive, mesh.vertices);
  serialize_items(archive, mesh.colours);
  serialize_items(archive, mesh.triangles);
}

}  // namespace roomradar
