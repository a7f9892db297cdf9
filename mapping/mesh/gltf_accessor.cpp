// gltf_accessor.cpp: copies numbers out of buffer views, then replaces those of a sparse accessor. Source:
// glTF 2.0 specification, 3.6.2.
#include "mapping/mesh/gltf_accessor.hpp"

#include <algorithm>
#include <cstring>
#include <string>
#include <string_view>

#include "mapping/mesh/assimp_import.hpp"

namespace roomradar {
namespace {

constexpr std::size_t kMaxElements = 3 * kMaxMeshTriangles;

std::size_t bytes_of(GltfComponent component) {
  switch (component) {
    case GltfComponent::kInt8:
    case GltfComponent::kUint8:
      return 1;
    case GltfComponent::kInt16:
    case GltfComponent::kUint16:
      return 2;
    case GltfComponent::kUint32:
    case GltfComponent::kFloat:
      break;
  }
  return 4;
}

GltfComponent component_of(const GltfObject& of) {
  const std::uint64_t number = of.whole("componentType");
  const bool is_known = number >= 5120 && number <= 5126 && number != 5124;
  if (!is_known) of.fail("has the unknown componentType " + std::to_string(number));
  return static_cast<GltfComponent>(number);
}

std::size_t width_of(const GltfObject& of) {
  const std::string type = of.text("type");
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4") return 4;
  if (type == "MAT4") return 16;
  of.fail("has the type \"" + type.substr(0, 20) + "\"");
}

/// Rows of elements within a buffer view.
struct Rows {
  std::string_view bytes;
  std::size_t stride = 0;

