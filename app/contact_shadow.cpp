// contact_shadow.cpp: tabulate how much of the sky an object's underside takes, and look it up.
#include "app/contact_shadow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace roomradar {
namespace {

// Along the longer side: a cell of a 25 cm teapot is 1 cm, a shadow is soft.
constexpr int kUndersideCells = 24;
constexpr double kSpread = 1.0;  // the table reaches this many longer sides past the footprint and below it
// A noisy surface may stand this much above the object's lowest point.
constexpr double kAboveBottom_m = 0.04;
constexpr double kFadeAbove_m = 0.02;
constexpr std::array<double, 8> kLevels = {0.0, 0.02, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0};  // of extent_m
constexpr float kNothing = std::numeric_limits<float>::infinity();

/// One piece of the underside: its middle relative to the table's first cell, and its height over the bottom.
struct Patch {
  float x_m, y_m, height_m;
};

/// Lowest height over each cell, by sampling triangles at the cells' middles, and vertices for what is
/// thinner.
class Underside {
 public:
  Underside(double x0_m, double y0_m, double cell_m, int columns, int rows)
      : x0_m_(x0_m),
        y0_m_(y0_m),
        cell_m_(cell_m),
        columns_(columns),
        rows_(rows),
        lowest_m_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), kNothing) {}

  void add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    for (const Eigen::Vector3d& p : {a, b, c}) lower(column(p.x()), row(p.y()), p.z());
    const double twice_area = (b - a).head<2>().dot(Eigen::Vector2d(c.y() - a.y(), a.x() - c.x()));
    if (std::abs(twice_area) < 1e-12) return;
    const auto [left, right] = std::minmax({a.x(), b.x(), c.x()});
    const auto [near, far] = std::minmax({a.y(), b.y(), c.y()});
    for (int j = row(near); j <= row(far); ++j) {
      for (int i = column(left); i <= column(right); ++i) {
        const Eigen::Vector2d p(x0_m_ + i * cell_m_ - a.x(), y0_m_ + j * cell_m_ - a.y());
        const double wb = p.dot(Eigen::Vector2d(c.y() - a.y(), a.x() - c.x())) / twice_area;
        const double wc = p.dot(Eigen::Vector2d(a.y() - b.y(), b.x() - a.x())) / twice_area;
        if (wb >= 0.0 && wc >= 0.0 && wb + wc <= 1.0)
          lower(i, j, a.z() + wb * (b.z() - a.z()) + wc * (c.z() - a.z()));
      }
    }
  }
  [[nodiscard]] std::vector<Patch> patches(double bottom_m) const {
    std::vector<Patch> result;
    for (int j = 0; j < rows_; ++j) {
      for (int i = 0; i < columns_; ++i) {
        const float lowest = lowest_m_[index(i, j)];
        if (lowest == kNothing) continue;
        result.push_back({static_cast<float>(i * cell_m_), static_cast<float>(j * cell_m_),
                          lowest - static_cast<float>(bottom_m)});
      }
    }
    return result;
  }

 private:
  [[nodiscard]] std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i);
  }
  [[nodiscard]] int column(double x_m) const {
    return std::clamp(static_cast<int>(std::lround((x_m - x0_m_) / cell_m_)), 0, columns_ - 1);
  }
  [[nodiscard]] int row(double y_m) const {
    return std::clamp(static_cast<int>(std::lround((y_m - y0_m_) / cell_m_)), 0, rows_ - 1);
  }
  void lower(int i, int j, double z_m) {
    float& lowest = lowest_m_[index(i, j)];
    lowest = std::min(lowest, static_cast<float>(z_m));
  }

  double x0_m_, y0_m_, cell_m_;
  int columns_, rows_;
  std::vector<float> lowest_m_;
};

/// Goes to 0 over the outer fifth of the table, so that the shadow has no edge.
float window(int i, int count) {
  const float from_edge = static_cast<float>(std::min(i, count - 1 - i)) / static_cast<float>(count);
  return std::clamp(from_edge / 0.1F, 0.0F, 1.0F);
}

/// Form factor of a small level piece of the underside, as a level point below sees it.
float form_factor(float dx_m, float dy_m, float h_m, float area_m2) {
  const float d2 = dx_m * dx_m + dy_m * dy_m + h_m * h_m;
  return h_m * h_m * area_m2 / (std::numbers::pi_v<float> * d2 * d2);
}

/// Sum of the patches' form factors at a level point (x, y) that is clearance_m below the bottom. A patch
/// that is near against its size is taken in nine pieces.
float covered_at(const std::vector<Patch>& patches, float x_m, float y_m, float clearance_m, float cell_m) {
  const float area_m2 = cell_m * cell_m;
  const float third_m = cell_m / 3.0F;
  float sum = 0.0F;
  for (const Patch& patch : patches) {
    const float dx = patch.x_m - x_m;
    const float dy = patch.y_m - y_m;
    const float h = patch.height_m + clearance_m;
    if (dx * dx + dy * dy + h * h > 9.0F * area_m2) {
      sum += form_factor(dx, dy, h, area_m2);
      continue;
    }
    for (const float v : {-third_m, 0.0F, third_m})
      for (const float u : {-third_m, 0.0F, third_m}) sum += form_factor(dx + u, dy + v, h, area_m2 / 9.0F);
  }
  return std::min(sum, 1.0F);
}

}  // namespace

