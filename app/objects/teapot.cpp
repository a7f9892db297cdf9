// teapot.cpp: evaluates, orients and welds Newell's teapot patch by patch.
#include "app/objects/teapot.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

using Patch = std::array<std::array<Eigen::Vector3d, 4>, 4>;  // control points, [along v][along u]

constexpr double kKnobTop = 3.15;  // height of the published teapot in its own units; its bottom is at 0

// The published 306 control points are these rings and ribs and their mirror images. Rim, body, lid and
// bottom are 24 patches over the profiles below (4 quarter turns each); handle and spout are 4 patches each
// (2 along, mirrored at y = 0).

/// Four control points over a quarter turn: (radius, 0), (radius, handle), (handle, radius), (0, radius) at
/// height z.
struct Ring {
  double radius, handle, z;
};
using Profile = std::array<Ring, 4>;  // from the inside of the rim, or the top of the knob, outward and down
constexpr std::array<Profile, 6> kProfiles = {{
    {{{1.4, 0.784, 2.4}, {1.3375, 0.749, 2.53125}, {1.4375, 0.805, 2.53125}, {1.5, 0.84, 2.4}}},  // rim
    {{{1.5, 0.84, 2.4}, {1.75, 0.98, 1.875}, {2.0, 1.12, 1.35}, {2.0, 1.12, 0.9}}},    // upper body
    {{{2.0, 1.12, 0.9}, {2.0, 1.12, 0.45}, {1.5, 0.84, 0.225}, {1.5, 0.84, 0.15}}},    // lower body
    {{{1.5, 0.84, 0.15}, {1.5, 0.84, 0.075}, {1.425, 0.798, 0.0}, {0.0, 0.0, 0.0}}},   // bottom
    {{{0.0, 0.0, 3.15}, {0.8, 0.45, 3.15}, {0.0, 0.0, 2.85}, {0.2, 0.112, 2.7}}},      // knob
    {{{0.2, 0.112, 2.7}, {0.4, 0.224, 2.55}, {1.3, 0.728, 2.55}, {1.3, 0.728, 2.4}}},  // lid
}};

/// Four control points over half a tube: upper, upper shifted by -y, lower shifted by -y, lower.
struct Rib {
  double upper_x, upper_z, lower_x, lower_z, half_width;
};
using Tube = std::array<Rib, 7>;  // two patches that share the middle rib
constexpr std::array<Tube, 2> kTubes = {{
    {{{-1.6, 2.025, -1.5, 2.25, 0.3},  // handle, from the upper end; "upper" is its inner side
      {-2.3, 2.025, -2.5, 2.25, 0.3},
      {-2.7, 2.025, -3.0, 2.25, 0.3},
      {-2.7, 1.8, -3.0, 1.8, 0.3},
      {-2.7, 1.575, -3.0, 1.35, 0.3},
      {-2.5, 1.125, -2.65, 0.9375, 0.3},
      {-2.0, 0.9, -1.9, 0.6, 0.3}}},
    {{{1.7, 1.425, 1.7, 0.6, 0.66},  // spout, from the body
      {2.6, 1.425, 3.1, 0.825, 0.66},
      {2.3, 2.1, 2.4, 2.025, 0.25},
      {2.7, 2.4, 3.3, 2.4, 0.25},
      {2.8, 2.475, 3.525, 2.49375, 0.25},
      {2.9, 2.475, 3.45, 2.5125, 0.15},
      {2.8, 2.4, 3.2, 2.4, 0.15}}},
}};

/// Patches that share borders: body with rim and bottom, lid with knob, handle, spout. Different pieces
/// simply intersect.
using Piece = std::vector<Patch>;

/// Returns all 32 patches, oriented so that d/du x d/dv points outward.
std::array<Piece, 4> pieces() {
  std::array<Piece, 4> result;
  for (std::size_t which = 0; which < kProfiles.size(); ++which) {
    const Profile& profile = kProfiles[which];
    for (int quarter = 0; quarter < 4; ++quarter) {
      // Exact quarter turns, so that adjacent patches share their border bit for bit.
      constexpr std::array<std::array<double, 2>, 4> kCosSin = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
      const auto [c, s] = kCosSin[static_cast<std::size_t>(quarter)];
      Patch patch;
      for (std::size_t i = 0; i < 4; ++i) {
        const Ring& ring = profile[i];
        const std::array<std::array<double, 2>, 4> xy = {
            {{ring.radius, 0.0}, {ring.radius, ring.handle}, {ring.handle, ring.radius}, {0.0, ring.radius}}};
        // u runs against the turn and v down the profile: at the front this is -y x -z, outward.
        for (std::size_t j = 0; j < 4; ++j) {
          patch[i][3 - j] = {c * xy[j][0] - s * xy[j][1], s * xy[j][0] + c * xy[j][1], ring.z};
        }
      }
      result[which < 4 ? 0 : 1].push_back(patch);
    }
  }
  for (std::size_t which = 0; which < kTubes.size(); ++which) {
    const Tube& tube = kTubes[which];
    for (const std::size_t first : {0U, 3U}) {
      for (const double side : {-1.0, 1.0}) {
        Patch patch;
        for (std::size_t i = 0; i < 4; ++i) {
          const Rib& rib = tube[first + i];
          const std::array<Eigen::Vector3d, 4> across = {{{rib.upper_x, 0.0, rib.upper_z},
                                                          {rib.upper_x, side * rib.half_width, rib.upper_z},
                                                          {rib.lower_x, side * rib.half_width, rib.lower_z},
                                                          {rib.lower_x, 0.0, rib.lower_z}}};
          const bool reverse = side > 0.0;  // mirroring reverses a patch's orientation
          for (std::size_t j = 0; j < 4; ++j) patch[i][j] = across[reverse ? 3 - j : j];
        }
        result[2 + which].push_back(patch);
      }
    }
  }
  return result;
}

