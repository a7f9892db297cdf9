// dynamic_cells.cpp: discontinuities, outlines and bends, cell by cell.
#include "dynamic/surface/dynamic_cells.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "dynamic/surface/cell_outline.hpp"
#include "dynamic/surface/depth_discontinuity.hpp"

namespace roomradar {
namespace {

/// Inverse depths of a cell's 5 x 5 pixels, 1/m, row by row. Only those of dynamic pixels are valid.
using CellValues = std::array<float, 25>;

/// Returns a pixel's index in CellValues and its bit in CellBits.
constexpr int place(CellPixel p) { return 5 * p.y + p.x; }

/// Discontinuities between adjacent dynamic pixels. Bit k of `right` stands for pixel k and its right
/// neighbour, bit k of `down` for pixel k and the pixel below.
struct CellJumps {
  CellBits right = 0, down = 0;
  [[nodiscard]] bool any() const { return (right | down) != 0; }
  /// Returns true if a discontinuity separates the pixels a and b, which must be adjacent in a row or column.
  [[nodiscard]] bool between(CellPixel a, CellPixel b) const {
    const int first = std::min(place(a), place(b));
    return ((a.y == b.y ? right : down) >> first & 1U) != 0;
  }
};

constexpr CellBits kNotLastColumn = 0b01111'01111'01111'01111'01111U;

/// Returns the discontinuities between adjacent pixels of `in`.
CellJumps find_jumps(CellBits in, const CellValues& values, const DepthDiscontinuity& rule) {
  CellJumps jumps;
  for (CellBits left = in & in >> 1 & kNotLastColumn; left != 0; left &= left - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(left));
    if (!rule.is_one_surface_inverse(values[k], values[k + 1])) jumps.right |= left & -left;
  }
  for (CellBits above = in & in >> 5; above != 0; above &= above - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(above));
    if (!rule.is_one_surface_inverse(values[k], values[k + 5])) jumps.down |= above & -above;
  }
  return jumps;
}

/// Returns the pixels of `in` that are connected to the pixel of its lowest bit without crossing a
/// discontinuity.
CellBits take_surface(CellBits in, const CellJumps& jumps) {
  const CellBits can_right = in & in >> 1 & kNotLastColumn & ~jumps.right;
  const CellBits can_down = in & in >> 5 & ~jumps.down;
  CellBits surface = in & -in;
  for (CellBits before = 0; before != surface;) {
    before = surface;
    surface |= (surface & can_right) << 1 | (surface >> 1 & can_right);
    surface |= (surface & can_down) << 5 | (surface >> 5 & can_down);
  }
  return surface;
}

constexpr std::array<int, 4> kCorners{0, 4, 8, 12};  // indices into the ring

constexpr CellBits bit(int place) { return CellBits{1} << place; }
CellPixel ring(int i) { return kRing[static_cast<std::size_t>(i & 15)]; }

/// Corners of the polygon that covers an arc of the ring: the arc's ends, the cell's corners, and every pixel
/// on `busy` sides (bits: left, bottom, right, top).
struct Polygon {
  std::array<int, 16> corners;
  int count = 0;
};
Polygon polygon_of(const RingArc& arc, unsigned busy) {
  Polygon polygon;
  for (int k = 0; k < arc.count; ++k) {
    const int i = (arc.first + k) & 15;
    const bool is_end = arc.count < 16 && (k == 0 || k == arc.count - 1);
    if (is_end || i % 4 == 0 || (busy >> (i / 4) & 1U) != 0)
      polygon.corners[static_cast<std::size_t>(polygon.count++)] = i;
  }
  return polygon;
}

