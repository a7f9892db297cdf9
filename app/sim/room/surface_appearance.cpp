// surface_appearance.cpp: computes textures and lighting where they are first seen, and samples them.
#include "app/sim/room/surface_appearance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/sim/room/room_parts.hpp"

namespace roomradar {
namespace {

using Eigen::Vector3d;

constexpr int kCylinderSide = 6;
constexpr double kLightCell_m = 0.05;
constexpr double kGamma = 2.2;
constexpr float kNotLit = -1.0F;  ///< node of a face's light that was not needed yet

int face_of(const Solid& solid, const Vector3d& normal) {
  if (solid.shape == SolidShape::kCylinder && std::abs(normal.z()) < 0.707) return kCylinderSide;
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return 2 * axis + (normal[axis] < 0.0 ? 1 : 0);
}

/// Returns face coordinates (m) of a point in the solid's frame: u to the right as seen from outside, v up
/// (z) on side faces.
Eigen::Vector2d on_face(const Solid& solid, int face, const Vector3d& p) {
  switch (face) {
    case 0:
      return {p.y(), p.z()};
    case 1:
      return {-p.y(), p.z()};
    case 2:
      return {-p.x(), p.z()};
    case 3:
      return {p.x(), p.z()};
    case 4:
      return {p.x(), p.y()};
    case 5:
      return {p.x(), -p.y()};
    default:
      return {std::atan2(p.y(), p.x()) * bounds_half_m(solid).x(), p.z()};
  }
}

Eigen::Vector2d face_half_m(const Solid& solid, int face) {
  const Vector3d half = bounds_half_m(solid);
  if (face == kCylinderSide) return {std::numbers::pi * half.x(), half.z()};
  if (face < 2) return {half.y(), half.z()};
  if (face < 4) return {half.x(), half.z()};
  return {half.x(), half.y()};
}

/// Returns the surface point at (u, v) of a face: inverse of on_face(), projected onto rounded edges.
Vector3d from_face(const Solid& solid, int face, double u, double v) {
  const Vector3d half = bounds_half_m(solid);
  Vector3d p;
  switch (face) {
    case 0:
      p = {half.x(), u, v};
      break;
    case 1:
      p = {-half.x(), -u, v};
      break;
    case 2:
      p = {-u, half.y(), v};
      break;
    case 3:
      p = {u, -half.y(), v};
      break;
    case 4:
      p = {u, v, half.z()};
      break;
    case 5:
      p = {u, -v, -half.z()};
      break;
    default:
      p = {half.x() * std::cos(u / half.x()), half.x() * std::sin(u / half.x()), v};
      break;
  }
  return p - signed_distance_local_m(solid, p) * normal_local(solid, p);
}

/// Returns true if the face is invisible inside the room: the outside of a wall, the bottom of a cupboard,
/// the side of a book between books. Tests a grid of points; a partly visible face counts as visible.
bool is_covered(const Room& room, const Solid& solid, int face) {
  constexpr int kGrid = 8;
  constexpr double kBefore_m = 0.001;
  const Eigen::Vector2d half = face_half_m(solid, face);
  for (int i = 0; i <= kGrid; ++i)
    for (int j = 0; j <= kGrid; ++j) {
      const auto inside = [](int at, double half_m) { return half_m * 0.98 * (2.0 * at / kGrid - 1.0); };
      const Vector3d p = from_face(solid, face, inside(i, half.x()), inside(j, half.y()));
      const Vector3d before_world = solid.T_world_solid * Vector3d(p + kBefore_m * normal_local(solid, p));
      if ((before_world - room.interior_min_world).minCoeff() > 0.0 &&
          (room.interior_max_world - before_world).minCoeff() > 0.0 &&
          signed_distance_m(room, before_world) > 0.0)
        return false;
    }
  return true;
}

std::uint8_t to_byte(float of) {
  return static_cast<std::uint8_t>(std::clamp(of, 0.0F, 1.0F) * 255.0F + 0.5F);
}

/// Returns the next coarser mip level, half as wide and high.
template <typename Level>
Level halved(const Level& fine) {
  Level coarse;
  coarse.width = fine.width / 2;
  coarse.height = fine.height / 2;
  for (int y = 0; y < coarse.height; ++y)
    for (int x = 0; x < coarse.width; ++x) {
      const Rgb* a = fine.texels.data() + static_cast<std::ptrdiff_t>(2 * y) * fine.width + 2 * x;
      const Rgb* b = a + fine.width;
      const auto mean = [](int p, int q, int r, int s) {
        return static_cast<std::uint8_t>((p + q + r + s + 2) / 4);
      };
      coarse.texels.push_back({mean(a[0].r, a[1].r, b[0].r, b[1].r), mean(a[0].g, a[1].g, b[0].g, b[1].g),
                               mean(a[0].b, a[1].b, b[0].b, b[1].b)});
    }
  return coarse;
}

/// Sample points of a lamp, in its unit ball.
constexpr double kLampPoints[6][3] = {{0.8, 0.2, 0.1},  {-0.5, 0.6, -0.2}, {-0.3, -0.8, 0.2},
                                      {0.2, 0.1, -0.8}, {0.4, -0.5, 0.4},  {-0.3, 0.2, 0.7}};

}  // namespace

SurfaceAppearance::SurfaceAppearance(const Room& room, double texel_m)
    : room_(room),
      texel_m_(texel_m),
      is_lit_(true),
      solids_(room.solids),
      materials_(room.materials),
      faces_(room.solids.size() * kFaces) {}

SurfaceAppearance::SurfaceAppearance(const Room& room, std::span<const Solid> solids,
                                     std::span<const Material> materials, double texel_m)
    : room_(room),
      texel_m_(texel_m),
      is_lit_(false),
      solids_(solids.begin(), solids.end()),
      materials_(materials.begin(), materials.end()),
      faces_(solids.size() * kFaces) {}

void SurfaceAppearance::prepare(std::size_t index, int face_index, Face& face) const {
  face.is_prepared = true;
  const Solid& solid = solids_[index];
  if (is_lit_ && is_covered(room_, solid, face_index)) return;
  const Eigen::Vector2d half = face_half_m(solid, face_index);
  face.width_m = static_cast<float>(2.0 * half.x());
  face.height_m = static_cast<float>(2.0 * half.y());
  // Walls and floors are rarely seen from as near as 1 m.
  face.texel_m = static_cast<float>(half.minCoeff() > 1.0 ? 1.5 * texel_m_ : texel_m_);
  Level level;
  level.width = std::max(1, static_cast<int>(std::ceil(face.width_m / face.texel_m)));
  level.height = std::max(1, static_cast<int>(std::ceil(face.height_m / face.texel_m)));
  level.texels.reserve(static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height));
  for (int y = 0; y < level.height; ++y)
    for (int x = 0; x < level.width; ++x) {
      const float u_m =
          ((static_cast<float>(x) + 0.5F) / static_cast<float>(level.width) - 0.5F) * face.width_m;
      const float v_m =
          ((static_cast<float>(y) + 0.5F) / static_cast<float>(level.height) - 0.5F) * face.height_m;
      const auto colour = pattern_colour(materials_[index], u_m, v_m, face.width_m, face.height_m);
      level.texels.push_back({to_byte(colour[0]), to_byte(colour[1]), to_byte(colour[2])});
    }
  face.levels.push_back(std::move(level));
  while (face.levels.back().width > 1 && face.levels.back().height > 1)
    face.levels.push_back(halved(face.levels.back()));
  if (!is_lit_) return;
  const auto nodes = [](float extent_m) {
    return std::clamp(static_cast<int>(extent_m / kLightCell_m) + 2, 3, 160);
  };
  face.light_columns = nodes(face.width_m);
  face.light_rows = nodes(face.height_m);
  face.light.resize(static_cast<std::size_t>(face.light_columns) * static_cast<std::size_t>(face.light_rows),
                    kNotLit);
}

