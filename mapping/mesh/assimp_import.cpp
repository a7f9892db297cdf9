// assimp_import.cpp: checks the sizes that a file declares before assimp reads it, keeps assimp within the
// file's folder, and works around bugs of assimp.
#include "mapping/mesh/assimp_import.hpp"

#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include "mapping/mesh/model_folder.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr std::uintmax_t kMaxFileBytes = 512U << 20U;  // 2 million triangles as text take about 300 MB

// Checks the header's element counts: assimp loops up to them even if the file is far shorter.
void check_ply_counts(const std::filesystem::path& path, std::istream& file, std::uintmax_t bytes) {
  std::string start(64U << 10U, '\0');  // longer than any valid header
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  std::istringstream header(start);
  std::string line;
  while (std::getline(header, line) && line.rfind("end_header", 0) != 0) {
    std::istringstream words(line);
    std::string word, name;
    std::uint64_t count = 0;
    if (!(words >> word) || word != "element") continue;
    if (!(words >> name >> count))
      fail_for_file(path, "its header line \"" + line.substr(0, 80) + "\" has no count");
    if (name == "face" && count > kMaxMeshTriangles) fail_for_size(path, count);
    if (count > bytes)
      fail_for_file(
          path, "is cut short: it declares " + std::to_string(count) + " of \"" + name.substr(0, 40) + "\"");
  }
  if (!header) fail_for_file(path, "its header has no end; must be a .ply file");
}

bool has_empty_face(const aiScene& scene) {
  for (unsigned i = 0; i < scene.mNumMeshes; ++i)
    for (unsigned k = 0; k < scene.mMeshes[i]->mNumFaces; ++k)
      if (scene.mMeshes[i]->mFaces[k].mNumIndices == 0) return true;
  return false;
}

// assimp drops a newline at the start of a binary .ply's data, as if it belonged to a header ending in
// "\r\n". In one of 256 files the first number starts with that byte, and all data would be read one byte too
// early. Returns the bytes of such a file with an extra newline; empty for any other file. Source: assimp
// issue 5341.
std::string ply_with_newline_to_drop(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string header, line;
  bool is_binary = false;
  while (!line.starts_with("end_header")) {
    if (!std::getline(file, line) || line.ends_with('\r')) return {};
    is_binary = is_binary || line.starts_with("format binary");
    header += line + '\n';
  }
  if (!is_binary || file.peek() != '\n') return {};
  std::ostringstream rest;
  rest << file.rdbuf();
  return header + '\n' + rest.str();
}

// assimp counts a number without a digit before its point, such as ".5", as none, and leaves out lines that
// begin with blanks. Returns the text of such an .obj without them and with "0.5"; empty for any other file.
std::string obj_as_assimp_wants_it(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line, mended;
  bool is_mended = false;
  while (std::getline(file, line)) {
    const std::size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
    line.erase(0, begin);
    is_mended = is_mended || begin > 0;
    if (line.starts_with('v'))  // v, vt or vn
      for (std::size_t i = 1; i + 1 < line.size(); ++i) {
        const bool begins_number = line[i] == '.' && std::strchr(" \t+-", line[i - 1]) != nullptr &&
                                   std::isdigit(static_cast<unsigned char>(line[i + 1])) != 0;
        if (!begins_number) continue;
        line.insert(i++, 1, '0');
        is_mended = true;
      }
    mended.append(line).push_back('\n');
  }
  return is_mended ? mended : std::string();
}

/// Opens files of the model's folder only, and a text in place of the model if there is one.
class ModelFolder : public Assimp::DefaultIOSystem {
 public:
  ModelFolder(const std::filesystem::path& model, std::string text)
      : model_(std::filesystem::absolute(model)), path_(model.string()), text_(std::move(text)) {}
  bool Exists(const char* file) const override { return file == path_ || may_open(file); }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (file == path_ && !text_.empty())
      return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(text_.data()), text_.size());
    return file == path_ || may_open(file) ? DefaultIOSystem::Open(file, mode) : nullptr;
  }

 private:
  std::filesystem::path model_;
  std::string path_, text_;

  [[nodiscard]] bool may_open(const char* file) const {
    return file_in_folder_of(model_, std::filesystem::absolute(file)).fault.empty();
  }
};

/// Returns a file's text as assimp reads it right; empty if the file itself is.
std::string mended_text(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".ply") return ply_with_newline_to_drop(path);
  return extension == ".obj" ? obj_as_assimp_wants_it(path) : std::string();
}

}  // namespace

void fail_for_file(const std::filesystem::path& path, const std::string& fault) {
  throw Error(path.string() + ": " + fault);
}

void fail_for_size(const std::filesystem::path& path, std::uint64_t triangles) {
  fail_for_file(path, "has " + std::to_string(triangles) + " triangles, more than " +
                          std::to_string(kMaxMeshTriangles) + "; simplify it first");
}

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

void require_plausible_size(const std::filesystem::path& path) {
  std::error_code unreadable;
  if (!std::filesystem::exists(path, unreadable)) fail_for_file(path, "there is no such file");
  if (!std::filesystem::is_regular_file(path, unreadable)) fail_for_file(path, "is not a file");
  const std::uintmax_t bytes = std::filesystem::file_size(path, unreadable);
  if (unreadable) fail_for_file(path, "cannot be read: " + unreadable.message());
  if (bytes == 0) fail_for_file(path, "is empty; must be a mesh");
  std::ifstream file(path, std::ios::binary);
  if (!file) fail_for_file(path, "cannot be opened; do you have permission to read it?");
  if (lower_extension(path) == ".stl") {
    char header[84] = {};
    file.read(header, sizeof(header));
    std::uint32_t triangles = 0;
    std::memcpy(&triangles, header + 80, sizeof(triangles));
    if (file && bytes == 84 + 50 * std::uintmax_t{triangles} && triangles > kMaxMeshTriangles)
      fail_for_size(path, triangles);
  }
  if (lower_extension(path) == ".ply") check_ply_counts(path, file, bytes);
  if (bytes > kMaxFileBytes)
    fail_for_file(path, "has " + std::to_string(bytes >> 20U) + " MB, more than " +
                            std::to_string(kMaxFileBytes >> 20U) + "; simplify it first");
}

const aiScene& import_scene(Assimp::Importer& importer, const std::filesystem::path& path, int dropped) {
  const std::string extension = lower_extension(path);
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS,
                              dropped | aiComponent_TANGENTS_AND_BITANGENTS | aiComponent_ANIMATIONS |
                                  aiComponent_LIGHTS | aiComponent_CAMERAS |
                                  (extension == ".stl" ? static_cast<int>(aiComponent_NORMALS) : 0));
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  constexpr unsigned kChecked = aiProcess_ValidateDataStructure | aiProcess_RemoveComponent;
  importer.SetIOHandler(new ModelFolder(path, mended_text(path)));  // owned by the importer
  const aiScene* scene = importer.ReadFile(path.string(), kChecked);
  // assimp treats a face without corners as a polygon and terminates the process when triangulating it.
  if (scene && has_empty_face(*scene)) fail_for_file(path, "has a face without corners; is it damaged?");
  if (scene)
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_SortByPType |
                                         aiProcess_TransformUVCoords | aiProcess_JoinIdenticalVertices);
  if (scene) return *scene;
  const std::string reason = importer.GetErrorString();
  fail_for_file(path, "cannot be read as a mesh" +
                          (reason.empty() ? std::string() : " (" + reason.substr(0, 200) + ")") +
                          "; is it complete, and is its extension right?");
}

}  // namespace roomradar