/// Cubic Bernstein polynomials and their derivatives.
struct Weights {
  std::array<double, 4> value, slope;
};
Weights bernstein(double t) {
  const double r = 1.0 - t;
  return {{r * r * r, 3.0 * r * r * t, 3.0 * r * t * t, t * t * t},
          {-3.0 * r * r, 3.0 * r * r - 6.0 * r * t, 6.0 * r * t - 3.0 * t * t, 3.0 * t * t}};
}

Eigen::Vector3d weighted(const Patch& patch, const std::array<double, 4>& along_v,
                         const std::array<double, 4>& along_u) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) sum += along_v[i] * along_u[j] * patch[i][j];
  }
  return sum;
}

/// Returns the outward normal at (u, v); where a side of the patch is degenerate to a point, the normal just
/// beside it.
Eigen::Vector3d normal_at(const Patch& patch, double u, double v) {
  for (const double step_in : {0.0, 1e-4}) {
    const Weights wu = bernstein(u + step_in * (0.5 - u));
    const Weights wv = bernstein(v + step_in * (0.5 - v));
    const Eigen::Vector3d normal =
        weighted(patch, wv.value, wu.slope).cross(weighted(patch, wv.slope, wu.value));
    if (normal.norm() > 1e-9) return normal.normalized();
  }
  return Eigen::Vector3d::Zero();
}

}  // namespace

Mesh utah_teapot(int tessellation, double height_m) {
  if (tessellation < 1 || tessellation > 256) {
    throw Error("teapot tessellation = " + std::to_string(tessellation) + ": must be in 1..256");
  }
  if (!(height_m > 0.0) || !std::isfinite(height_m)) {
    throw Error("teapot height_m = " + format_number(height_m) + ": must be finite and > 0");
  }
  const double scale = height_m / kKnobTop;
  const int n = tessellation;
  Mesh mesh;
  std::vector<Eigen::Vector3d> normal_sums;
  // The piece's vertices by quantised position, for welding.
  std::map<std::tuple<std::int64_t, std::int64_t, std::int64_t>, std::uint32_t> seen;
  // One unit is a few cm: 1e-6 units is far below the teapot's detail and far above rounding.
  const auto key = [](double v) { return static_cast<std::int64_t>(std::llround(v * 1e6)); };
  const auto welded = [&](const Eigen::Vector3d& p, const Eigen::Vector3d& normal) {
    const auto [entry, is_new] = seen.try_emplace({key(p.x()), key(p.y()), key(p.z())},
                                                  static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) {
      mesh.vertices.push_back((scale * p).cast<float>());
      normal_sums.push_back(Eigen::Vector3d::Zero());
    }
    normal_sums[entry->second] += normal;
    return entry->second;
  };

  std::vector<std::uint32_t> grid(static_cast<std::size_t>((n + 1) * (n + 1)));
  const auto tessellate = [&](const Patch& patch) {
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j <= n; ++j) {
        const double v = static_cast<double>(i) / n, u = static_cast<double>(j) / n;
        const Eigen::Vector3d p = weighted(patch, bernstein(v).value, bernstein(u).value);
        grid[static_cast<std::size_t>(i * (n + 1) + j)] = welded(p, normal_at(patch, u, v));
      }
    }
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});  // two corners coincide at a pole
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const auto at = [&](int row, int column) {
          return grid[static_cast<std::size_t>(row * (n + 1) + column)];
        };
        add(at(i, j), at(i, j + 1), at(i + 1, j + 1));
        add(at(i, j), at(i + 1, j + 1), at(i + 1, j));
      }
    }
  };
  for (const Piece& piece : pieces()) {
    seen.clear();
    for (const Patch& patch : piece) tessellate(patch);
  }
  mesh.normals.reserve(normal_sums.size());
  for (const Eigen::Vector3d& sum : normal_sums) mesh.normals.push_back(sum.normalized().cast<float>());
  return mesh;
}

}  // namespace roomradar
