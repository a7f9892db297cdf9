// up_axis.hpp: the axis of a model that points up, and turning it to +z.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "mapping/types/mesh.hpp"

namespace roomradar {

enum class UpAxis { kX, kY, kZ, kMinusX, kMinusY, kMinusZ };

inline constexpr std::string_view kUpAxisWords = "x, y, z, -x, -y or -z";

/// Returns "x" to "-z".
std::string_view to_string(UpAxis up);
/// Returns nullopt if the word names no axis.
std::optional<UpAxis> up_axis_of(std::string_view word);

/// Turns the mesh so that the axis points to +z. Exact: coordinates are exchanged and negated.
void stand_up(Mesh& mesh, UpAxis up);

}  // namespace roomradar
