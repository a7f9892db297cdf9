// room_page.cpp: packs a room into JSON, with arrays as base64, and puts it into the page.
#include "app/page/room_page.hpp"

#include <openssl/evp.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/page/page_template.hpp"
#include "mapping/coverage/coverage.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "mapping/types/system/atomic_file.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxPathPoints = 4000;  // a minute has 1,800 poses; the line needs fewer
constexpr std::size_t kMaxDots = 4000;        // of a change's surface

template <typename Value>
std::string base64(const std::vector<Value>& values) {
  const std::size_t bytes = values.size() * sizeof(Value);
  std::string text((bytes + 2) / 3 * 4 + 1, '\0');  // OpenSSL ends it with a zero
  EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                  reinterpret_cast<const unsigned char*>(values.data()), static_cast<int>(bytes));
  text.pop_back();
  return text;
}

/// Millimetres suffice for a page, and keep it small.
double rounded_m(double metres) { return std::round(metres * 1e3) / 1e3; }

Json point_of(const Eigen::Vector3d& p) { return {rounded_m(p.x()), rounded_m(p.y()), rounded_m(p.z())}; }

void put_positions(const Mesh& mesh, Json& json) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex);
  const Eigen::Array3f size = box.sizes().cwiseMax(1e-6F).array();
  std::vector<std::uint16_t> steps;
  steps.reserve(3 * mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Array3f part = (vertex - box.min()).array() / size * 65535.0F + 0.5F;
    for (Eigen::Index k = 0; k < 3; ++k) steps.push_back(static_cast<std::uint16_t>(part[k]));
  }
  const Eigen::Vector3d low = mesh.origin + box.min().cast<double>();
  json["low_m"] = {low.x(), low.y(), low.z()};
  json["size_m"] = {size.x(), size.y(), size.z()};
  json["positions"] = base64(steps);
}

Json json_of(const PageRoom& room) {
  if (room.mesh_world->triangles.empty()) throw Error(room.name + ": has no surface to show");
  Json json = {{"name", room.name}};
  TexturedMesh textured;
  if (room.texture) textured = textured_mesh(*room.mesh_world, *room.texture);
  const Mesh& mesh = room.texture ? textured.mesh : *room.mesh_world;
  put_positions(mesh, json);
  std::vector<std::uint32_t> indices;
  for (const Triangle& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
  json["triangles"] = base64(indices);
  if (!room.texture) {
    if (!mesh.colours.empty()) json["colours"] = base64(mesh.colours);
    return json;
  }
  std::vector<std::uint16_t> points;
  for (const Eigen::Vector2f& point : textured.texture_points)
    for (Eigen::Index k = 0; k < 2; ++k)
      points.push_back(static_cast<std::uint16_t>(std::clamp(point[k], 0.0F, 1.0F) * 65535.0F + 0.5F));
  json["points"] = base64(points);
  json["texture"] = base64(textured.texture_jpeg);
  return json;
}

/// Returns every nth point, so that at most `most` remain, as a flat array.
template <typename Points, typename PointOf>
Json flat(const Points& points, std::size_t most, const PointOf& point_of_item) {
  Json json = Json::array();
  const std::size_t step = points.size() / most + 1;
  for (std::size_t i = 0; i < points.size(); i += step)
    for (const double value : std::initializer_list<double>{
             point_of_item(points[i]).x(), point_of_item(points[i]).y(), point_of_item(points[i]).z()})
      json.push_back(rounded_m(value));
  return json;
}

Json json_of(const Hole& hole) {
  std::array<char, 120> text{};
  format_classic(text.data(), text.size(), "%s, %.2f m wide, %.2f m\u00b2",
                 std::string(to_string(hole.kind)).c_str(), hole.size_m, hole.area_m2);
  return {{"at_m", point_of(hole.position_world)}, {"size_m", rounded_m(hole.size_m)}, {"text", text.data()}};
}

Json json_of(const Change& change) {
  const Eigen::Vector3d size = change.box_world.sizes();
  std::array<char, 120> text{};
  format_classic(text.data(), text.size(), "%s: %.2f x %.2f x %.2f m, %.1f litres",
                 std::string(to_string(change.kind)).c_str(), size.x(), size.y(), size.z(),
                 1e3 * change.volume_m3);
  return {{"kind", std::string(to_string(change.kind))},
          {"at_m", point_of(change.position_world)},
          {"low_m", point_of(change.box_world.min())},
          {"high_m", point_of(change.box_world.max())},
          {"size_m", rounded_m(size.norm())},
          {"surface_m", flat(change.surface_world, kMaxDots, [](const Eigen::Vector3d& p) { return p; })},
          {"text", text.data()}};
}

/// Returns the azimuth of the direction, rad, about +z.
double azimuth_of(const Eigen::Vector3d& direction) { return std::atan2(direction.y(), direction.x()); }

std::string title_of(const std::filesystem::path& folder) {
  const std::filesystem::path plain = folder.lexically_normal();
  return (plain.has_filename() ? plain : plain.parent_path()).filename().string();
}

}  // namespace

