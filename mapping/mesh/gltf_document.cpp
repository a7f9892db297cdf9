// gltf_document.cpp: the container of .glb, URIs, buffer views and EXT_meshopt_compression. Source: glTF 2.0
// specification, 3.6 and 4, and the extension's.
#include "mapping/mesh/gltf_document.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>
#include <utility>

#include "mapping/mesh/assimp_import.hpp"
#include "mapping/mesh/model_folder.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

constexpr std::uintmax_t kMaxPartBytes = 512U << 20U;
constexpr std::uint64_t kMaxMemoryBytes = std::uint64_t{1} << 30U;
constexpr const char* kMeshopt = "EXT_meshopt_compression";

constexpr auto kKnownExtensions = std::to_array<std::string_view>({
    // Drawn.
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_transform",
    // Not drawn, and named.
    "EXT_texture_avif",
    "KHR_animation_pointer",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_materials_volume_scatter",
    "KHR_texture_basisu",
    "MSFT_texture_dds",
    // Nothing to draw: lights and other data.
    "EXT_lights_ies",
    "EXT_lights_image_based",
    "KHR_lights_punctual",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_xmp",
    "KHR_xmp_json_ld",
});

/// Returns a text with words of the file for a message: without control characters.
std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 32 || c == 127; }, '?');
  return text;
}

/// Returns a name from the file for a message: without control characters, and not too long.
std::string shown(const std::string& name) {
  constexpr std::size_t kMost = 100;
  return printable(name.size() > kMost ? name.substr(0, kMost) + "..." : name);
}

/// Returns "A, B and 3 more".
std::string listed(const std::set<std::string>& names) {
  constexpr std::size_t kMost = 5;
  std::string list;
  std::size_t count = 0;
  for (const std::string& name : names)
    if (++count <= kMost) list += (list.empty() ? "" : ", ") + shown(name);
  return count > kMost ? list + " and " + std::to_string(count - kMost) + " more" : list;
}

std::string percent_decoded(std::string_view uri) {
  const auto digit = [&](std::size_t at) -> int {
    const char c = at < uri.size() ? uri[at] : ' ';
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
  };
  std::string plain;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && digit(i + 1) >= 0 && digit(i + 2) >= 0) {
      plain += static_cast<char>(16 * digit(i + 1) + digit(i + 2));
      i += 2;
    } else {
      plain += uri[i];
    }
  }
  return plain;
}

/// Returns the bytes; nullopt if a character is none of base64's.
std::optional<std::string> base64_decoded(std::string_view text) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  static const std::array<std::int8_t, 256> kValues = [&] {
    std::array<std::int8_t, 256> values{};
    values.fill(-1);
    for (std::size_t i = 0; i < kDigits.size(); ++i)
      values[static_cast<unsigned char>(kDigits[i])] = static_cast<std::int8_t>(i);
    return values;
  }();
  while (text.ends_with('=')) text.remove_suffix(1);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t held = 0;
  int bits = 0;
  for (const char c : text) {
    const int value = kValues[static_cast<unsigned char>(c)];
    if (value < 0) return std::nullopt;
    held = held << 6U | static_cast<std::uint32_t>(value);
    if ((bits += 6) < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(held >> static_cast<unsigned>(bits) & 0xffU);
  }
  return bytes;
}

bool has_scheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  return colon != std::string_view::npos && colon > 0 && uri.find_first_of("/\\?#") > colon;
}

/// Returns true if the name is absolute or has a component "..".
bool leads_away(std::string_view name) {
  if (name.starts_with('/') || name.starts_with('\\')) return true;
  for (std::size_t from = 0; from <= name.size();) {
    const std::size_t to = std::min(name.find_first_of("/\\", from), name.size());
    if (name.substr(from, to - from) == "..") return true;
    from = to + 1;
  }
  return false;
}

/// Returns the bytes that a URI names. Throws Error with the rest of a sentence about it, such as "is
/// missing".
std::string bytes_of_uri(const std::filesystem::path& model, const std::string& uri) {
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos) throw Error("is a data URI without data");
    const std::string_view head = std::string_view(uri).substr(0, comma);
    if (!head.ends_with(";base64")) return percent_decoded(std::string_view(uri).substr(comma + 1));
    std::optional<std::string> bytes = base64_decoded(std::string_view(uri).substr(comma + 1));
    // Some writers encode the characters "+", "/" and "=" once more.
    if (!bytes) bytes = base64_decoded(percent_decoded(std::string_view(uri).substr(comma + 1)));
    if (!bytes) throw Error("is a data URI that is not base64");
    return std::move(*bytes);
  }
  if (has_scheme(uri)) throw Error("is an address and is not read: only files in the model's folder are");
  const std::string decoded = percent_decoded(uri);
  if (leads_away(decoded)) throw Error("leads out of the model's folder and is not read");
  std::string with_slashes = decoded;
  std::replace(with_slashes.begin(), with_slashes.end(), '\\', '/');
  NamedFile found;
  for (const std::string& name : {with_slashes, uri, decoded}) {
    found = file_in_folder_of(model, name);
    if (found.fault.empty()) return read_bytes(found.path, "a part of a model", kMaxPartBytes);
  }
  throw Error(file_in_folder_of(model, decoded).fault);
}

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

}  // namespace