ContactShadow make_contact_shadow(const Mesh& mesh, const Eigen::Matrix3d& R_world_object) {
  ContactShadow shadow;
  const auto placed = [&](std::uint32_t index) -> Eigen::Vector3d {
    return R_world_object * (mesh.origin + mesh.vertices[index].cast<double>());
  };
  const auto is_usable = [&](const Triangle& triangle) {
    return std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t index) {
      return index < mesh.vertices.size() && mesh.vertices[index].allFinite();
    });
  };
  Eigen::AlignedBox3d bounds;
  for (const Triangle& triangle : mesh.triangles)
    if (is_usable(triangle))
      for (const std::uint32_t index : triangle) bounds.extend(placed(index));
  if (bounds.isEmpty() || !(bounds.sizes().maxCoeff() > 0.0)) return shadow;

  const double longer_side_m = std::max(bounds.sizes().head<2>().maxCoeff(), 0.1 * bounds.sizes().z());
  const double spread_m = kSpread * longer_side_m;
  shadow.cell_m = longer_side_m / kUndersideCells;
  shadow.x0_m = bounds.min().x() - spread_m;
  shadow.y0_m = bounds.min().y() - spread_m;
  shadow.columns = static_cast<int>(std::ceil((bounds.sizes().x() + 2.0 * spread_m) / shadow.cell_m)) + 1;
  shadow.rows = static_cast<int>(std::ceil((bounds.sizes().y() + 2.0 * spread_m) / shadow.cell_m)) + 1;
  shadow.bottom_m = bounds.min().z();
  shadow.extent_m = spread_m;

  Underside underside(shadow.x0_m, shadow.y0_m, shadow.cell_m, shadow.columns, shadow.rows);
  for (const Triangle& triangle : mesh.triangles)
    if (is_usable(triangle)) underside.add(placed(triangle[0]), placed(triangle[1]), placed(triangle[2]));
  const std::vector<Patch> patches = underside.patches(shadow.bottom_m);

  const float cell_m = static_cast<float>(shadow.cell_m);
  const float least_clearance_m = 0.4F * cell_m;  // nearer, the pieces of a patch would be told apart
  for (const double level : kLevels) {
    shadow.clearances_m.push_back(level * shadow.extent_m);
    const float clearance_m = std::max(static_cast<float>(shadow.clearances_m.back()), least_clearance_m);
    const float fade = level < 1.0 ? 1.0F : 0.0F;
    for (int j = 0; j < shadow.rows; ++j) {
      for (int i = 0; i < shadow.columns; ++i) {
        const float edge = window(i, shadow.columns) * window(j, shadow.rows) * fade;
        const float x_m = static_cast<float>(i) * cell_m;
        const float y_m = static_cast<float>(j) * cell_m;
        shadow.covered.push_back(edge > 0.0F ? edge * covered_at(patches, x_m, y_m, clearance_m, cell_m)
                                             : 0.0F);
      }
    }
  }
  return shadow;
}

float sky_taken(const ContactShadow& shadow, const Eigen::Vector3f& p_object_m) {
  if (shadow.covered.empty()) return 0.0F;
  const float clearance_m = static_cast<float>(shadow.bottom_m) - p_object_m.z();
  const float u = (p_object_m.x() - static_cast<float>(shadow.x0_m)) / static_cast<float>(shadow.cell_m);
  const float v = (p_object_m.y() - static_cast<float>(shadow.y0_m)) / static_cast<float>(shadow.cell_m);
  const bool is_inside = u >= 0.0F && v >= 0.0F && u < static_cast<float>(shadow.columns - 1) &&
                         v < static_cast<float>(shadow.rows - 1) &&
                         clearance_m < static_cast<float>(shadow.extent_m) &&
                         clearance_m > static_cast<float>(-kAboveBottom_m);
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
    const float fade = (clearance_m + static_cast<float>(kAboveBottom_m)) / static_cast<float>(kFadeAbove_m);
    return std::min(fade, 1.0F) * in_level(0);
  }
  std::size_t upper = 1;
  while (upper + 1 < shadow.clearances_m.size() &&
         static_cast<float>(shadow.clearances_m[upper]) < clearance_m)
    ++upper;
  const float low_m = static_cast<float>(shadow.clearances_m[upper - 1]);
  const float high_m = static_cast<float>(shadow.clearances_m[upper]);
  const float part = std::clamp((clearance_m - low_m) / (high_m - low_m), 0.0F, 1.0F);
  return (1.0F - part) * in_level(upper - 1) + part * in_level(upper);
}

}  // namespace roomradar
