// up_axis.cpp: rotations by quarter turns.
#include "app/models/up_axis.hpp"

namespace roomradar {
namespace {

/// Returns the vector after the rotation that takes the axis to +z.
template <typename Vector>
Vector turned(const Vector& p, UpAxis up) {
  switch (up) {
    case UpAxis::kX:
      return {-p.z(), p.y(), p.x()};
    case UpAxis::kY:
      return {p.x(), -p.z(), p.y()};
    case UpAxis::kMinusX:
      return {p.z(), p.y(), -p.x()};
    case UpAxis::kMinusY:
      return {p.x(), p.z(), -p.y()};
    case UpAxis::kMinusZ:
      return {p.x(), -p.y(), -p.z()};
    case UpAxis::kZ:
      break;
  }
  return p;
}

}  // namespace

std::string_view to_string(UpAxis up) { return kUpAxisNames[static_cast<std::size_t>(up)]; }

std::optional<UpAxis> up_axis_of(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  for (std::size_t i = 0; i < kUpAxisNames.size(); ++i)
    if (word == kUpAxisNames[i]) return static_cast<UpAxis>(i);
  return std::nullopt;
}

void stand_up(Mesh& mesh, UpAxis up) {
  if (up == UpAxis::kZ) return;
  mesh.origin = turned(mesh.origin, up);
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex = turned(vertex, up);
  for (Eigen::Vector3f& normal : mesh.normals) normal = turned(normal, up);
}

}  // namespace roomradar
