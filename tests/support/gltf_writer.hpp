// gltf_writer.hpp: writes small glTF files by hand, one feature at a time.
#pragma once
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace roomradar::test {

using Json = nlohmann::json;

/// Returns the bytes of numbers, converted to Number.
template <typename Number>
std::string bytes_as(const std::vector<double>& values) {
  std::string bytes;
  for (const double value : values) {
    const auto number = static_cast<Number>(value);
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  return bytes;
}

/// Returns the bytes of numbers in a component type of glTF.
inline std::string bytes_as(int component, const std::vector<double>& values) {
  switch (component) {
    case 5120:
      return bytes_as<std::int8_t>(values);
    case 5121:
      return bytes_as<std::uint8_t>(values);
    case 5122:
      return bytes_as<std::int16_t>(values);
    case 5123:
      return bytes_as<std::uint16_t>(values);
    case 5125:
      return bytes_as<std::uint32_t>(values);
    default:
      return bytes_as<float>(values);
  }
}

inline const char* type_of_width(std::size_t width) {
  switch (width) {
    case 1:
      return "SCALAR";
    case 2:
      return "VEC2";
    case 3:
      return "VEC3";
    case 4:
      return "VEC4";
    default:
      return "MAT4";
  }
}

/// A glTF file in the making: `root` is its JSON, `data` its only buffer.
struct GltfWriter {
  Json root = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
  std::string data{};

  /// Appends an element to a list of the file, and returns its number.
  std::size_t add(const char* list, const Json& element) {
    root[list].push_back(element);
    return root[list].size() - 1;
  }
  /// Appends bytes to the buffer; returns the number of their view.
  std::size_t view(const std::string& bytes, const Json& more = Json::object()) {
    data.resize((data.size() + 3) / 4 * 4, '\0');
    Json of = {{"buffer", 0}, {"byteOffset", data.size()}, {"byteLength", bytes.size()}};
    of.update(more);
    data += bytes;
    return add("bufferViews", of);
  }
  std::size_t accessor(const std::vector<double>& values, std::size_t width, int component = 5126,
                       const Json& more = Json::object()) {
    Json of = {{"bufferView", view(bytes_as(component, values))},
               {"componentType", component},
               {"count", values.size() / width},
               {"type", type_of_width(width)}};
    of.update(more);
    return add("accessors", of);
  }
  std::size_t normalised(const std::vector<double>& values, std::size_t width, int component) {
    return accessor(values, width, component, {{"normalized", true}});
  }
  /// Adds a texture of an image file's bytes, and a material of it.
  std::size_t material_of_image(const std::string& image, const char* mime = "image/png") {
    const std::size_t source = add("images", {{"bufferView", view(image)}, {"mimeType", mime}});
    const std::size_t texture = add("textures", {{"source", source}});
    return add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
  }
  /// Adds a mesh of one primitive, and node 0 with it if there is no node.
  std::size_t mesh(const Json& primitive) {
    const std::size_t mesh = add("meshes", {{"primitives", {primitive}}});
    if (!root.contains("nodes")) add("nodes", {{"mesh", mesh}});
    return mesh;
  }

  [[nodiscard]] std::string json_with(const Json& buffer) const {
    Json whole = root;
    if (!data.empty() && !whole.contains("buffers")) whole["buffers"] = {buffer};
    return whole.dump();
  }
  [[nodiscard]] std::string glb() const {
    std::string text = json_with({{"byteLength", data.size()}}), binary = data;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    std::string bytes = "glTF";
    const auto word = [&](std::size_t value) {
      const auto number = static_cast<std::uint32_t>(value);
      bytes.append(reinterpret_cast<const char*>(&number), 4);
    };
    word(2), word(12 + 8 + text.size() + (binary.empty() ? 0 : 8 + binary.size()));
    word(text.size()), bytes += "JSON" + text;
    if (!binary.empty()) word(binary.size()), bytes += std::string("BIN\0", 4) + binary;
    return bytes;
  }
  /// Returns a .gltf whose buffer has this URI.
  [[nodiscard]] std::string gltf(const std::string& uri) const {
    return json_with({{"byteLength", data.size()}, {"uri", uri}});
  }
};

inline std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t held = 0;
    for (std::size_t k = 0; k < 3; ++k)
      held = held << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kDigits[held >> (18U - 6U * k) & 63U] : '=';
  }
  return text;
}

}  // namespace roomradar::test