bool is_known_gltf_extension(std::string_view name) {
  return std::find(kKnownExtensions.begin(), kKnownExtensions.end(), name) != kKnownExtensions.end();
}

GltfObject::GltfObject(const std::filesystem::path& file, const nlohmann::json& json, std::string where)
    : file_(&file), json_(&json), where_(std::move(where)) {
  if (!json.is_object()) fail("is not an object");
}

void GltfObject::fail(const std::string& fault) const {
  fail_for_file(*file_,
                "its " + (where_.empty() ? "JSON" : where_) + " " + printable(fault) + "; is it damaged?");
}

const nlohmann::json* GltfObject::list(const char* key) const {
  const auto found = json_->find(key);
  if (found == json_->end()) return nullptr;
  if (!found->is_array()) fail("has no list \"" + std::string(key) + "\"");
  return &*found;
}

std::size_t GltfObject::size_of(const char* key) const {
  const nlohmann::json* const found = list(key);
  return found == nullptr ? 0 : found->size();
}

GltfObject GltfObject::element(const char* key, std::size_t index) const {
  const nlohmann::json* const found = list(key);
  if (found == nullptr || index >= found->size())
    fail("names " + std::string(key) + " " + std::to_string(index) + ", which is not there");
  std::string noun(key);
  noun.resize(noun.size() - (noun == "meshes" ? 2 : 1));
  return {*file_, (*found)[index],
          (where_.empty() ? "" : where_ + ", ") + noun + " " + std::to_string(index)};
}

std::optional<GltfObject> GltfObject::object(const char* key) const {
  const auto found = json_->find(key);
  if (found == json_->end()) return std::nullopt;
  return GltfObject(*file_, *found, where_.empty() ? key : where_ + ", " + key);
}

std::optional<GltfObject> GltfObject::extension(const char* name) const {
  const std::optional<GltfObject> extensions = object("extensions");
  return extensions ? extensions->object(name) : std::nullopt;
}

std::vector<std::string> GltfObject::keys() const {
  std::vector<std::string> keys;
  for (const auto& [key, value] : json_->items()) keys.push_back(key);
  return keys;
}

namespace {

/// Returns a number without a fraction, from 0 to 2^53; some writers write it with a point.
std::optional<std::uint64_t> whole_of(const nlohmann::json& value) {
  constexpr double kMost = 9007199254740992.0;
  if (value.is_number_unsigned()) {
    const auto number = value.get<std::uint64_t>();
    return number <= static_cast<std::uint64_t>(kMost) ? std::optional(number) : std::nullopt;
  }
  if (!value.is_number_float()) return std::nullopt;
  const auto number = value.get<double>();
  if (!(number >= 0.0 && number <= kMost) || number != std::floor(number)) return std::nullopt;
  return static_cast<std::uint64_t>(number);
}

}  // namespace

std::uint64_t GltfObject::whole(const char* key, std::optional<std::uint64_t> fallback) const {
  const auto found = json_->find(key);
  const std::optional<std::uint64_t> value = found == json_->end() ? fallback : whole_of(*found);
  if (!value) fail("has no whole number \"" + std::string(key) + "\"");
  return *value;
}

double GltfObject::number(const char* key, double fallback) const {
  const auto found = json_->find(key);
  if (found == json_->end()) return fallback;
  if (!found->is_number()) fail("has no number \"" + std::string(key) + "\"");
  return found->get<double>();
}

bool GltfObject::truth(const char* key, bool fallback) const {
  const auto found = json_->find(key);
  if (found == json_->end()) return fallback;
  if (!found->is_boolean()) fail("has neither true nor false for \"" + std::string(key) + "\"");
  return found->get<bool>();
}

std::string GltfObject::text(const char* key, const std::string& fallback) const {
  const auto found = json_->find(key);
  if (found == json_->end()) return fallback;
  if (!found->is_string()) fail("has no text \"" + std::string(key) + "\"");
  return found->get<std::string>();
}