  [[nodiscard]] const char* at(std::size_t element) const { return bytes.data() + element * stride; }
};

/// Returns `count` elements of `element_bytes` that begin at "byteOffset" of a view.
Rows rows_of(GltfDocument& document, const GltfObject& of, std::size_t count, std::size_t element_bytes,
             bool may_have_stride) {
  const std::size_t view = of.whole("bufferView");
  const std::string_view bytes = document.view(view);
  const std::uint64_t from = of.whole("byteOffset", 0);
  const GltfObject view_object = document.element("bufferViews", view);
  const std::uint64_t stride =
      may_have_stride ? view_object.whole("byteStride", element_bytes) : element_bytes;
  // A stride of 0 is none, for some writers.
  const std::uint64_t step = stride == 0 ? element_bytes : stride;
  if (step < element_bytes || step > 4096)
    view_object.fail("has a byteStride of " + std::to_string(step) + " for elements of " +
                     std::to_string(element_bytes) + " bytes");
  if (count > 0 && (from > bytes.size() || element_bytes > bytes.size() - from ||
                    (count - 1) > (bytes.size() - from - element_bytes) / step))
    of.fail("reaches beyond the end of its buffer view");
  return {count > 0 ? bytes.substr(from) : std::string_view{}, step};
}

template <typename Number>
Number value_at(const char* bytes) {
  Number value{};
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

float float_at(const char* bytes, GltfComponent component) {
  switch (component) {
    case GltfComponent::kInt8:
      return value_at<std::int8_t>(bytes);
    case GltfComponent::kUint8:
      return value_at<std::uint8_t>(bytes);
    case GltfComponent::kInt16:
      return value_at<std::int16_t>(bytes);
    case GltfComponent::kUint16:
      return value_at<std::uint16_t>(bytes);
    case GltfComponent::kUint32:
      return static_cast<float>(value_at<std::uint32_t>(bytes));
    case GltfComponent::kFloat:
      break;
  }
  return value_at<float>(bytes);
}

std::uint32_t whole_at(const char* bytes, GltfComponent component) {
  if (component == GltfComponent::kUint8) return value_at<std::uint8_t>(bytes);
  if (component == GltfComponent::kUint16) return value_at<std::uint16_t>(bytes);
  return value_at<std::uint32_t>(bytes);
}

bool is_unsigned(GltfComponent component) {
  return component == GltfComponent::kUint8 || component == GltfComponent::kUint16 ||
         component == GltfComponent::kUint32;
}

/// Calls write(element, bytes) for each element, then for each that a sparse accessor replaces.
template <typename Write>
void for_each_element(GltfDocument& document, std::size_t accessor, const GltfLayout& layout,
                      const Write& write) {
  const GltfObject of = document.element("accessors", accessor);
  const std::size_t element_bytes = layout.width * bytes_of(layout.component);
  if (of.has("bufferView")) {
    const Rows rows = rows_of(document, of, layout.count, element_bytes, true);
    for (std::size_t i = 0; i < layout.count; ++i) write(i, rows.at(i));
  }
  const std::optional<GltfObject> sparse = of.object("sparse");
  if (!sparse) return;
  const std::uint64_t replaced = sparse->whole("count");
  if (replaced > layout.count) sparse->fail("replaces more elements than there are");
  const std::optional<GltfObject> indices = sparse->object("indices"), values = sparse->object("values");
  if (!indices || !values) sparse->fail("has no indices or no values");
  const GltfComponent index_type = component_of(*indices);
  if (!is_unsigned(index_type)) indices->fail("has indices that are not unsigned");
  const Rows places = rows_of(document, *indices, replaced, bytes_of(index_type), false);
  const Rows rows = rows_of(document, *values, replaced, element_bytes, false);
  for (std::size_t i = 0; i < replaced; ++i) {
    const std::uint32_t place = whole_at(places.at(i), index_type);
    if (place >= layout.count) indices->fail("names an element that is not there");
    write(place, rows.at(i));
  }
}

}  // namespace

GltfLayout gltf_layout(const GltfDocument& document, std::size_t accessor) {
  const GltfObject of = document.element("accessors", accessor);
  const std::uint64_t count = of.whole("count");
  if (count > kMaxElements)
    document.fail("its " + of.where() + " has " + std::to_string(count) + " elements, more than " +
                  std::to_string(kMaxElements) + "; simplify it first");
  return {count, width_of(of), component_of(of), of.truth("normalized", false)};
}

float normalised_value(float integer, GltfComponent component) {
  switch (component) {
    case GltfComponent::kInt8:
      return std::max(integer / 127.0F, -1.0F);
    case GltfComponent::kUint8:
      return integer / 255.0F;
    case GltfComponent::kInt16:
      return std::max(integer / 32767.0F, -1.0F);
    case GltfComponent::kUint16:
      return integer / 65535.0F;
    case GltfComponent::kUint32:
      return integer / 4294967295.0F;
    case GltfComponent::kFloat:
      break;
  }
  return integer;
}

GltfNumbers gltf_numbers(GltfDocument& document, std::size_t accessor) {
  const GltfLayout layout = gltf_layout(document, accessor);
  document.require_memory(layout.count * layout.width * sizeof(float));
  GltfNumbers numbers{layout.width, std::vector<float>(layout.count * layout.width)};
  const std::size_t step = bytes_of(layout.component);
  for_each_element(document, accessor, layout, [&](std::size_t element, const char* bytes) {
    float* const to = numbers.values.data() + element * layout.width;
    for (std::size_t i = 0; i < layout.width; ++i) {
      const float value = float_at(bytes + i * step, layout.component);
      to[i] = layout.is_normalised ? normalised_value(value, layout.component) : value;
    }
  });
  return numbers;
}

std::vector<std::uint32_t> gltf_wholes(GltfDocument& document, std::size_t accessor, std::size_t width) {
  const GltfLayout layout = gltf_layout(document, accessor);
  const GltfObject of = document.element("accessors", accessor);
  if (layout.width != width || !is_unsigned(layout.component))
    of.fail("does not consist of " + std::to_string(width) + " unsigned integers per element");
  document.require_memory(layout.count * width * sizeof(std::uint32_t));
  std::vector<std::uint32_t> wholes(layout.count * width);
  const std::size_t step = bytes_of(layout.component);
  for_each_element(document, accessor, layout, [&](std::size_t element, const char* bytes) {
    for (std::size_t i = 0; i < width; ++i)
      wholes[element * width + i] = whole_at(bytes + i * step, layout.component);
  });
  return wholes;
}

}  // namespace roomradar
