// model_files.hpp: writes a textured crate, and other models, in each format, by hand: independent of assimp.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/media/picture_file.hpp"
#include "app/models/model.hpp"

namespace roomradar::test {

inline void write_file(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

inline std::string file_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Quarters of the picture: top left, top right, bottom left, bottom right.
inline constexpr Rgb kRed{220, 40, 40}, kGreen{40, 200, 60}, kBlue{50, 80, 230}, kYellow{240, 220, 60};

/// 64 x 64 pixels in four colours, with a white mark in the top left corner.
inline ColourImage quarters_picture() {
  ColourImage picture(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      picture.at(x, y) = y < 32 ? (x < 32 ? kRed : kGreen) : (x < 32 ? kBlue : kYellow);
  for (int y = 4; y < 12; ++y)
    for (int x = 4; x < 12; ++x) picture.at(x, y) = {255, 255, 255};
  return picture;
}

/// A box that stands on z = 0, +z up, with the picture upright on each side. Its front is at -y.
inline Model crate(const Eigen::Vector3f& size_m = {0.2F, 0.14F, 0.1F}) {
  struct Side {
    Eigen::Vector3f right, up;
  };
  const Eigen::Vector3f x = Eigen::Vector3f::UnitX(), y = Eigen::Vector3f::UnitY(),
                        z = Eigen::Vector3f::UnitZ();
  Model model;
  const Eigen::Vector3f middle(0.0F, 0.0F, 0.5F * size_m.z());
  for (const Side& side : {Side{x, z}, Side{-x, z}, Side{y, z}, Side{-y, z}, Side{x, y}, Side{x, -y}}) {
    const Eigen::Vector3f out = side.right.cross(side.up);
    const auto first = static_cast<std::uint32_t>(model.mesh.vertices.size());
    for (const float v : {0.0F, 1.0F})
      for (const float u : {0.0F, 1.0F}) {
        const Eigen::Vector3f unit = out + (2.0F * u - 1.0F) * side.right + (1.0F - 2.0F * v) * side.up;
        model.mesh.vertices.push_back(middle + 0.5F * unit.cwiseProduct(size_m));
        model.mesh.normals.push_back(out);
        model.texture_points.emplace_back(u, v);
      }
    model.mesh.triangles.push_back({first, first + 2, first + 3});
    model.mesh.triangles.push_back({first, first + 3, first + 1});
  }
  model.parts = {{0, 12, 0}};
  model.textures.emplace_back().colour = quarters_picture();
  return model;
}

inline Eigen::Vector3f y_up(const Eigen::Vector3f& p) { return {p.x(), p.z(), -p.y()}; }

inline void append_floats(std::string& bytes, const float* values, std::size_t count) {
  bytes.append(reinterpret_cast<const char*>(values), count * sizeof(float));
}

/// What a .glb of the crate contains besides its geometry.
struct GlbWants {
  nlohmann::json material = {
      {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0}}}};
  bool has_texture = true;
  std::vector<float> colours{};  ///< linear, 3 per vertex; empty: none
  bool moves = false;            ///< an animation turns its node, and the node stands 1 m aside
  std::string picture{};         ///< PNG; empty: quarters_picture()
};

/// glTF 2.0, binary: y up, the picture within.
inline void write_glb(const Model& model, const std::filesystem::path& path, const GlbWants& wants = {}) {
  using nlohmann::json;
  std::string data;
  json views = json::array(), accessors = json::array();
  const auto add_view = [&](const std::string& bytes) {
    data.resize((data.size() + 3) / 4 * 4, '\0');
    views.push_back({{"buffer", 0}, {"byteOffset", data.size()}, {"byteLength", bytes.size()}});
    data += bytes;
    return views.size() - 1;
  };
  const auto add_accessor = [&](const std::string& bytes, int component, std::size_t count, const char* type,
                                const json& more = json::object()) {
    json accessor = {
        {"bufferView", add_view(bytes)}, {"componentType", component}, {"count", count}, {"type", type}};
    accessor.update(more);
    accessors.push_back(accessor);
    return accessors.size() - 1;
  };
  std::string positions, normals, points, indices;
  Eigen::Vector3f low = Eigen::Vector3f::Constant(1e9F), high = -low;
  for (std::size_t i = 0; i < model.mesh.vertices.size(); ++i) {
    const Eigen::Vector3f p = y_up(model.mesh.vertices[i]), n = y_up(model.mesh.normals[i]);
    low = low.cwiseMin(p), high = high.cwiseMax(p);
    append_floats(positions, p.data(), 3);
    append_floats(normals, n.data(), 3);
    append_floats(points, model.texture_points[i].data(), 2);
  }
  for (const Triangle& t : model.mesh.triangles) indices.append(reinterpret_cast<const char*>(t.data()), 12);
  const std::size_t count = model.mesh.vertices.size();
  json attributes;
  attributes["POSITION"] =
      add_accessor(positions, 5126, count, "VEC3",
                   {{"min", {low.x(), low.y(), low.z()}}, {"max", {high.x(), high.y(), high.z()}}});
  attributes["NORMAL"] = add_accessor(normals, 5126, count, "VEC3");
  if (wants.has_texture) attributes["TEXCOORD_0"] = add_accessor(points, 5126, count, "VEC2");
  if (!wants.colours.empty()) {
    std::string colours;
    append_floats(colours, wants.colours.data(), wants.colours.size());
    attributes["COLOR_0"] = add_accessor(colours, 5126, count, "VEC3");
  }
  json primitive = {{"attributes", attributes},
                    {"indices", add_accessor(indices, 5125, 3 * model.mesh.triangles.size(), "SCALAR")}};
  json node = {{"mesh", 0}, {"name", "crate"}};
  json root = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
  if (!wants.material.is_null()) {
    primitive["material"] = 0;
    root["materials"] = {wants.material};
  }
  if (wants.has_texture) {
    const std::filesystem::path png = path.parent_path() / "quarters.tmp.png";
    write_png(model.textures[0].colour, png);
    root["images"] = {{{"bufferView", add_view(wants.picture.empty() ? file_bytes(png) : wants.picture)},
                       {"mimeType", "image/png"}}};
    root["textures"] = {{{"source", 0}}};
    std::filesystem::remove(png);
  }
  if (wants.moves) {
    node["translation"] = {1.0, 0.0, 0.0};
    const std::vector<float> times = {0.0F, 1.0F};
    const std::vector<float> turns = {0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.7071F, 0.0F, 0.7071F};
    std::string time_bytes, turn_bytes;
    append_floats(time_bytes, times.data(), 2);
    append_floats(turn_bytes, turns.data(), 8);
    const json limits = {{"min", {0.0F}}, {"max", {1.0F}}};
    const std::size_t input = add_accessor(time_bytes, 5126, 2, "SCALAR", limits);
    const std::size_t output = add_accessor(turn_bytes, 5126, 2, "VEC4");
    root["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}}},
                           {"samplers", {{{"input", input}, {"output", output}}}}}};
  }
  root["nodes"] = {node};
  root["meshes"] = {{{"primitives", {primitive}}}};
  root["accessors"] = accessors;
  root["bufferViews"] = views;
  data.resize((data.size() + 3) / 4 * 4, '\0');
  root["buffers"] = {{{"byteLength", data.size()}}};
  std::string text = root.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string bytes = "glTF";
  const auto word = [&](std::size_t value) {
    const auto number = static_cast<std::uint32_t>(value);
    bytes.append(reinterpret_cast<const char*>(&number), 4);
  };
  word(2), word(12 + 8 + text.size() + 8 + data.size());
  word(text.size()), bytes += "JSON" + text;
  word(data.size()), bytes += std::string("BIN\0", 4) + data;
  write_file(path, bytes);
}

