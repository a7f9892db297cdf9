// mesh_file.cpp: reads and writes meshes through assimp, with explicit limits.
#include "mapping/mesh/mesh_file.hpp"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>

#include "mapping/mesh/ply_writer.hpp"
#include "mapping/types/serialize.hpp"
#include "mapping/types/system/atomic_file.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/run_sandboxed.hpp"

namespace roomradar {
namespace {

constexpr std::uintmax_t kMaxFileBytes = 512U << 20U;  // 2 million triangles as text take about 300 MB

struct Format {
  const char* extension;
  const char* assimp_id;  // exporter name; null: written by ply_writer
};
constexpr Format kFormats[] = {{".ply", nullptr}, {".obj", "objnomtl"}, {".stl", "stlb"}, {".glb", "glb2"}};

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& fault) {
  throw Error(path.string() + ": " + fault);
}

const Format& format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const Format& format : kFormats)
    if (extension == format.extension) return format;
  fail(path,
       "the extension \"" + extension + "\" is no mesh format known here; use .ply, .obj, .stl or .glb");
}

[[noreturn]] void fail_for_size(const std::filesystem::path& path, std::uint64_t triangles) {
  fail(path, "has " + std::to_string(triangles) + " triangles, more than " +
                 std::to_string(kMaxMeshTriangles) + "; simplify it first");
}

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
    if (!(words >> name >> count)) fail(path, "its header line \"" + line.substr(0, 80) + "\" has no count");
    if (name == "face" && count > kMaxMeshTriangles) fail_for_size(path, count);
    if (count > bytes)
      fail(path, "is cut short: it promises " + std::to_string(count) + " of \"" + name.substr(0, 40) + "\"");
  }
  if (!header) fail(path, "its header has no end; wanted a .ply");
}

// Rejects files whose size or header counts are too large, before memory is allocated for them.
void check_claimed_size(const std::filesystem::path& path, const Format& format) {
  std::error_code unreadable;
  if (!std::filesystem::exists(path, unreadable)) fail(path, "there is no such file");
  if (!std::filesystem::is_regular_file(path, unreadable)) fail(path, "is not a file");
  const std::uintmax_t bytes = std::filesystem::file_size(path, unreadable);
  if (unreadable) fail(path, "cannot be read: " + unreadable.message());
  if (bytes == 0) fail(path, "is empty; wanted a mesh");
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(path, "cannot be opened; may you read it?");
  if (std::strcmp(format.extension, ".stl") == 0) {
    char header[84] = {};
    file.read(header, sizeof(header));
    std::uint32_t triangles = 0;
    std::memcpy(&triangles, header + 80, sizeof(triangles));
    if (file && bytes == 84 + 50 * std::uintmax_t{triangles} && triangles > kMaxMeshTriangles)
      fail_for_size(path, triangles);
  }
  if (std::strcmp(format.extension, ".ply") == 0) check_ply_counts(path, file, bytes);
  if (bytes > kMaxFileBytes)
    fail(path, "has " + std::to_string(bytes >> 20U) + " MB, more than " +
                   std::to_string(kMaxFileBytes >> 20U) + "; simplify it first");
}

bool is_gltf(const Format& format) { return std::strcmp(format.extension, ".glb") == 0; }

/// .glb has y up and linear colours; roomradar has z up and sRGB. Source: glTF 2.0 specification, 3.3 and
/// 3.7.2.1; IEC 61966-2-1 for sRGB.
aiVector3D with_y_up(const aiVector3D& p) { return {p.x, p.z, -p.y}; }
aiMatrix4x4 z_up_from_y_up() { return {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1}; }
float linear_of(float srgb01) {
  return srgb01 <= 0.04045F ? srgb01 / 12.92F : std::pow((srgb01 + 0.055F) / 1.055F, 2.4F);
}
float srgb_of(float linear01) {
  return linear01 <= 0.0031308F ? 12.92F * linear01 : 1.055F * std::pow(linear01, 1.0F / 2.4F) - 0.055F;
}