float SurfaceAppearance::light_of(std::size_t index, int face_index, Face& face, int column, int row) const {
  const Solid& solid = solids_[index];
  float& light = face.light[static_cast<std::size_t>(row) * static_cast<std::size_t>(face.light_columns) +
                            static_cast<std::size_t>(column)];
  if (light != kNotLit) return light;
  // Nodes on a face's edge are moved slightly inside, where adjacent solids do not cover them.
  const auto inside = [](int i, int n, float extent_m) {
    const double edge_m = std::min(0.004, 0.05 * extent_m);
    return std::clamp((static_cast<double>(i) / (n - 1) - 0.5) * extent_m, -0.5 * extent_m + edge_m,
                      0.5 * extent_m - edge_m);
  };
  const Vector3d p = from_face(solid, face_index, inside(column, face.light_columns, face.width_m),
                               inside(row, face.light_rows, face.height_m));
  light = light_at(solid.T_world_solid * p, solid.T_world_solid.linear() * normal_local(solid, p), true,
                   part_of_solid(room_, index));
  return light;
}

float SurfaceAppearance::light_at(const Vector3d& p_world, const Vector3d& normal_world, bool shadows,
                                  int part) const {
  constexpr double kSkin_m = 0.001;
  const Vector3d start = p_world + kSkin_m * normal_world;
  double open = 1.0;
  if (shadows) {
    constexpr double kReaches_m[] = {0.03, 0.09, 0.25, 0.5};
    double closed = 0.0;
    for (const double reach_m : kReaches_m)
      closed += 0.25 * std::clamp(1.0 - signed_distance_m(room_, p_world + reach_m * normal_world) / reach_m,
                                  0.0, 1.0);
    open = 1.0 - 0.85 * closed;
  }
  // Ambient light, slightly stronger from above.
  double light = (0.28 + 0.07 * normal_world.z()) * open;
  const auto add_lamp = [&](const Lamp& lamp) {
    double seen = 0.0;
    for (const auto& [x, y, z] : kLampPoints) {
      const Vector3d lamp_world = lamp.position_world + lamp.radius_m * Vector3d(x, y, z);
      const Vector3d way = lamp_world - start;
      const double facing = normal_world.dot(way);
      if (facing <= 0.0 || (shadows && room_.tree.is_blocked(room_.solids, start, lamp_world))) continue;
      const double squared_m2 = std::max(way.squaredNorm(), 0.1);
      seen += facing / (squared_m2 * std::sqrt(squared_m2));
    }
    light += 0.37 * lamp.power * seen / 6.0 * (0.6 + 0.4 * open);
  };
  if (part < 0) {
    for (const Lamp& lamp : room_.lamps) add_lamp(lamp);
  } else {
    for (const int lamp : room_.parts[static_cast<std::size_t>(part)].lamps)
      add_lamp(room_.lamps[static_cast<std::size_t>(lamp)]);
  }
  return static_cast<float>(std::pow(light, 1.0 / kGamma));
}

