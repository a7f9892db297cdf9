// surface_update.cpp: cuts a box out of a mesh, re-extracts the surface in it, and joins both.
#include "mapping/surface/surface_update.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "mapping/mesh/components.hpp"

namespace roomradar {
namespace {

// One corner of a polygon being clipped.
struct Corner {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  // relative to the mesh's origin
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  Eigen::Vector3f colour = Eigen::Vector3f::Zero();
};

// A convex polygon: a triangle clipped by up to six planes.
struct Polygon {
  std::array<Corner, 9> corners;
  std::size_t count = 0;
  void add(const Corner& corner) { corners[count++] = corner; }
};

// Intersects an edge with a plane. The result does not depend on the edge's direction, so two triangles that
// share an edge are cut at the same point.
Corner between(const Corner& a, const Corner& b, Eigen::Index axis, float at) {
  const bool swapped = a.position[axis] > b.position[axis];
  const Corner& low = swapped ? b : a;
  const Corner& high = swapped ? a : b;
  const float t =
      std::clamp((at - low.position[axis]) / (high.position[axis] - low.position[axis]), 0.0F, 1.0F);
  Corner cut;
  cut.position = low.position + t * (high.position - low.position);
  cut.position[axis] = at;
  cut.normal = low.normal + t * (high.normal - low.normal);
  cut.colour = low.colour + t * (high.colour - low.colour);
  return cut;
}

// Splits a polygon at a plane across an axis.
void part(const Polygon& polygon, Eigen::Index axis, float at, Polygon& below, Polygon& above) {
  below.count = above.count = 0;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const Corner& here = polygon.corners[i];
    const Corner& next = polygon.corners[(i + 1) % polygon.count];
    const float side = here.position[axis] - at;
    const float next_side = next.position[axis] - at;
    if (side <= 0.0F) below.add(here);
    if (side >= 0.0F) above.add(here);
    if ((side < 0.0F && next_side > 0.0F) || (side > 0.0F && next_side < 0.0F)) {
      const Corner cut = between(here, next, axis, at);
      below.add(cut);
      above.add(cut);
    }
  }
}

class Cutter {
 public:
  Cutter(const Mesh& mesh, const Eigen::AlignedBox3d& box_world)
      : mesh_(mesh),
        low_((box_world.min() - mesh.origin).cast<float>()),
        high_((box_world.max() - mesh.origin).cast<float>()),
        has_normals_(mesh.normals.size() == mesh.vertices.size()),
        has_colours_(mesh.colours.size() == mesh.vertices.size()) {
    out_.origin = mesh.origin;
    out_.vertices = mesh.vertices;
    if (has_normals_) out_.normals = mesh.normals;
    if (has_colours_) out_.colours = mesh.colours;
    out_.triangles.reserve(mesh.triangles.size());
  }

  Mesh cut() {
    for (const Triangle& triangle : mesh_.triangles) {
      const Eigen::Vector3f &a = mesh_.vertices[triangle[0]], &b = mesh_.vertices[triangle[1]],
                            &c = mesh_.vertices[triangle[2]];
      const Eigen::Vector3f least = a.cwiseMin(b).cwiseMin(c), most = a.cwiseMax(b).cwiseMax(c);
      if ((most.array() <= low_.array()).any() || (least.array() >= high_.array()).any())
        out_.triangles.push_back(triangle);
      else
        cut(triangle);
    }
    drop_unused_vertices(out_);
    return std::move(out_);
  }

 private:
  void cut(const Triangle& triangle) {
    Polygon inside;
    for (const std::uint32_t v : triangle) {
      Corner corner;
      corner.position = mesh_.vertices[v];
      if (has_normals_) corner.normal = mesh_.normals[v];
      if (has_colours_) {
        const Rgb colour = mesh_.colours[v];
        corner.colour = Eigen::Vector3f(colour.r, colour.g, colour.b);
      }
      inside.add(corner);
    }
    Polygon below, above;
    for (Eigen::Index axis = 0; axis < 3 && inside.count > 2; ++axis) {
      part(inside, axis, low_[axis], below, above);
      keep(below);
      inside = above;
      part(inside, axis, high_[axis], below, above);
      keep(above);
      inside = below;
    }
  }

  void keep(const Polygon& polygon) {
    if (polygon.count < 3) return;
    const auto first = static_cast<std::uint32_t>(out_.vertices.size());
    for (std::size_t i = 0; i < polygon.count; ++i) {
      const Corner& corner = polygon.corners[i];
      out_.vertices.push_back(corner.position);
      if (has_normals_) out_.normals.push_back(corner.normal.normalized());
      if (has_colours_) {
        const auto channel = [](float value) {
          return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F)));
        };
        out_.colours.push_back(
            {channel(corner.colour.x()), channel(corner.colour.y()), channel(corner.colour.z())});
      }
    }
    for (std::uint32_t i = 2; i < polygon.count; ++i)
      out_.triangles.push_back({first, first + i - 1, first + i});
  }

  const Mesh& mesh_;
  Eigen::Vector3f low_, high_;
  bool has_normals_, has_colours_;
  Mesh out_;
};

// Appends a mesh to another; keeps normals and colours only if both have them.
void append(const Mesh& patch, Mesh& mesh) {
  const bool normals = mesh.normals.size() == mesh.vertices.size() && !patch.normals.empty();
  const bool colours = mesh.colours.size() == mesh.vertices.size() && !patch.colours.empty();
  const Eigen::Vector3d shift = patch.origin - mesh.origin;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector3f& v : patch.vertices)
    mesh.vertices.emplace_back((v.cast<double>() + shift).cast<float>());
  if (normals)
    mesh.normals.insert(mesh.normals.end(), patch.normals.begin(), patch.normals.end());
  else
    mesh.normals.clear();
  if (colours)
    mesh.colours.insert(mesh.colours.end(), patch.colours.begin(), patch.colours.end());
  else
    mesh.colours.clear();
  for (const Triangle& t : patch.triangles)
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

}  // namespace

Mesh clip_outside(const Mesh& mesh, const Eigen::AlignedBox3d& box_world) {
  if (box_world.isEmpty()) return mesh;
  return Cutter(mesh, box_world).cut();
}

void update_surface(const StaticMap& map, const Eigen::AlignedBox3d& box_world, const SurfaceConfig& config,
                    Mesh& mesh) {
  if (box_world.isEmpty()) return;
  const Mesh patch = extract_surface(map, box_world, config);
  mesh = clip_outside(mesh, box_world);
  if (patch.triangles.empty()) return;
  if (mesh.vertices.empty()) {
    mesh = patch;
    return;
  }
  append(patch, mesh);
}

}  // namespace roomradar
