// blocked_neighbours.cpp: intersects triangles with the lines through cell centres, one axis at a time.
#include "mapping/surface/unknown/blocked_neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace roomradar {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3i;

// Tolerance in cells for lines that pass a triangle's edge: intersecting both triangles of an edge is better
// than neither.
constexpr double kEdge = 1e-6;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// The integers within [a, b] and [0, size - 1]; empty if first > last.
struct Span {
  int first, last;
  Span(double a, double b, int size)
      : first(static_cast<int>(std::ceil(std::clamp(a - kEdge, 0.0, static_cast<double>(size))))),
        last(static_cast<int>(std::floor(std::clamp(b + kEdge, -1.0, size - 1.0)))) {}
};

// @param corners  in cells; cell centres at integer coordinates
void bar_along(int axis, const std::array<Vector3d, 3>& corners, const Vector3i& size,
               std::vector<Vector3i>& blocked) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::array<Vector2d, 3> p;
  for (std::size_t i = 0; i < 3; ++i) p[i] = {corners[i][u], corners[i][v]};
  const double area = cross(p[1] - p[0], p[2] - p[0]);
  if (area == 0.0) return;  // the lines are parallel to the triangle
  const Vector2d low = p[0].cwiseMin(p[1]).cwiseMin(p[2]), high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
  const Span in_u(low.x(), high.x(), size[u]), in_v(low.y(), high.y(), size[v]);
  std::array<Vector2d, 3> side;
  std::array<double, 3> slack;
  for (std::size_t i = 0; i < 3; ++i) {
    side[i] = p[(i + 2) % 3] - p[(i + 1) % 3];
    slack[i] = kEdge * side[i].norm() / std::abs(area);
  }
  for (int at_v = in_v.first; at_v <= in_v.last; ++at_v)
    for (int at_u = in_u.first; at_u <= in_u.last; ++at_u) {
      const Vector2d line(at_u, at_v);
      Vector3d share;
      bool is_in = true;
      for (std::size_t i = 0; i < 3; ++i) {
        const double part = cross(side[i], line - p[(i + 1) % 3]) / area;
        is_in = is_in && part >= -slack[i];
        share[static_cast<Eigen::Index>(i)] = part;
      }
      if (!is_in) continue;
      const double at = share.dot(Vector3d(corners[0][axis], corners[1][axis], corners[2][axis]));
      if (!(at >= 0.0 && at < size[axis])) continue;
      Vector3i cell;
      cell[axis] = static_cast<int>(at);
      cell[u] = at_u;
      cell[v] = at_v;
      blocked.push_back(cell);
    }
}

}  // namespace

std::array<SparseBitGrid, 3> blocked_neighbours(const Mesh& surface_world, const CellGrid& grid) {
  const Vector3d origin_cells =
      surface_world.origin / grid.cell_m - grid.first_cell.cast<double>() - Vector3d::Constant(0.5);
  std::array<SparseBitGrid, 3> blocked;
  std::vector<Vector3i> cells;
  for (int axis = 0; axis < 3; ++axis) {
    cells.clear();
    for (const Triangle& triangle : surface_world.triangles) {
      std::array<Vector3d, 3> corners;
      for (std::size_t i = 0; i < 3; ++i)
        corners[i] = surface_world.vertices[triangle[i]].cast<double>() / grid.cell_m + origin_cells;
      if (corners[0].allFinite() && corners[1].allFinite() && corners[2].allFinite())
        bar_along(axis, corners, grid.size, cells);
    }
    blocked[static_cast<std::size_t>(axis)] = SparseBitGrid(grid.size, cells);
  }
  return blocked;
}

}  // namespace roomradar
