// gltf_accessor.hpp: the numbers of a glTF accessor: any component type, normalised, interleaved, sparse.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/mesh/gltf_document.hpp"

namespace roomradar {

/// Numbers as floats, `width` per element.
struct GltfNumbers {
  std::size_t width = 0;
  std::vector<float> values;

  [[nodiscard]] std::size_t size() const { return width == 0 ? 0 : values.size() / width; }
  [[nodiscard]] const float* at(std::size_t element) const { return values.data() + element * width; }
};

/// Component types of glTF, by their numbers in files.
enum class GltfComponent : std::uint32_t {
  kInt8 = 5120,
  kUint8 = 5121,
  kInt16 = 5122,
  kUint16 = 5123,
  kUint32 = 5125,
  kFloat = 5126,
};

/// Type of an accessor's elements.
struct GltfLayout {
  std::size_t count = 0;
  std::size_t width = 0;  ///< numbers per element: 1 to 4, or 16
  GltfComponent component = GltfComponent::kFloat;
  bool is_normalised = false;  ///< integers stand for 0..1, or -1..1 if signed
};

/// Returns the type of an accessor. Throws Error naming the file if it is unknown, or if there are more than
/// 3 kMaxMeshTriangles elements.
GltfLayout gltf_layout(const GltfDocument& document, std::size_t accessor);

/// Returns the number that an integer of a normalised accessor stands for. Source: glTF 2.0, 3.6.2.2.
float normalised_value(float integer, GltfComponent component);

/// Reads an accessor. Elements without bytes are zero. Throws Error naming the file if the accessor reaches
/// beyond its buffer view.
GltfNumbers gltf_numbers(GltfDocument& document, std::size_t accessor);
/// Reads an accessor of unsigned integers, such as indices and joints, `width` per element.
std::vector<std::uint32_t> gltf_wholes(GltfDocument& document, std::size_t accessor, std::size_t width);

}  // namespace roomradar