std::uint8_t channel_of(float value01) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value01, 0.0F, 1.0F) * 255.0F));
}

// Collects the meshes below a node, with the node transforms applied.
class Collector {
 public:
  Collector(const std::filesystem::path& path, const aiScene& scene, const Format& format)
      : path_(path), scene_(scene), is_gltf_(is_gltf(format)) {
    has_normals_ = has_colours_ = true;
    for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
      has_normals_ = has_normals_ && scene.mMeshes[i]->HasNormals();
      has_colours_ = has_colours_ && scene.mMeshes[i]->HasVertexColors(0);
    }
    if (scene.mRootNode) add(*scene.mRootNode, is_gltf_ ? z_up_from_y_up() : aiMatrix4x4(), 0);
  }
  Mesh take() { return std::move(mesh_); }

 private:
  void add(const aiNode& node, const aiMatrix4x4& T_file_parent, int depth) {
    if (depth > 1000) fail(path_, "its nodes are nested too deeply");
    const aiMatrix4x4 T_file_node = T_file_parent * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) add(*scene_.mMeshes[node.mMeshes[i]], T_file_node);
    for (unsigned i = 0; i < node.mNumChildren; ++i) add(*node.mChildren[i], T_file_node, depth + 1);
  }

  void add(const aiMesh& part, const aiMatrix4x4& T_file_node) {
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    if (mesh_.triangles.size() + part.mNumFaces > kMaxMeshTriangles)
      fail_for_size(path_, mesh_.triangles.size() + part.mNumFaces);
    // Nodes may reference one mesh any number of times; a mesh without triangles would be copied without
    // limit.
    if (mesh_.vertices.size() + part.mNumVertices > 3 * kMaxMeshTriangles)
      fail(path_, "has more than " + std::to_string(3 * kMaxMeshTriangles) + " vertices; simplify it first");
    const aiMatrix3x3 R = aiMatrix3x3(T_file_node);
    const aiMatrix3x3 normal_matrix = aiMatrix3x3(R).Inverse().Transpose();
    const bool mirrored = R.Determinant() < 0.0F;
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      const aiVector3D p = T_file_node * part.mVertices[i];
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        fail(path_, "vertex " + std::to_string(mesh_.vertices.size()) + " is not finite; repair the mesh");
      mesh_.vertices.emplace_back(p.x, p.y, p.z);
      if (has_normals_) {
        const aiVector3D n = normal_matrix * part.mNormals[i];
        const Eigen::Vector3f normal(n.x, n.y, n.z);
        mesh_.normals.push_back(normal.allFinite() ? Eigen::Vector3f(normal.normalized())
                                                   : Eigen::Vector3f(Eigen::Vector3f::Zero()));
      }
      if (has_colours_) {
        const aiColor4D& c = part.mColors[0][i];
        const auto channel = [&](float value) { return channel_of(is_gltf_ ? srgb_of(value) : value); };
        mesh_.colours.push_back({channel(c.r), channel(c.g), channel(c.b)});
      }
    }
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
      const aiFace& face = part.mFaces[i];
      if (face.mNumIndices != 3) continue;
      Triangle triangle{};
      for (unsigned k = 0; k < 3; ++k) {
        if (face.mIndices[k] >= part.mNumVertices) fail(path_, "a triangle names a vertex that is not there");
        triangle[k] = first + face.mIndices[mirrored ? 2 - k : k];
      }
      if (has_area(triangle)) mesh_.triangles.push_back(triangle);
    }
  }

  [[nodiscard]] bool has_area(const Triangle& t) const {
    const Eigen::Vector3d a = mesh_.vertices[t[0]].cast<double>();
    const Eigen::Vector3d u = mesh_.vertices[t[1]].cast<double>() - a;
    const Eigen::Vector3d v = mesh_.vertices[t[2]].cast<double>() - a;
    return u.cross(v).squaredNorm() > 0.0;
  }

  const std::filesystem::path& path_;
  const aiScene& scene_;
  bool is_gltf_ = false;
  bool has_normals_ = false;
  bool has_colours_ = false;
  Mesh mesh_;
};