std::optional<std::size_t> GltfObject::index(const char* key) const {
  return has(key) ? std::optional<std::size_t>(whole(key)) : std::nullopt;
}

std::vector<double> GltfObject::numbers(const char* key, std::optional<std::size_t> count) const {
  std::vector<double> numbers;
  const nlohmann::json* const found = list(key);
  if (found == nullptr) return numbers;
  for (const nlohmann::json& value : *found) {
    if (!value.is_number()) fail("has something other than numbers in \"" + std::string(key) + "\"");
    numbers.push_back(value.get<double>());
  }
  if (count && numbers.size() != *count)
    fail("has " + std::to_string(numbers.size()) + " numbers in \"" + key + "\", not " +
         std::to_string(*count));
  return numbers;
}

std::vector<std::size_t> GltfObject::indices(const char* key) const {
  std::vector<std::size_t> indices;
  const nlohmann::json* const found = list(key);
  if (found == nullptr) return indices;
  for (const nlohmann::json& value : *found) {
    const std::optional<std::uint64_t> whole = whole_of(value);
    if (!whole) fail("has something other than whole numbers in \"" + std::string(key) + "\"");
    indices.push_back(*whole);
  }
  return indices;
}

std::vector<std::string> GltfObject::texts(const char* key) const {
  std::vector<std::string> texts;
  const nlohmann::json* const found = list(key);
  if (found == nullptr) return texts;
  for (const nlohmann::json& value : *found) {
    if (!value.is_string()) fail("has something other than names in \"" + std::string(key) + "\"");
    texts.push_back(value.get<std::string>());
  }
  return texts;
}

GltfDocument::GltfDocument(const std::filesystem::path& path) : path_(path) {
  read();
  require_readable();
}

void GltfDocument::fail(const std::string& fault) const { fail_for_file(path_, fault); }

void GltfDocument::read() {
  constexpr std::size_t kHead = 12, kChunkHead = 8;
  constexpr std::uint32_t kJson = 0x4e4f534a, kBinary = 0x004e4942;
  file_ = read_bytes(path_, "a model", kMaxPartBytes);
  std::string text;
  if (!file_.starts_with("glTF")) {
    text.swap(file_);
  } else {
    if (file_.size() < kHead + kChunkHead) fail("is cut short");
    const std::uint32_t version = word_at(file_, 4);
    if (version != 2)
      fail("is glTF " + std::to_string(version) + ".0; convert it to glTF 2.0, for example with Blender");
    if (word_at(file_, 8) > file_.size())
      fail("is cut short: it declares " + std::to_string(word_at(file_, 8)) + " bytes, but has " +
           std::to_string(file_.size()));
    const std::string_view whole = std::string_view(file_).substr(0, word_at(file_, 8));
    bool has_text = false;
    for (std::size_t at = kHead; at + kChunkHead <= whole.size();) {
      const std::uint32_t size = word_at(whole, at), kind = word_at(whole, at + 4);
      at += kChunkHead;
      if (size > whole.size() - at) fail("is cut short within a chunk");
      if (kind == kJson && !has_text) text = whole.substr(at, size), has_text = true;
      if (kind == kBinary && !has_binary_) binary_ = whole.substr(at, size), has_binary_ = true;
      at += size;
    }
    if (!has_text) fail("has no JSON chunk; is it damaged?");
  }
  json_ = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (json_.is_discarded()) fail("is neither .glb nor the JSON of a .gltf; is it damaged?");
}

void GltfDocument::require_readable() const {
  const std::optional<GltfObject> asset = root().object("asset");
  if (!asset) fail("has no \"asset\", so it is not glTF 2.0");
  for (const char* key : {"version", "minVersion"}) {
    const std::string version = asset->text(key, "2.0");
    if (version != "2.0" && !(version.starts_with("2.") && std::string_view(key) == "version"))
      fail("is glTF " + shown(version) + "; convert it to glTF 2.0, for example with Blender");
  }
  const std::set<std::string> unknown = unknown_of("extensionsRequired");
  if (!unknown.empty())
    fail("requires the glTF extension " + listed(unknown) +
         ", which is not supported; export the model without this extension");
}

GltfObject GltfDocument::element(const char* list, std::size_t index) const {
  return root().element(list, index);
}

std::set<std::string> GltfDocument::unknown_of(const char* list) const {
  std::set<std::string> unknown;
  for (const std::string& extension : root().texts(list))
    if (!is_known_gltf_extension(extension)) unknown.insert(extension);
  return unknown;
}

std::string GltfDocument::unknown_extensions() const { return listed(unknown_of("extensionsUsed")); }

