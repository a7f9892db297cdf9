// mesh_file.cpp: reads and writes meshes through assimp, with explicit limits, and .ply files of roomradar
// directly.
#include "mapping/mesh/mesh_file.hpp"

#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "mapping/mesh/assimp_import.hpp"
#include "mapping/mesh/gltf_scene.hpp"
#include "mapping/mesh/ply_file.hpp"
#include "mapping/mesh/scene_mesh.hpp"
#include "mapping/types/system/atomic_file.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/run_sandboxed.hpp"

namespace roomradar {
namespace {

struct Format {
  const char* extension;
  const char* assimp_id;  // exporter name; null: written by ply_file
};
constexpr Format kFormats[] = {{".ply", nullptr}, {".obj", "objnomtl"}, {".stl", "stlb"}, {".glb", "glb2"}};

const Format& format_of(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  for (const Format& format : kFormats)
    if (extension == format.extension) return format;
  fail_for_file(path, "the extension \"" + extension +
                          "\" is not a supported mesh format; use .ply, .obj, .stl or .glb");
}

bool is_gltf(const Format& format) { return std::strcmp(format.extension, ".glb") == 0; }

/// .glb has y up and linear colours; roomradar has z up and sRGB. Source: glTF 2.0 specification, 3.3 and
/// 3.7.2.1.
aiVector3D with_y_up(const aiVector3D& p) { return {p.x, p.z, -p.y}; }

void require_writable(const Mesh& mesh, const std::filesystem::path& path) {
  if (mesh.vertices.empty() || mesh.triangles.empty())
    fail_for_file(path, "not written: the mesh has no triangles");
  if ((!mesh.normals.empty() && mesh.normals.size() != mesh.vertices.size()) ||
      (!mesh.colours.empty() && mesh.colours.size() != mesh.vertices.size()))
    fail_for_file(path, "not written: its normals or colours are not one per vertex");
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle)
      if (vertex >= mesh.vertices.size())
        fail_for_file(path, "not written: a triangle names a vertex that is not there");
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    if (!vertex.allFinite()) fail_for_file(path, "not written: a vertex is not finite");
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

void fill_scene(const Mesh& mesh, bool for_gltf, aiScene& scene) {
  scene.mMaterials = new aiMaterial* [1] { new aiMaterial() };
  scene.mNumMaterials = 1;
  scene.mMeshes = new aiMesh* [1] { assimp_mesh(mesh, for_gltf) };
  scene.mNumMeshes = 1;
  scene.mRootNode = new aiNode("roomradar");
  scene.mRootNode->mMeshes = new unsigned[1]{0};
  scene.mRootNode->mNumMeshes = 1;
}

/// Adds the texture points and a matt material. The texture is embedded in a .glb, otherwise a separate file.
void add_texture(const TexturedMesh& textured, bool for_gltf, const std::string& file, aiScene& scene) {
  aiMesh& part = *scene.mMeshes[0];
  part.mNumUVComponents[0] = 2;
  part.mTextureCoords[0] = new aiVector3D[textured.texture_points.size()];
  for (std::size_t i = 0; i < textured.texture_points.size(); ++i)
    // assimp has v upwards.
    part.mTextureCoords[0][i] = {textured.texture_points[i].x(), 1.0F - textured.texture_points[i].y(), 0.0F};
  aiMaterial& material = *scene.mMaterials[0];
  // Not KHR_materials_unlit: VTK 9.1, and so f3d, then shows no texture.
  const float rough = 1.0F;
  material.AddProperty(&rough, 1, AI_MATKEY_ROUGHNESS_FACTOR);
  const aiColor3D white(1.0F, 1.0F, 1.0F);
  material.AddProperty(&white, 1, AI_MATKEY_COLOR_DIFFUSE);
  const aiString texture(for_gltf ? "*0" : file);
  material.AddProperty(&texture, AI_MATKEY_TEXTURE_DIFFUSE(0));
  if (!for_gltf) return;
  auto embedded = std::make_unique<aiTexture>();
  const std::vector<std::uint8_t>& jpeg = textured.texture_jpeg;
  embedded->mWidth = static_cast<unsigned>(jpeg.size());
  std::strcpy(embedded->achFormatHint, "jpg");
  embedded->pcData = new aiTexel[jpeg.size() / sizeof(aiTexel) + 1];
  std::memcpy(static_cast<void*>(embedded->pcData), jpeg.data(), jpeg.size());
  scene.mTextures = new aiTexture* [1] { embedded.release() };
  scene.mNumTextures = 1;
}

// Exports to memory because assimp does not detect a full disk.
std::string assimp_bytes(const aiScene& scene, const char* assimp_id, const std::filesystem::path& path) {
  Assimp::Exporter exporter;
  const aiExportDataBlob* blob = exporter.ExportToBlob(&scene, assimp_id);
  if (!blob || blob->size == 0)
    fail_for_file(path,
                  std::string("the mesh cannot be turned into this format: ") + exporter.GetErrorString());
  return {static_cast<const char*>(blob->data), blob->size};
}

void write_whole(const std::string& bytes, const std::filesystem::path& path) {
  AtomicFile file(path);
  file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

/// Replaces the rest of the first line that begins with `word`.
void replace_line(std::string& text, const std::string& word, const std::string& rest) {
  const std::size_t line = text.find("\n" + word);
  if (line == std::string::npos) return;
  const std::size_t from = line + 1 + word.size();
  text.replace(from, text.find('\n', from) - from, rest);
}

/// Returns the name of the files beside an .obj, without extension: its own name, with '_' for characters
/// that readers take for something else. Readers differ on blanks: tinyobjloader takes each word for a file
/// unless
/// '\\' stands before the blank, which Blender and assimp take for a part of the name. A name that would be
/// another .obj's gets one '_' more.
std::string stem_for_obj(const std::filesystem::path& path) {
  std::string stem = path.stem().string();
  const auto is_plain = [](unsigned char c) {
    return c >= 0x80 || std::isalnum(c) != 0 || c == '.' || c == '_' || c == '-' || c == '+';
  };
  std::replace_if(
      stem.begin(), stem.end(), [&](char c) { return !is_plain(static_cast<unsigned char>(c)); }, '_');
  if (stem.starts_with('-')) stem.front() = '_';  // else an option, in a material
  if (stem == path.stem().string()) return stem;
  const auto is_taken = [&] {
    std::error_code unreadable;
    return std::filesystem::exists(path.parent_path() / (stem + ".obj"), unreadable);
  };
  while (is_taken()) stem += '_';
  return stem;
}

void require_triangles(const std::filesystem::path& path, const Mesh& mesh) {
  if (mesh.triangles.empty())
    fail_for_file(path, "contains no triangles with an area; must be a surface mesh");
}

Mesh read_by_assimp(const std::filesystem::path& path) {
  Assimp::Importer importer;
  const aiScene& scene =
      import_scene(importer, path, aiComponent_TEXCOORDS | aiComponent_BONEWEIGHTS | aiComponent_TEXTURES);
  return scene_mesh(path, scene, {}).mesh;
}

Mesh read_gltf(const std::filesystem::path& path) {
  GltfDocument document(path);
  NotDrawn ignored;
  GltfScene scene = gltf_scene(
      document, [](auto) { return GltfMaterialUse{}; }, ignored);
  Mesh& mesh = scene.mesh;
  const auto& parts = scene.parts;
  if (!std::all_of(parts.begin(), parts.end(), [](const GltfPart& part) { return part.has_normals; }))
    mesh.normals.clear();
  for (std::vector<Eigen::Vector3f>* const vectors : {&mesh.vertices, &mesh.normals})
    for (Eigen::Vector3f& v : *vectors) v = Eigen::Vector3f(v.x(), -v.z(), v.y());
  if (!std::all_of(parts.begin(), parts.end(), [](const GltfPart& part) { return part.has_colours; }))
    scene.colours.clear();
  for (const Eigen::Vector4f& c : scene.colours) {
    const auto channel = [](float value) { return channel_of(srgb_of(value)); };
    mesh.colours.push_back({channel(c.x()), channel(c.y()), channel(c.z())});
  }
  return std::move(mesh);
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& path) {
  const Format& format = format_of(path);
  require_plausible_size(path);
  if (lower_extension(path) == ".ply") {
    if (std::optional<Mesh> mesh = mesh_of_ply(read_bytes(path, "a mesh"), path)) {
      require_triangles(path, *mesh);
      return std::move(*mesh);
    }
  }
  // assimp crashes or hangs on damaged files, so it runs sandboxed, as do the decoders of glTF.
  const std::uintmax_t bytes = std::filesystem::file_size(path);
  const auto most_s = static_cast<unsigned>(3 + (bytes >> 20U));
  const std::size_t max_bytes = (std::size_t{1} << 30U) + 64 * bytes;
  const std::string answer = run_sandboxed(
      [&] {
        Mesh mesh = is_gltf(format) ? read_gltf(path) : read_by_assimp(path);
        require_triangles(path, mesh);
        ByteWriter writer;
        writer(mesh);
        return std::move(writer.bytes);
      },
      path.string() + ": cannot be read; is it damaged?", most_s, max_bytes);
  ByteReader reader(answer, path.string());
  Mesh mesh;
  reader(mesh);
  reader.require_end();
  return mesh;
}

void write_mesh(const Mesh& mesh, const std::filesystem::path& path) {
  const Format& format = format_of(path);
  require_writable(mesh, path);
  if (!format.assimp_id) return write_whole(ply_bytes(mesh), path);
  aiScene scene;  // owns everything in it
  fill_scene(mesh, is_gltf(format), scene);
  write_whole(assimp_bytes(scene, format.assimp_id, path), path);
}

bool keeps_texture(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".glb" || extension == ".obj";
}

void write_mesh(const TexturedMesh& textured, const std::filesystem::path& path) {
  if (!keeps_texture(path)) fail_for_file(path, "only .glb and .obj keep a texture; use one of them");
  require_writable(textured.mesh, path);
  if (textured.texture_points.size() != textured.mesh.vertices.size() || textured.texture_jpeg.empty())
    fail_for_file(path, "not written: its texture is missing, or has no point for each vertex");
  const bool for_gltf = is_gltf(format_of(path));
  const std::filesystem::path stem = path.parent_path() / stem_for_obj(path);
  std::filesystem::path picture = stem, material = stem;
  picture += ".jpg";
  material += ".mtl";
  aiScene scene;  // owns everything in it
  fill_scene(textured.mesh, for_gltf, scene);
  add_texture(textured, for_gltf, picture.filename().string(), scene);
  std::string bytes = assimp_bytes(scene, for_gltf ? "glb2" : "obj", path);
  if (!for_gltf) {
    // When assimp writes to memory, it knows neither the file's name nor that of its material.
    replace_line(bytes, "mtllib ", material.filename().string());
    replace_line(bytes, "usemtl ", "room");
    write_whole({textured.texture_jpeg.begin(), textured.texture_jpeg.end()}, picture);
    write_whole("newmtl room\nillum 0\nKa 1 1 1\nKd 1 1 1\nmap_Ka " + picture.filename().string() +
                    "\nmap_Kd " + picture.filename().string() + "\n",
                material);
  }
  write_whole(bytes, path);
}

}  // namespace roomradar
