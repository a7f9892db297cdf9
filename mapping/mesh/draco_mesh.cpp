// draco_mesh.cpp: calls Draco's decoder, and copies what it returns.
#include "mapping/mesh/draco_mesh.hpp"

#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>

#include <memory>
#include <string>

#include "mapping/mesh/assimp_import.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

template <typename Number>
void copy_values(const draco::PointAttribute& attribute, std::size_t vertices, DracoAttribute& to) {
  const std::size_t width = to.width;
  std::vector<Number> value(width);
  to.values.resize(vertices * width);
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto index = attribute.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(v)));
    if (index.value() >= attribute.size()) throw Error("names values that are not there");
    attribute.GetValue(index, value.data());
    for (std::size_t i = 0; i < width; ++i) to.values[v * width + i] = static_cast<double>(value[i]);
  }
}

DracoAttribute copied(const draco::PointAttribute& attribute, std::size_t vertices) {
  DracoAttribute to{attribute.unique_id(), static_cast<std::size_t>(attribute.num_components())};
  switch (attribute.data_type()) {
    case draco::DT_INT8:
      copy_values<std::int8_t>(attribute, vertices, to);
      break;
    case draco::DT_UINT8:
    case draco::DT_BOOL:
      copy_values<std::uint8_t>(attribute, vertices, to);
      break;
    case draco::DT_INT16:
      copy_values<std::int16_t>(attribute, vertices, to);
      break;
    case draco::DT_UINT16:
      copy_values<std::uint16_t>(attribute, vertices, to);
      break;
    case draco::DT_INT32:
      copy_values<std::int32_t>(attribute, vertices, to);
      break;
    case draco::DT_UINT32:
      copy_values<std::uint32_t>(attribute, vertices, to);
      break;
    case draco::DT_FLOAT32:
      to.is_float = true;
      copy_values<float>(attribute, vertices, to);
      break;
    default:
      throw Error("has an attribute of an unknown type");
  }
  return to;
}

}  // namespace

DracoMesh draco_mesh(std::string_view bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    throw Error("cannot be decompressed (" + decoded.status().error_msg_string().substr(0, 100) + ")");
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
  if (mesh->num_faces() > kMaxMeshTriangles || mesh->num_points() > 3 * kMaxMeshTriangles)
    throw Error("has " + std::to_string(mesh->num_faces()) + " triangles, more than " +
                std::to_string(kMaxMeshTriangles) + "; simplify it first");
  DracoMesh copy;
  copy.vertices = mesh->num_points();
  copy.corners.reserve(std::size_t{3} * mesh->num_faces());
  for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f)
    for (const draco::PointIndex& corner : mesh->face(f)) copy.corners.push_back(corner.value());
  for (std::int32_t i = 0; i < mesh->num_attributes(); ++i)
    copy.attributes.push_back(copied(*mesh->attribute(i), copy.vertices));
  return copy;
}

}  // namespace roomradar