/// Returns true if the pixels of a surface are on the triangles of its polygon, within noise.
bool is_followed(CellBits surface, const CellValues& values, const RingArc& arc, float most) {
  const Polygon polygon = polygon_of(arc, 0);
  const CellTriangles triangles = triangulate(polygon.corners.data(), polygon.count);
  float squares = 0.0F;
  int count = 0;
  for (int t = 0; t < triangles.count; ++t) {
    const auto& corners = triangles.triangles[static_cast<std::size_t>(t)];
    const CellPixel a = ring(polygon.corners[corners[0]]), b = ring(polygon.corners[corners[1]]);
    const CellPixel c = ring(polygon.corners[corners[2]]);
    const int area = (b.y - a.y) * (c.x - a.x) - (b.x - a.x) * (c.y - a.y);
    const float per_area = 1.0F / static_cast<float>(area);
    const float at_a = values[static_cast<std::size_t>(place(a))];
    const float to_b = values[static_cast<std::size_t>(place(b))] - at_a;
    const float to_c = values[static_cast<std::size_t>(place(c))] - at_a;
    for (CellBits left = surface; left != 0; left &= left - 1) {
      const int k = std::countr_zero(left);
      const int x = k % 5 - a.x, y = k / 5 - a.y;
      const int along_b = y * (c.x - a.x) - x * (c.y - a.y);
      const int along_c = (b.y - a.y) * x - (b.x - a.x) * y;
      if (along_b < 0 || along_c < 0 || along_b + along_c > area) continue;
      const float flat =
          at_a + (static_cast<float>(along_b) * to_b + static_cast<float>(along_c) * to_c) * per_area;
      const float off = values[static_cast<std::size_t>(k)] - flat;
      squares += off * off;
      ++count;
    }
  }
  return squares <= most * most * static_cast<float>(count);
}

class CellSorter {
 public:
  CellSorter(const DynamicPixels& pixels, const DynamicLattice& lattice, const Intrinsics& camera,
             std::span<const FineBall> fine, const CellRules& rules, DynamicCells& cells)
      : pixels_(pixels),
        lattice_(lattice),
        camera_(camera),
        fine_(fine),
        rules_(rules),
        cells_(cells),
        across_(lattice.columns - 1),
        width_(static_cast<std::size_t>(pixels.smooth.width)) {}

  void sort() {
    for (int row = 0; row * kCell_px < pixels_.smooth.height; ++row) {
      for (int column = 0; column * kCell_px < pixels_.smooth.width; ++column) {
        const CellBits in = pixels_.smooth.square(column * kCell_px, row * kCell_px);
        if (in == 0) continue;
        const CellKind kind = kind_of(in, column, row);
        cells_.kinds[cell(column, row)] = kind;
        if (kind == CellKind::kFlat) {
          cells_.is_flat[cell(column, row)] = 1;
          continue;
        }
        for (const std::size_t i : corners(column, row)) cells_.must_be_vertex[i] = 1;
      }
    }
    // A flat cell beside a full one gets a vertex at every pixel on that side.
    for (int row = 0; row * kCell_px < pixels_.smooth.height; ++row) {
      for (int column = 0; column * kCell_px < pixels_.smooth.width; ++column) {
        const std::size_t i = cell(column, row);
        if (cells_.kinds[i] != CellKind::kFlat || busy_sides(column, row) == 0) continue;
        cells_.kinds[i] = CellKind::kCut;
        cells_.is_flat[i] = 0;
        cells_.parts[i] = {kWholeCell};
        for (const std::size_t corner : corners(column, row)) cells_.must_be_vertex[corner] = 1;
      }
    }
  }

  void make_triangles() {
    for (int row = 0; row + 1 < lattice_.rows; row += kSquareCells) {
      for (int column = 0; column < across_; column += kSquareCells) {
        cells_.first_triangle.push_back(static_cast<std::uint32_t>(cells_.triangles.size()));
        bool has_flat = false;
        for (int j = row; j < row + kSquareCells; ++j) {
          for (int i = column; i < column + kSquareCells; ++i) {
            const CellKind kind = cells_.kinds[cell(i, j)];
            has_flat = has_flat || kind == CellKind::kFlat;
            cells_.counts.flat += kind == CellKind::kFlat ? 1 : 0;
            cells_.counts.cut += kind == CellKind::kCut ? 1 : 0;
            cells_.counts.full += kind == CellKind::kFull ? 1 : 0;
            if (kind == CellKind::kCut) cut(i, j);
            if (kind == CellKind::kFull) fill(i, j);
          }
        }
        cells_.has_flat.push_back(has_flat ? 1 : 0);
      }
    }
    cells_.first_triangle.push_back(static_cast<std::uint32_t>(cells_.triangles.size()));
  }

 private:
  [[nodiscard]] std::size_t cell(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(across_) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] std::array<std::size_t, 4> corners(int column, int row) const {
    const std::size_t i = lattice_.index(column, row);
    const auto below = static_cast<std::size_t>(lattice_.columns);
    return {i, i + 1, i + below, i + below + 1};
  }
  [[nodiscard]] std::size_t pixel(int column, int row, CellPixel p) const {
    return static_cast<std::size_t>(row * kCell_px + p.y) * width_ +
           static_cast<std::size_t>(column * kCell_px + p.x);
  }

