// gltf_document.hpp: the JSON of a glTF 2.0 file, and the bytes of its buffers and images.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace roomradar {

/// Returns true for a glTF extension that is drawn, that does not change what is drawn, or that is named
/// where it is used.
bool is_known_gltf_extension(std::string_view name);

/// A JSON object of a glTF file, such as an accessor. Each function throws Error naming the file, the object
/// and the key if the value is of another kind.
class GltfObject {
 public:
  /// @param where  name of the object in messages, such as "accessor 3"; empty for the whole file
  GltfObject(const std::filesystem::path& file, const nlohmann::json& json, std::string where);

  [[nodiscard]] bool has(const char* key) const { return json_->contains(key); }
  /// Returns the number of elements of a list; 0 if there is none.
  [[nodiscard]] std::size_t size_of(const char* key) const;
  [[nodiscard]] GltfObject element(const char* key, std::size_t index) const;
  [[nodiscard]] std::optional<GltfObject> object(const char* key) const;
  [[nodiscard]] std::optional<GltfObject> extension(const char* name) const;
  [[nodiscard]] std::vector<std::string> keys() const;

  /// Return the value; the fallback if there is none; throw Error if there is neither.
  [[nodiscard]] std::uint64_t whole(const char* key, std::optional<std::uint64_t> fallback = {}) const;
  [[nodiscard]] double number(const char* key, double fallback) const;
  [[nodiscard]] bool truth(const char* key, bool fallback) const;
  [[nodiscard]] std::string text(const char* key, const std::string& fallback = {}) const;
  /// Returns the number of another element of the file.
  [[nodiscard]] std::optional<std::size_t> index(const char* key) const;
  /// Returns a list of numbers; empty if there is none. Throws Error if there are not `count` of them.
  [[nodiscard]] std::vector<double> numbers(const char* key, std::optional<std::size_t> count = {}) const;
  [[nodiscard]] std::vector<std::size_t> indices(const char* key) const;
  [[nodiscard]] std::vector<std::string> texts(const char* key) const;

  [[nodiscard]] const std::string& where() const { return where_; }
  /// Throws Error with the message "FILE: its WHERE fault; is it damaged?".
  [[noreturn]] void fail(const std::string& fault) const;

 private:
  const std::filesystem::path* file_;
  const nlohmann::json* json_;
  std::string where_;

  [[nodiscard]] const nlohmann::json* list(const char* key) const;
};

/// A .gltf or .glb file, whose buffers are read and decompressed when they are first used. Call it within
/// run_sandboxed(): the decoders are third-party code.
///
/// Buffers and images are read from the file itself, data URIs and files in the model's folder. URIs with a
/// scheme (http:, file:), an absolute path or ".." are refused.
class GltfDocument {
 public:
  /// Throws Error if the file is not glTF 2.0 or requires an extension that is unknown.
  explicit GltfDocument(const std::filesystem::path& path);
  GltfDocument(const GltfDocument&) = delete;
  GltfDocument& operator=(const GltfDocument&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] GltfObject root() const { return {path_, json_, ""}; }
  [[nodiscard]] std::size_t count(const char* list) const { return root().size_of(list); }
  /// Returns an element of one of the file's lists, such as "meshes". Throws Error if it is not there.
  [[nodiscard]] GltfObject element(const char* list, std::size_t index) const;
  /// Returns the names of unknown extensions that are used, though not required; empty if there are none.
  [[nodiscard]] std::string unknown_extensions() const;

  /// Returns the bytes of a buffer view, decompressed if EXT_meshopt_compression holds them.
  std::string_view view(std::size_t index);
  /// Returns the bytes of an image file. Throws Error without the model's name, such as "is missing".
  std::string image(std::size_t index);

  /// Throws Error if all that was announced by calls of this function needs more than 1 GiB.
  void require_memory(std::uint64_t bytes);
  /// Throws Error with the message "FILE: fault".
  [[noreturn]] void fail(const std::string& fault) const;

 private:
  std::filesystem::path path_;
  std::string file_;         // .glb only
  std::string_view binary_;  // chunk of a .glb, in file_
  bool has_binary_ = false;
  nlohmann::json json_;
  std::map<std::size_t, std::string> buffers_, decompressed_;  // as far as they were used
  std::uint64_t memory_bytes_ = 0;

  void read();
  void require_readable() const;
  [[nodiscard]] std::set<std::string> unknown_of(const char* list) const;
  std::string_view buffer(std::size_t index);
  std::string_view range(const GltfObject& of, std::uint64_t size_bytes);
  std::string decompress(const GltfObject& packed);
};

}  // namespace roomradar
