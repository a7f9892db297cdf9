// up_axis.hpp: the up axis of a model, and its rotation to +z.
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <string_view>

#include "mapping/types/mesh.hpp"

namespace roomradar {

enum class UpAxis { kX, kY, kZ, kMinusX, kMinusY, kMinusZ };

/// Names of the axes, by UpAxis.
inline constexpr std::array<std::string_view, 6> kUpAxisNames = {"x", "y", "z", "-x", "-y", "-z"};
inline constexpr std::string_view kUpAxisWords = "x, y, z, -x, -y or -z";

/// Returns one of the words "x", "y", "z", "-x", "-y" and "-z".
std::string_view to_string(UpAxis up);
/// Returns the axis of such a word, or nullopt for any other word.
std::optional<UpAxis> up_axis_of(std::string_view word);

/// Rotates the mesh so that axis `up` points to +z. Only exchanges and negates coordinates, so the result is
/// exact.
void stand_up(Mesh& mesh, UpAxis up);

}  // namespace roomradar