  CellKind kind_of(CellBits in, int column, int row) {
    const std::array<std::size_t, 4> at = corners(column, row);
    const bool is_flat = in == kWholeCell && (lattice_.is_flat[at[0]] & lattice_.is_flat[at[1]] &
                                              lattice_.is_flat[at[2]] & lattice_.is_flat[at[3]]) != 0;
    if (const FineBall* ball = fine_.empty() ? nullptr : fine_ball(in, column, row)) {
      ++cells_.fine_of_region[ball->region];
      return CellKind::kFull;
    }
    if (is_flat) return CellKind::kFlat;
    CellValues values;
    const auto [least, most] = read(in, column, row, values);
    CellJumps jumps;
    if (most - least > rules_.jump.least_jump() * least) jumps = find_jumps(in, values, rules_.jump);
    std::array<CellBits, 4>& parts = cells_.parts[cell(column, row)];
    parts = {in};
    if (jumps.any()) {
      parts = {};
      std::size_t count = 0;
      for (CellBits left = in, part; left != 0; left &= ~part) {
        part = take_surface(left, jumps);
        if (std::popcount(part) < 3) continue;  // too few for a triangle
        if (count == parts.size()) return CellKind::kFull;
        parts[count++] = part;
      }
    }
    for (const CellBits part : parts) {
      if (part != 0 && !is_cut_well(part, values, jumps)) return CellKind::kFull;
    }
    return CellKind::kCut;
  }

  /// Reads the inverse depths of the dynamic pixels; returns the least and the greatest.
  std::pair<float, float> read(CellBits in, int column, int row, CellValues& values) const {
    float least = 1e30F, most = 0.0F;
    for (; in != 0; in &= in - 1) {
      const int k = std::countr_zero(in);
      const CellPixel p{static_cast<std::int8_t>(k % 5), static_cast<std::int8_t>(k / 5)};
      const float value = pixels_.inverse_depth[pixel(column, row, p)];
      values[static_cast<std::size_t>(k)] = value;
      least = std::min(least, value);
      most = std::max(most, value);
    }
    return {least, most};
  }

  [[nodiscard]] bool is_cut_well(CellBits part, const CellValues& values, const CellJumps& jumps) const {
    RingArc arc;
    if (!find_outline(part, arc)) return false;
    if (jumps.any()) {
      for (int k = 0; k + 1 < arc.count + (arc.count == 16 ? 1 : 0); ++k) {
        if (jumps.between(ring(arc.first + k), ring(arc.first + k + 1))) return false;
      }
    }
    float least = 1e30F, most = 0.0F;
    for (CellBits left = part; left != 0; left &= left - 1) {
      const float value = values[static_cast<std::size_t>(std::countr_zero(left))];
      least = std::min(least, value);
      most = std::max(most, value);
    }
    const float sigma = lattice_.noise.sigma_per_m(most, 0.0F);
    if (most - least <= sigma) return true;
    const float slope = (most - least) / kCell_px * static_cast<float>(camera_.fx_px) / most;
    return is_followed(part, values, arc,
                       rules_.most_sigmas * lattice_.noise.sigma_per_m(most, slope * slope));
  }

  /// Returns the first ball that reaches the cell, or null.
  [[nodiscard]] const FineBall* fine_ball(CellBits in, int column, int row) const {
    const int k = std::countr_zero(in);
    const CellPixel p{static_cast<std::int8_t>(k % 5), static_cast<std::int8_t>(k / 5)};
    const float z = 1.0F / pixels_.inverse_depth[pixel(column, row, p)];
    const Eigen::Vector3f at =
        back_project(camera_, column * kCell_px + p.x, row * kCell_px + p.y, z).cast<float>();
    const float reach = z * 1.5F * kCell_px / static_cast<float>(std::min(camera_.fx_px, camera_.fy_px));
    const auto found = std::find_if(fine_.begin(), fine_.end(), [&](const FineBall& ball) {
      const float within = ball.radius_m + reach;
      return (at - ball.centre_camera).squaredNorm() <= within * within;
    });
    return found == fine_.end() ? nullptr : &*found;
  }

  /// Returns the bits of the sides that border on a full cell: left, bottom, right, top.
  [[nodiscard]] unsigned busy_sides(int column, int row) const {
    const auto is_full = [&](int i, int j) {
      return i >= 0 && j >= 0 && i < across_ && j + 1 < lattice_.rows &&
             cells_.kinds[cell(i, j)] == CellKind::kFull;
    };
    return (is_full(column - 1, row) ? 1U : 0U) | (is_full(column, row + 1) ? 2U : 0U) |
           (is_full(column + 1, row) ? 4U : 0U) | (is_full(column, row - 1) ? 8U : 0U);
  }