void write_room_page(const RoomPage& page, const std::filesystem::path& path) {
  Json json = {{"name", page.title}, {"meshes", Json::array()}};
  for (const PageRoom& room : page.rooms) json["meshes"].push_back(json_of(room));
  json["holes"] = Json::array();
  for (const Hole& hole : page.holes)
    if (is_inside_scan(hole)) json["holes"].push_back(json_of(hole));
  json["changes"] = Json::array();
  for (const Change& change : page.changes) json["changes"].push_back(json_of(change));
  json["path_m"] = flat(page.trajectory, kMaxPathPoints, [](const TimedPose& pose) -> Eigen::Vector3d {
    return pose.T_world_camera.translation();
  });
  if (!page.trajectory.empty()) {
    // The first view is from behind the scan's first camera, and a walk looks along it.
    const Eigen::Vector3d back = -page.trajectory.front().T_world_camera.linear().col(2);
    json["azimuth"] = json["look"] = azimuth_of(back);
  }
  // "<" would end the script that the data stand in; names need not be UTF-8.
  std::string data = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  for (std::size_t at = 0; (at = data.find('<', at)) != std::string::npos;) data.replace(at, 1, "\\u003c");
  const std::size_t at = kPageTemplate.find(kPageRoom);
  AtomicFile file(path);
  file.stream() << kPageTemplate.substr(0, at) << data << kPageTemplate.substr(at + kPageRoom.size());
  file.commit();
}

bool is_page(const std::filesystem::path& path) { return lower_extension(path) == ".html"; }

void write_map_page(const SavedMap& map, const std::filesystem::path& folder,
                    const std::filesystem::path& path) {
  RoomPage page;
  page.title = title_of(folder);
  const auto texture = fitting_texture(map);
  page.rooms = {{page.title, &map.mesh, texture.get()}};
  page.holes = survey_coverage(map.octree.load(), map.mesh, map.trajectory).holes;
  page.trajectory = map.trajectory;
  write_room_page(page, path);
}

void write_diff_page(const NamedMap& a, const NamedMap& b, const Eigen::Isometry3d& T_a_b,
                     std::span<const Change> changes, const std::filesystem::path& path) {
  RoomPage page;
  const std::string name_a = title_of(a.folder), name_b = title_of(b.folder);
  const Mesh mesh_b = transformed(b.map.mesh, T_a_b);
  const auto texture_a = fitting_texture(a.map), texture_b = fitting_texture(b.map);
  page.title = name_a + " and " + name_b;
  page.rooms = {{name_a, &a.map.mesh, texture_a.get()}, {name_b, &mesh_b, texture_b.get()}};
  page.trajectory = a.map.trajectory;
  page.changes.assign(changes.begin(), changes.end());
  write_room_page(page, path);
}

}  // namespace roomradar