bool has_empty_face(const aiScene& scene) {
  for (unsigned i = 0; i < scene.mNumMeshes; ++i)
    for (unsigned k = 0; k < scene.mMeshes[i]->mNumFaces; ++k)
      if (scene.mMeshes[i]->mFaces[k].mNumIndices == 0) return true;
  return false;
}

void require_writable(const Mesh& mesh, const std::filesystem::path& path) {
  if (mesh.vertices.empty() || mesh.triangles.empty()) fail(path, "not written: the mesh has no triangles");
  if ((!mesh.normals.empty() && mesh.normals.size() != mesh.vertices.size()) ||
      (!mesh.colours.empty() && mesh.colours.size() != mesh.vertices.size()))
    fail(path, "not written: its normals or colours are not one per vertex");
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle)
      if (vertex >= mesh.vertices.size())
        fail(path, "not written: a triangle names a vertex that is not there");
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    if (!vertex.allFinite()) fail(path, "not written: a vertex is not finite");
}

aiMesh* assimp_mesh(const Mesh& mesh, bool for_gltf) {
  const auto turned = [&](const Eigen::Vector3f& p) {
    const aiVector3D v(p.x(), p.y(), p.z());
    return for_gltf ? with_y_up(v) : v;
  };
  auto part = std::make_unique<aiMesh>();
  part->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  part->mNumVertices = static_cast<unsigned>(mesh.vertices.size());
  part->mVertices = new aiVector3D[mesh.vertices.size()];
  if (!mesh.normals.empty()) part->mNormals = new aiVector3D[mesh.vertices.size()];
  if (!mesh.colours.empty()) part->mColors[0] = new aiColor4D[mesh.vertices.size()];
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3f p = (mesh.origin + mesh.vertices[i].cast<double>()).cast<float>();
    part->mVertices[i] = turned(p);
    if (!mesh.normals.empty()) part->mNormals[i] = turned(mesh.normals[i]);
    if (!mesh.colours.empty()) {
      const auto level = [&](std::uint8_t c) {
        const float value = static_cast<float>(c) / 255.0F;
        return for_gltf ? linear_of(value) : value;
      };
      part->mColors[0][i] =
          aiColor4D(level(mesh.colours[i].r), level(mesh.colours[i].g), level(mesh.colours[i].b), 1.0F);
    }
  }
  part->mNumFaces = static_cast<unsigned>(mesh.triangles.size());
  part->mFaces = new aiFace[mesh.triangles.size()];
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    part->mFaces[i].mNumIndices = 3;
    part->mFaces[i].mIndices =
        new unsigned[3]{mesh.triangles[i][0], mesh.triangles[i][1], mesh.triangles[i][2]};
  }
  return part.release();
}