/// An .obj with its .mtl and picture beside it, y up.
inline void write_obj(const Model& model, const std::filesystem::path& path, bool writes_picture = true) {
  const std::string stem = path.stem().string();
  std::string text = "mtllib " + stem + ".mtl\nusemtl wood\n";
  for (std::size_t i = 0; i < model.mesh.vertices.size(); ++i) {
    const Eigen::Vector3f p = y_up(model.mesh.vertices[i]), n = y_up(model.mesh.normals[i]);
    const Eigen::Vector2f& uv = model.texture_points[i];
    text += "v " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
    text += "vn " + std::to_string(n.x()) + " " + std::to_string(n.y()) + " " + std::to_string(n.z()) + "\n";
    text += "vt " + std::to_string(uv.x()) + " " + std::to_string(1.0F - uv.y()) + "\n";
  }
  for (const Triangle& t : model.mesh.triangles) {
    text += "f";
    for (const std::uint32_t vertex : t) {
      const std::string number = std::to_string(vertex + 1);
      text += " " + number + "/" + number + "/" + number;
    }
    text += "\n";
  }
  write_file(path, text);
  write_file(path.parent_path() / (stem + ".mtl"), "newmtl wood\nKd 1 1 1\nmap_Kd " + stem + ".png\n");
  if (writes_picture) write_png(model.textures[0].colour, path.parent_path() / (stem + ".png"));
}