void GltfDocument::require_memory(std::uint64_t bytes) {
  memory_bytes_ += std::min(bytes, kMaxMemoryBytes + 1);
  if (memory_bytes_ > kMaxMemoryBytes)
    fail("declares data of more than " + std::to_string(kMaxMemoryBytes >> 20U) + " MB; simplify it first");
}

std::string_view GltfDocument::buffer(std::size_t index) {
  const auto known = buffers_.find(index);
  const GltfObject of = element("buffers", index);
  const std::uint64_t size = of.whole("byteLength");
  const bool is_chunk = index == 0 && has_binary_ && !of.has("uri");
  std::string_view bytes = binary_;
  if (!is_chunk) {
    if (known == buffers_.end()) {
      if (!of.has("uri")) of.fail("has no bytes");
      const std::string uri = of.text("uri");
      try {
        buffers_[index] = bytes_of_uri(path_, uri);
      } catch (const Error& fault) {
        fail("its buffer " + (uri.starts_with("data:") ? std::to_string(index) : shown(uri)) + " " +
             fault.what());
      }
      require_memory(buffers_[index].size());
    }
    bytes = buffers_[index];
  }
  if (bytes.size() < size)
    of.fail("is cut short: it declares " + std::to_string(size) + " bytes, but has " +
            std::to_string(bytes.size()));
  return bytes.substr(0, size);
}

/// Returns the bytes of a buffer from "byteOffset" on.
std::string_view GltfDocument::range(const GltfObject& of, std::uint64_t size_bytes) {
  const std::string_view bytes = buffer(of.whole("buffer"));
  const std::uint64_t from = of.whole("byteOffset", 0);
  if (from > bytes.size() || size_bytes > bytes.size() - from)
    of.fail("reaches beyond the end of its buffer");
  return bytes.substr(from, size_bytes);
}

std::string_view GltfDocument::view(std::size_t index) {
  const GltfObject of = element("bufferViews", index);
  const std::optional<GltfObject> packed = of.extension(kMeshopt);
  if (!packed) return range(of, of.whole("byteLength"));
  const auto known = decompressed_.find(index);
  if (known != decompressed_.end()) return known->second;
  return decompressed_[index] = decompress(*packed);
}

std::string GltfDocument::decompress(const GltfObject& packed) {
  const std::string_view source = range(packed, packed.whole("byteLength"));
  const std::uint64_t count = packed.whole("count"), stride = packed.whole("byteStride");
  const std::string mode = packed.text("mode"), filter = packed.text("filter", "NONE");
  const bool is_attributes = mode == "ATTRIBUTES";
  if (!is_attributes && mode != "TRIANGLES" && mode != "INDICES")
    packed.fail("has the unknown mode \"" + shown(mode) + "\"");
  if (is_attributes ? stride == 0 || stride % 4 != 0 || stride > 256 : stride != 2 && stride != 4)
    packed.fail("has a byteStride of " + std::to_string(stride));
  if (count > kMaxMemoryBytes / stride) fail("declares data of more than 1024 MB; simplify it first");
  require_memory(count * stride);
  std::string bytes(count * stride, '\0');
  const auto* const from = reinterpret_cast<const unsigned char*>(source.data());
  int fault = 0;
  if (is_attributes)
    fault = meshopt_decodeVertexBuffer(bytes.data(), count, stride, from, source.size());
  else if (mode == "TRIANGLES")
    fault = count % 3 == 0 ? meshopt_decodeIndexBuffer(bytes.data(), count, stride, from, source.size()) : 1;
  else
    fault = meshopt_decodeIndexSequence(bytes.data(), count, stride, from, source.size());
  if (fault != 0) packed.fail("cannot be decompressed");
  if (filter == "NONE") return bytes;
  if (filter == "OCTAHEDRAL" && is_attributes && (stride == 4 || stride == 8))
    meshopt_decodeFilterOct(bytes.data(), count, stride);
  else if (filter == "QUATERNION" && is_attributes && stride == 8)
    meshopt_decodeFilterQuat(bytes.data(), count, stride);
  else if (filter == "EXPONENTIAL" && is_attributes)
    meshopt_decodeFilterExp(bytes.data(), count, stride);
  else
    packed.fail("has the unknown filter \"" + shown(filter) + "\", or one that does not fit its mode");
  return bytes;
}

std::string GltfDocument::image(std::size_t index) {
  const GltfObject of = element("images", index);
  if (of.has("bufferView")) return std::string(view(of.whole("bufferView")));
  if (!of.has("uri")) throw Error("has no bytes");
  return bytes_of_uri(path_, of.text("uri"));
}

}  // namespace roomradar