Rgb SurfaceAppearance::shade(std::size_t index, const Vector3d& p_solid, const Vector3d& normal_solid,
                             double footprint_m, const Eigen::Isometry3d& T_world_solid) {
  const Solid& solid = solids_[index];
  const int face_index = face_of(solid, normal_solid);
  Face& face = faces_[index * kFaces + static_cast<std::size_t>(face_index)];
  if (!face.is_prepared) prepare(index, face_index, face);
  if (face.levels.empty()) return {};
  const Eigen::Vector2d uv = on_face(solid, face_index, p_solid);
  const float u = std::clamp(static_cast<float>(uv.x()) / face.width_m + 0.5F, 0.0F, 1.0F);
  const float v = std::clamp(static_cast<float>(uv.y()) / face.height_m + 0.5F, 0.0F, 1.0F);

  const int wanted = std::max(0, std::ilogb(std::max(footprint_m / face.texel_m, 1.0)));
  const Level& level = face.levels[std::min(static_cast<std::size_t>(wanted), face.levels.size() - 1)];
  const float x =
      std::clamp(u * static_cast<float>(level.width) - 0.5F, 0.0F, static_cast<float>(level.width - 1));
  const float y =
      std::clamp(v * static_cast<float>(level.height) - 0.5F, 0.0F, static_cast<float>(level.height - 1));
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const float ax = x - static_cast<float>(x0), ay = y - static_cast<float>(y0);
  const Rgb* top = level.texels.data() + static_cast<std::ptrdiff_t>(y0) * level.width + x0;
  const int right = x0 + 1 < level.width ? 1 : 0;
  const Rgb* low = top + (y0 + 1 < level.height ? level.width : 0);

  float light = 0.0F;
  if (face.light.empty()) {
    const Vector3d p_world = T_world_solid * p_solid;
    light = light_at(p_world, T_world_solid.linear() * normal_solid, false, part_at(room_, p_world));
  } else {
    const float lx = u * static_cast<float>(face.light_columns - 1),
                ly = v * static_cast<float>(face.light_rows - 1);
    const int lx0 = std::min(static_cast<int>(lx), face.light_columns - 2),
              ly0 = std::min(static_cast<int>(ly), face.light_rows - 2);
    const float bx = lx - static_cast<float>(lx0), by = ly - static_cast<float>(ly0);
    const auto node = [&](int dx, int dy) { return light_of(index, face_index, face, lx0 + dx, ly0 + dy); };
    light =
        (1 - by) * ((1 - bx) * node(0, 0) + bx * node(1, 0)) + by * ((1 - bx) * node(0, 1) + bx * node(1, 1));
  }
  const auto channel = [&](std::uint8_t Rgb::*of) {
    const float mean = (1 - ay) * ((1 - ax) * top[0].*of + ax * top[right].*of) +
                       ay * ((1 - ax) * low[0].*of + ax * low[right].*of);
    return static_cast<std::uint8_t>(std::min(mean * light + 0.5F, 255.0F));
  };
  return {channel(&Rgb::r), channel(&Rgb::g), channel(&Rgb::b)};
}

}  // namespace roomradar