/// A COLLADA file in centimetres with z up, its picture beside it.
inline void write_dae(const Model& model, const std::filesystem::path& path) {
  const std::string stem = path.stem().string();
  std::string positions, normals, points, indices;
  const auto add = [](std::string& text, float value) { text += std::to_string(value) + " "; };
  for (std::size_t i = 0; i < model.mesh.vertices.size(); ++i) {
    for (int k = 0; k < 3; ++k) add(positions, 100.0F * model.mesh.vertices[i][k]);
    for (int k = 0; k < 3; ++k) add(normals, model.mesh.normals[i][k]);
    add(points, model.texture_points[i].x()), add(points, 1.0F - model.texture_points[i].y());
  }
  for (const Triangle& t : model.mesh.triangles)
    for (const std::uint32_t vertex : t)
      for (int k = 0; k < 3; ++k) indices += std::to_string(vertex) + " ";
  const std::size_t count = model.mesh.vertices.size();
  const auto source = [&](const std::string& id, const std::string& values, std::size_t width,
                          const std::string& names) {
    std::string params;
    for (const char name : names) params += std::string("<param name=\"") + name + "\" type=\"float\"/>";
    return "<source id=\"" + id + "\"><float_array id=\"" + id + "-a\" count=\"" +
           std::to_string(count * width) + "\">" + values +
           "</float_array><technique_common><accessor source=\"#" + id + "-a\" count=\"" +
           std::to_string(count) + "\" stride=\"" + std::to_string(width) + "\">" + params +
           "</accessor></technique_common></source>";
  };
  write_png(model.textures[0].colour, path.parent_path() / (stem + ".png"));
  write_file(path,
             "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
             "<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">"
             "<asset><unit name=\"centimeter\" meter=\"0.01\"/><up_axis>Z_UP</up_axis></asset>"
             "<library_images><image id=\"i\"><init_from>" +
                 stem +
                 ".png</init_from></image></library_images>"
                 "<library_effects><effect id=\"e\"><profile_COMMON>"
                 "<newparam sid=\"s\"><surface type=\"2D\"><init_from>i</init_from></surface></newparam>"
                 "<newparam sid=\"t\"><sampler2D><source>s</source></sampler2D></newparam>"
                 "<technique sid=\"c\"><lambert><diffuse><texture texture=\"t\" "
                 "texcoord=\"UV\"/></diffuse></lambert></technique>"
                 "</profile_COMMON></effect></library_effects>"
                 "<library_materials><material id=\"m\" name=\"wood\"><instance_effect "
                 "url=\"#e\"/></material></library_materials>"
                 "<library_geometries><geometry id=\"g\"><mesh>" +
                 source("p", positions, 3, "XYZ") + source("n", normals, 3, "XYZ") +
                 source("uv", points, 2, "ST") +
                 "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>"
                 "<triangles material=\"m\" count=\"" +
                 std::to_string(model.mesh.triangles.size()) +
                 "\">"
                 "<input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><input semantic=\"NORMAL\" "
                 "source=\"#n\" offset=\"1\"/>"
                 "<input semantic=\"TEXCOORD\" source=\"#uv\" offset=\"2\" set=\"0\"/><p>" +
                 indices +
                 "</p></triangles>"
                 "</mesh></geometry></library_geometries>"
                 "<library_visual_scenes><visual_scene id=\"vs\"><node id=\"node\"><instance_geometry "
                 "url=\"#g\"><bind_material>"
                 "<technique_common><instance_material symbol=\"m\" target=\"#m\">"
                 "<bind_vertex_input semantic=\"UV\" input_semantic=\"TEXCOORD\" "
                 "input_set=\"0\"/></instance_material>"
                 "</technique_common></bind_material></instance_geometry></node></visual_scene></"
                 "library_visual_scenes>"
                 "<scene><instance_visual_scene url=\"#vs\"/></scene></COLLADA>\n");
}

}  // namespace roomradar::test