  void put(int column, int row, CellPixel a, CellPixel b, CellPixel c) {
    cells_.triangles.push_back({static_cast<std::uint32_t>(pixel(column, row, a)),
                                static_cast<std::uint32_t>(pixel(column, row, b)),
                                static_cast<std::uint32_t>(pixel(column, row, c))});
  }

  void cut(int column, int row) {
    const unsigned busy = busy_sides(column, row);
    for (const CellBits part : cells_.parts[cell(column, row)]) {
      RingArc arc;
      if (part == 0 || !find_outline(part, arc)) continue;
      const Polygon polygon = polygon_of(arc, busy);
      const CellTriangles triangles = triangulate(polygon.corners.data(), polygon.count);
      for (int t = 0; t < triangles.count; ++t) {
        const auto& corner = triangles.triangles[static_cast<std::size_t>(t)];
        put(column, row, ring(polygon.corners[corner[0]]), ring(polygon.corners[corner[1]]),
            ring(polygon.corners[corner[2]]));
      }
    }
  }

  void fill(int column, int row) {
    const CellBits in = pixels_.smooth.square(column * kCell_px, row * kCell_px);
    CellValues depth_m{};
    (void)read(in, column, row, depth_m);
    for (float& z : depth_m) z = 1.0F / z;  // values of other pixels are never read
    const auto depth = [&](CellPixel p) { return depth_m[static_cast<std::size_t>(place(p))]; };
    const auto triangle = [&](CellPixel corner, CellPixel second, CellPixel third) {
      if ((in & bit(place(corner))) == 0 || (in & bit(place(second))) == 0 || (in & bit(place(third))) == 0)
        return;
      if (rules_.jump.is_one_surface(depth(corner), depth(second)) &&
          rules_.jump.is_one_surface(depth(corner), depth(third)) &&
          rules_.jump.is_one_surface_diagonally(depth(second), depth(third)))
        put(column, row, corner, second, third);
    };
    for (std::int8_t y = 0; y < kCell_px; ++y) {
      for (std::int8_t x = 0; x < kCell_px; ++x) {
        const auto right = static_cast<std::int8_t>(x + 1), below = static_cast<std::int8_t>(y + 1);
        const CellPixel a{x, y}, b{x, below}, c{right, below}, d{right, y};
        const bool has_ac = (in & bit(place(a))) != 0 && (in & bit(place(c))) != 0;
        const bool has_bd = (in & bit(place(b))) != 0 && (in & bit(place(d))) != 0;
        if (!has_ac && !has_bd) continue;
        if (has_bd && (!has_ac || std::abs(depth(b) - depth(d)) <= std::abs(depth(a) - depth(c)))) {
          triangle(a, b, d);
          triangle(c, d, b);
        } else {
          triangle(b, c, a);
          triangle(d, a, c);
        }
      }
    }
  }

  const DynamicPixels& pixels_;
  const DynamicLattice& lattice_;
  const Intrinsics& camera_;
  std::span<const FineBall> fine_;
  const CellRules& rules_;
  DynamicCells& cells_;
  int across_;  // cells per row
  std::size_t width_;
};

}  // namespace

void make_cells(const DynamicPixels& pixels, const DynamicLattice& lattice, const Intrinsics& camera,
                const FineBalls& fine, const CellRules& rules, DynamicCells& cells) {
  const auto count =
      static_cast<std::size_t>(lattice.columns - 1) * static_cast<std::size_t>(lattice.rows - 1);
  cells.kinds.assign(count, CellKind::kEmpty);
  cells.is_flat.assign(count, 0);
  cells.parts.resize(count);
  cells.must_be_vertex.assign(lattice.inverse_depth.size(), 0);
  cells.counts = {};
  cells.fine_of_region.assign(fine.regions, 0);
  cells.triangles.clear();
  cells.triangles.reserve(2 * static_cast<std::size_t>(pixels.smooth.width) *
                          static_cast<std::size_t>(pixels.smooth.height));
  cells.has_flat.clear();
  cells.has_flat.reserve(count / (kSquareCells * kSquareCells));
  cells.first_triangle.clear();
  cells.first_triangle.reserve(count / (kSquareCells * kSquareCells) + 1);
  CellSorter sorter(pixels, lattice, camera, fine.balls, rules, cells);
  sorter.sort();
  sorter.make_triangles();
}

}  // namespace roomradar