// Exports to memory because assimp does not detect a full disk.
std::string assimp_bytes(const Mesh& mesh, const Format& format, const std::filesystem::path& path) {
  aiScene scene;  // owns everything below
  scene.mMaterials = new aiMaterial* [1] { new aiMaterial() };
  scene.mNumMaterials = 1;
  scene.mMeshes = new aiMesh* [1] { assimp_mesh(mesh, is_gltf(format)) };
  scene.mNumMeshes = 1;
  scene.mRootNode = new aiNode("roomradar");
  scene.mRootNode->mMeshes = new unsigned[1]{0};
  scene.mRootNode->mNumMeshes = 1;
  Assimp::Exporter exporter;
  const aiExportDataBlob* blob = exporter.ExportToBlob(&scene, format.assimp_id);
  if (!blob || blob->size == 0)
    fail(path, std::string("the mesh cannot be turned into this format: ") + exporter.GetErrorString());
  return {static_cast<const char*>(blob->data), blob->size};
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

Mesh read_by_assimp(const std::filesystem::path& path, const Format& format) {
  // An .stl repeats its corners and has facet normals only: equal corners are merged and normals dropped.
  const bool facets = std::strcmp(format.extension, ".stl") == 0;
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS,
                              aiComponent_TEXCOORDS | aiComponent_TANGENTS_AND_BITANGENTS |
                                  aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS | aiComponent_TEXTURES |
                                  aiComponent_LIGHTS | aiComponent_CAMERAS |
                                  (facets ? static_cast<int>(aiComponent_NORMALS) : 0));
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  constexpr unsigned kChecked = aiProcess_ValidateDataStructure | aiProcess_RemoveComponent;
  const bool is_ply = std::strcmp(format.extension, ".ply") == 0;
  const std::string mended = is_ply ? ply_with_newline_to_drop(path) : std::string();
  const aiScene* scene = mended.empty()
                             ? importer.ReadFile(path.string(), kChecked)
                             : importer.ReadFileFromMemory(mended.data(), mended.size(), kChecked, "ply");
  // assimp treats a face without corners as a polygon and terminates the process when triangulating it.
  if (scene && has_empty_face(*scene)) fail(path, "has a face without corners; is it damaged?");
  if (scene)
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_SortByPType |
                                         aiProcess_JoinIdenticalVertices);
  if (!scene) {
    std::string reason = importer.GetErrorString();
    fail(path, "cannot be read as a mesh" +
                   (reason.empty() ? std::string() : " (" + reason.substr(0, 200) + ")") +
                   "; is it complete, and is its extension right?");
  }
  Mesh mesh = Collector(path, *scene, format).take();
  if (mesh.triangles.empty()) fail(path, "holds no triangles with an area; wanted a surface mesh");
  return mesh;
}

// Copies all items as one block; item by item, a large mesh would take seconds.
template <typename Archive, typename Item>
void serialize_items(Archive& archive, std::vector<Item>& items) {
  std::uint64_t count = items.size();
  serialize(archive, count);
  if constexpr (Archive::kReads) {
    archive.require(count, sizeof(Item));
    items.resize(count);
  }
  archive.raw(items.data(), count * sizeof(Item));
}

template <typename Archive>
void serialize(Archive& archive, Mesh& mesh) {
  archive.raw(mesh.origin.data(), 3 * sizeof(double));
  serialize_items(archive, mesh.normals);
  serialize_items(archive, mesh.vertices);
  serialize_items(archive, mesh.colours);
  serialize_items(archive, mesh.triangles);
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& path) {
  const Format& format = format_of(path);
  check_claimed_size(path, format);
  // assimp crashes or hangs on damaged files, so it runs sandboxed.
  const std::uintmax_t bytes = std::filesystem::file_size(path);
  const auto most_s = static_cast<unsigned>(3 + (bytes >> 20U));
  const std::size_t max_bytes = (std::size_t{1} << 30U) + 64 * bytes;
  const std::string answer = run_sandboxed(
      [&] {
        Mesh mesh = read_by_assimp(path, format);
        ByteWriter writer;
        serialize(writer, mesh);
        return writer.bytes();
      },
      path.string() + ": cannot be read; is it damaged?", most_s, max_bytes);
  ByteReader reader(answer, path.string());
  Mesh mesh;
  serialize(reader, mesh);
  reader.require_end();
  return mesh;
}

void write_mesh(const Mesh& mesh, const std::filesystem::path& path) {
  const Format& format = format_of(path);
  require_writable(mesh, path);
  const std::string bytes = format.assimp_id ? assimp_bytes(mesh, format, path) : ply_bytes(mesh);
  AtomicFile file(path);
  file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

}  // namespace roomradar
