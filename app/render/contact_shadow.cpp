// contact_shadow.cpp: tabulates and samples ambient occlusion by an object's underside.
#include "app/render/contact_shadow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "mapping/types/validity.hpp"

namespace roomradar {
namespace {

constexpr int kPoints = 8000;
constexpr float kSpread = 1.0F;  // table extent beyond and below the footprint, over its longer side
// Max height of shadowed points above the object's lowest point: a noisy surface may reach this high.
constexpr float kAboveBottom_m = 0.04F;
constexpr float kFadeAbove_m = 0.02F;
// fractions of extent_m
constexpr std::array<float, 8> kLevels = {0.0F, 0.02F, 0.05F, 0.1F, 0.2F, 0.4F, 0.7F, 1.0F};
constexpr float kNothing = std::numeric_limits<float>::infinity();

/// A patch of the underside: its centre relative to the table's first cell, and its height above the lowest
/// point.
struct Patch {
  float x_m, y_m, height_m;
};

/// Returns the lowest point over each cell, if there is one.
std::vector<Patch> underside(const std::vector<Eigen::Vector3f>& points, const ContactShadow& table) {
  std::vector<float> lowest_m(static_cast<std::size_t>(table.columns) * static_cast<std::size_t>(table.rows),
                              kNothing);
  for (const Eigen::Vector3f& p : points) {
    const int i =
        std::clamp(static_cast<int>(std::lround((p.x() - table.x0_m) / table.cell_m)), 0, table.columns - 1);
    const int j =
        std::clamp(static_cast<int>(std::lround((p.y() - table.y0_m) / table.cell_m)), 0, table.rows - 1);
    float& lowest = lowest_m[static_cast<std::size_t>(j) * static_cast<std::size_t>(table.columns) +
                             static_cast<std::size_t>(i)];
    lowest = std::min(lowest, p.z());
  }
  std::vector<Patch> patches;
  for (int j = 0; j < table.rows; ++j) {
    for (int i = 0; i < table.columns; ++i) {
      const float lowest = lowest_m[static_cast<std::size_t>(j) * static_cast<std::size_t>(table.columns) +
                                    static_cast<std::size_t>(i)];
      if (lowest < kNothing)
        patches.push_back({static_cast<float>(i) * table.cell_m, static_cast<float>(j) * table.cell_m,
                           lowest - table.bottom_m});
    }
  }
  return patches;
}

/// Fades to 0 over the outer fifth of the table, so that the shadow has no edge.
float window(int i, int count) {
  const float from_edge = static_cast<float>(std::min(i, count - 1 - i)) / static_cast<float>(count);
  return std::clamp(from_edge / 0.1F, 0.0F, 1.0F);
}

/// Returns the form factor of a small horizontal patch of the underside, seen from a horizontal point below.
float form_factor(float dx_m, float dy_m, float h_m, float area_m2) {
  const float d2 = dx_m * dx_m + dy_m * dy_m + h_m * h_m;
  return h_m * h_m * area_m2 / (std::numbers::pi_v<float> * d2 * d2);
}

/// Adds a patch's form factors at a row of horizontal points, clearance_m below the lowest point. For points
/// close to the patch relative to its size, the patch is split into nine pieces.
void add_patch(const Patch& patch, float y_m, float clearance_m, float cell_m, std::span<float> row) {
  const float area_m2 = cell_m * cell_m;
  const float third_m = cell_m / 3.0F;
  const float dy = patch.y_m - y_m;
  const float h = patch.height_m + clearance_m;
  const float near_squared_m2 = 9.0F * area_m2 - dy * dy - h * h;
  for (std::size_t i = 0; i < row.size(); ++i)
    row[i] += form_factor(patch.x_m - static_cast<float>(i) * cell_m, dy, h, area_m2);
  if (near_squared_m2 <= 0.0F) return;
  const float reach_m = std::sqrt(near_squared_m2);
  const auto first = static_cast<std::size_t>(std::max(0.0F, std::ceil((patch.x_m - reach_m) / cell_m)));
  const auto end = std::min(row.size(), static_cast<std::size_t>((patch.x_m + reach_m) / cell_m) + 1);
  for (std::size_t i = first; i < end; ++i) {
    const float dx = patch.x_m - static_cast<float>(i) * cell_m;
    float pieces = 0.0F;
    for (const float v : {-third_m, 0.0F, third_m})
      for (const float u : {-third_m, 0.0F, third_m})
        pieces += form_factor(dx + u, dy + v, h, area_m2 / 9.0F);
    row[i] += pieces - form_factor(dx, dy, h, area_m2);
  }
}

}  // namespace

SurfacePoints spread_points(const Mesh& mesh) {
  SurfacePoints spread;
  const auto corner = [&](std::uint32_t index) -> Eigen::Vector3f {
    return mesh.origin.cast<float>() + mesh.vertices[index];
  };
  const auto area_m2 = [&](const Triangle& triangle) {
    const Eigen::Vector3f a = corner(triangle[0]);
    return 0.5 * static_cast<double>((corner(triangle[1]) - a).cross(corner(triangle[2]) - a).norm());
  };
  double total_m2 = 0.0;
  for (const Triangle& triangle : mesh.triangles)
    if (is_usable(mesh, triangle)) total_m2 += area_m2(triangle);
  if (!(total_m2 > 0.0)) return spread;

  // One point per 1/kPoints of the area, in the order of the triangles, at quasirandom positions within them.
  // Source: Roberts, The unreasonable effectiveness of quasirandom sequences, 2018 (R2).
  constexpr double kStepU = 0.7548776662466927, kStepV = 0.5698402909980532;
  spread.p_object_m.reserve(kPoints + 1);
  double owed = 0.5, u = 0.5, v = 0.5;
  for (const Triangle& triangle : mesh.triangles) {
    if (!is_usable(mesh, triangle)) continue;
    const Eigen::Vector3f a = corner(triangle[0]), b = corner(triangle[1]), c = corner(triangle[2]);
    for (owed += kPoints * area_m2(triangle) / total_m2; owed >= 1.0; owed -= 1.0) {
      u = std::fmod(u + kStepU, 1.0);
      v = std::fmod(v + kStepV, 1.0);
      const bool is_past = u + v > 1.0;  // in the other half of the parallelogram
      spread.p_object_m.emplace_back(a + static_cast<float>(is_past ? 1.0 - u : u) * (b - a) +
                                     static_cast<float>(is_past ? 1.0 - v : v) * (c - a));
    }
  }
  Eigen::AlignedBox3f bounds;
  for (const Eigen::Vector3f& p : spread.p_object_m) bounds.extend(p);
  if (!bounds.isEmpty()) spread.middle_object_m = bounds.center().cast<double>();
  return spread;
}

void make_contact_shadow(const SurfacePoints& object, const Eigen::Matrix3d& R_world_object,
                         ContactShadow& shadow, int cells_across) {
  shadow.R_world_object = R_world_object;
  shadow.middle_object_m = object.middle_object_m;
  shadow.cells_across = cells_across;
  shadow.columns = shadow.rows = 0;
  shadow.clearances_m.clear();
  shadow.covered.clear();
  const Eigen::Matrix3f R = R_world_object.cast<float>();
  std::vector<Eigen::Vector3f> turned;
  turned.reserve(object.p_object_m.size());
  Eigen::AlignedBox3f bounds;
  for (const Eigen::Vector3f& p : object.p_object_m) bounds.extend(turned.emplace_back(R * p));
  if (bounds.isEmpty() || !(bounds.sizes().maxCoeff() > 0.0F)) return;

  const float longer_side_m = std::max(bounds.sizes().head<2>().maxCoeff(), 0.1F * bounds.sizes().z());
  const float spread_m = kSpread * longer_side_m;
  const auto cells = [&](float side_m) {
    return static_cast<int>(std::ceil((side_m + 2.0F * spread_m) / shadow.cell_m)) + 1;
  };
  shadow.cell_m = longer_side_m / static_cast<float>(cells_across);
  // Cells are aligned with the object's bounds; shifted by half a cell they would enlarge it.
  shadow.x0_m = bounds.min().x() - spread_m + 0.5F * shadow.cell_m;
  shadow.y0_m = bounds.min().y() - spread_m + 0.5F * shadow.cell_m;
  shadow.columns = cells(bounds.sizes().x());
  shadow.rows = cells(bounds.sizes().y());
  shadow.bottom_m = bounds.min().z();
  shadow.height_m = bounds.sizes().z();
  shadow.extent_m = spread_m;
  const std::vector<Patch> patches = underside(turned, shadow);

  const float least_clearance_m = 0.4F * shadow.cell_m;  // closer, a patch's pieces would become visible
  const auto row_length = static_cast<std::size_t>(shadow.columns);
  for (const float level : kLevels) {
    shadow.clearances_m.push_back(level * shadow.extent_m);
    const float clearance_m = std::max(shadow.clearances_m.back(), least_clearance_m);
    for (int j = 0; j < shadow.rows; ++j) {
      shadow.covered.resize(shadow.covered.size() + row_length, 0.0F);
      const float edge_y = level < 1.0F ? window(j, shadow.rows) : 0.0F;
      if (edge_y == 0.0F) continue;
      const std::span<float> row(shadow.covered.end() - static_cast<std::ptrdiff_t>(row_length), row_length);
      for (const Patch& patch : patches)
        add_patch(patch, static_cast<float>(j) * shadow.cell_m, clearance_m, shadow.cell_m, row);
      for (int i = 0; i < shadow.columns; ++i) {
        float& covered = row[static_cast<std::size_t>(i)];
        covered = std::min(covered, 1.0F) * edge_y * window(i, shadow.columns);
      }
    }
  }
}

Eigen::Vector3d origin_world(const ContactShadow& shadow, const Eigen::Isometry3d& T_world_object) {
  return T_world_object * shadow.middle_object_m - shadow.R_world_object * shadow.middle_object_m;
}

float ambient_occlusion(const ContactShadow& shadow, const Eigen::Vector3f& p_object_m) {
  if (shadow.covered.empty()) return 0.0F;
  const float clearance_m = shadow.bottom_m - p_object_m.z();
  const float u = (p_object_m.x() - shadow.x0_m) / shadow.cell_m;
  const float v = (p_object_m.y() - shadow.y0_m) / shadow.cell_m;
  const bool is_inside = u >= 0.0F && v >= 0.0F && u < static_cast<float>(shadow.columns - 1) &&
                         v < static_cast<float>(shadow.rows - 1) && clearance_m < shadow.extent_m &&
                         clearance_m > -kAboveBottom_m;
  if (!is_inside) return 0.0F;

  const int i = static_cast<int>(u);
  const int j = static_cast<int>(v);
  const float a = u - static_cast<float>(i);
  const float b = v - static_cast<float>(j);
  const std::size_t layer_size =
      static_cast<std::size_t>(shadow.columns) * static_cast<std::size_t>(shadow.rows);
  const auto in_level = [&](std::size_t level) {
    const float* cell = shadow.covered.data() + level * layer_size +
                        static_cast<std::size_t>(j) * static_cast<std::size_t>(shadow.columns) +
                        static_cast<std::size_t>(i);
    return (1.0F - b) * ((1.0F - a) * cell[0] + a * cell[1]) +
           b * ((1.0F - a) * cell[shadow.columns] + a * cell[shadow.columns + 1]);
  };
  if (clearance_m <= 0.0F) {
    const float fade = (clearance_m + kAboveBottom_m) / kFadeAbove_m;
    return std::min(fade, 1.0F) * in_level(0);
  }
  std::size_t upper = 1;
  while (upper + 1 < shadow.clearances_m.size() && shadow.clearances_m[upper] < clearance_m) ++upper;
  const float low_m = shadow.clearances_m[upper - 1];
  const float high_m = shadow.clearances_m[upper];
  const float part = std::clamp((clearance_m - low_m) / (high_m - low_m), 0.0F, 1.0F);
  return (1.0F - part) * in_level(upper - 1) + part * in_level(upper);
}

float light_occlusion(const ContactShadow& shadow, const Eigen::Vector3f& p_object_m,
                      const Eigen::Vector3f& to_light) {
  constexpr int kSteps = 6;
  constexpr float kSoft = 0.04F;    // clearance at which the outline is looked up, fraction of extent_m
  constexpr float kBeside = 0.25F;  // around the object where its outline is still seen, fraction of extent_m
  constexpr float kWhole = 0.6F;    // occlusion of the sky, this close to the underside, that hides the light
  if (shadow.covered.empty() || !(to_light.z() > kLowestLight)) return 0.0F;
  const float clearance_m = shadow.bottom_m - p_object_m.z();
  if (clearance_m > shadow.extent_m || clearance_m < -kAboveBottom_m) return 0.0F;
  const Eigen::Vector2f shift = to_light.head<2>() / to_light.z();  // per metre of height
  // The way to the light, up to the object's top, must pass near the object.
  const float first_m = std::max(clearance_m, 0.0F), last_m = first_m + 0.9F * shadow.height_m;
  const Eigen::Array2f a = p_object_m.head<2>() + first_m * shift, b = p_object_m.head<2>() + last_m * shift;
  const Eigen::Array2f corner(shadow.x0_m, shadow.y0_m);
  const Eigen::Array2f size =
      shadow.cell_m * Eigen::Array2f(static_cast<float>(shadow.columns), static_cast<float>(shadow.rows));
  const float beside_m = (1.0F - kBeside) * shadow.extent_m;
  if ((a.max(b) < corner + beside_m).any() || (a.min(b) > corner + size - beside_m).any()) return 0.0F;
  const float lookup_z_m = shadow.bottom_m - kSoft * shadow.extent_m;
  float most = 0.0F;
  for (int i = 0; i <= kSteps; ++i) {
    const float up_m = first_m + (last_m - first_m) * static_cast<float>(i) / static_cast<float>(kSteps);
    const Eigen::Vector2f at = p_object_m.head<2>() + up_m * shift;
    most = std::max(most, ambient_occlusion(shadow, {at.x(), at.y(), lookup_z_m}));
  }
  const float fade = clearance_m < 0.0F ? std::min(1.0F, (clearance_m + kAboveBottom_m) / kFadeAbove_m)
                                        : 1.0F - clearance_m / shadow.extent_m;
  return fade * std::min(most / kWhole, 1.0F);
}

}  // namespace roomradar
