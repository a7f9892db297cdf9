// dynamic_surface.cpp: assembles the two dynamic meshes from cells and squares.
#include "dynamic/surface/dynamic_surface.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "dynamic/surface/rtin.hpp"
#include "mapping/types/system/config_check.hpp"

namespace roomradar {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFU;

void clear(Mesh& mesh, const Eigen::Vector3d& origin) {
  mesh.origin = origin;
  mesh.vertices.clear();
  mesh.normals.clear();
  mesh.colours.clear();
  mesh.triangles.clear();
}

/// Back-projects pixels to points relative to the camera's position, in world axes.
struct Rays {
  float inverse_fx, inverse_fy, cx, cy;
  Eigen::Matrix3f R_world_camera;
  [[nodiscard]] Eigen::Vector3f point(float x, float y, float inverse_depth) const {
    return R_world_camera * Eigen::Vector3f((x - cx) * inverse_fx, (y - cy) * inverse_fy, 1.0F) *
           (1.0F / inverse_depth);
  }
};

class Assembler {
 public:
  Assembler(const DepthImage& expected_m, const Rays& rays, const BackRules& back_rules,
            DynamicSurfaceScratch& scratch, DynamicSurface& surface)
      : expected_m_(expected_m),
        rays_(rays),
        back_rules_(back_rules),
        scratch_(scratch),
        seen_(surface.seen_world),
        inferred_(surface.inferred_world),
        width_(static_cast<std::uint32_t>(expected_m.width)),
        grid_{scratch.lattice.columns, scratch.lattice.rows, scratch.cells.is_flat} {}

  void make_seen() {
    find_needed_points(scratch_.values, scratch_.tolerances);
    const auto value = [&](std::uint32_t pixel) {
      const std::uint32_t x = pixel % width_, y = pixel / width_;
      if ((x | y) % kCell_px == 0) return scratch_.values[lattice_point(x, y)];
      return scratch_.smoothed[pixel] = smoothed_inverse_depth(scratch_.pixels, scratch_.lattice.noise,
                                                               static_cast<int>(x), static_cast<int>(y));
    };
    walk(seen_, value, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      seen_.triangles.push_back({a, b, c});
    });
    scratch_.seen_pixels.swap(scratch_.pixel_of_vertex);
  }

  void make_normals() {
    seen_.normals.assign(seen_.vertices.size(), Eigen::Vector3f::Zero());
    for (const Triangle& t : seen_.triangles) {
      const Eigen::Vector3f& p = seen_.vertices[t[0]];
      const Eigen::Vector3f area_normal = (seen_.vertices[t[1]] - p).cross(seen_.vertices[t[2]] - p);
      for (const std::uint32_t i : t) seen_.normals[i] += area_normal;
    }
    for (std::size_t i = 0; i < seen_.normals.size(); ++i) {
      const float length = seen_.normals[i].norm();
      seen_.normals[i] = length > 0.0F ? Eigen::Vector3f(seen_.normals[i] / length)
                                       : Eigen::Vector3f(-seen_.vertices[i].normalized());
    }
  }

  void make_inferred() {
    find_needed_points(scratch_.back.inverse_depth, scratch_.back.tolerance);
    const auto value = [&](std::uint32_t pixel) {
      const std::uint32_t x = pixel % width_, y = pixel / width_;
      if ((x | y) % kCell_px == 0) return scratch_.back.inverse_depth[lattice_point(x, y)];
      return back_at({static_cast<int>(x), static_cast<int>(y), scratch_.smoothed[pixel]}, scratch_.lattice,
                     expected_m_, back_rules_, scratch_.back);
    };
    walk(inferred_, value, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      inferred_.triangles.push_back({a, c, b});
    });
    find_rim();
    for (std::size_t i = 0; i < scratch_.pixel_of_vertex.size(); ++i)
      scratch_.vertex_of_pixel[scratch_.pixel_of_vertex[i]] = static_cast<std::uint32_t>(i);
    scratch_.rim_of_seen.assign(scratch_.seen_pixels.size(), kNone);
    for (const DynamicSurfaceScratch::Edge& edge : scratch_.edges) {
      if (edge.from == kNone) continue;
      const std::uint32_t a = rim(edge.from), b = rim(edge.to);
      const std::uint32_t back_a = scratch_.vertex_of_pixel[scratch_.seen_pixels[edge.from]];
      const std::uint32_t back_b = scratch_.vertex_of_pixel[scratch_.seen_pixels[edge.to]];
      inferred_.triangles.push_back({b, a, back_a});
      inferred_.triangles.push_back({b, back_a, back_b});
    }
    forget_pixels();
  }

  /// Adds slabs for lines and specks, up to kMost_px pixels each.
  void add_thin(bool with_back) {
    constexpr int kMost_px = 8;
    PixelBits& thin = scratch_.pixels.thin;
    for (int y = 0; y < thin.height; ++y) {
      for (int i = 0; i < thin.words; ++i) {
        while (thin.row(y)[i] != 0) {
          const int x = 64 * i + std::countr_zero(thin.row(y)[i]);
          int right = x, down = y;
          take(thin, x, y);
          while (right - x + 1 < kMost_px && right + 1 < thin.width && thin.at(right + 1, y) &&
                 goes_on(right, y, right + 1, y))
            take(thin, ++right, y);
          while (right == x && down - y + 1 < kMost_px && down + 1 < thin.height && thin.at(x, down + 1) &&
                 goes_on(x, down, x, down + 1))
            take(thin, x, ++down);
          add_slab(x, y, right, down, with_back);
        }
      }
    }
  }

 private:
  [[nodiscard]] std::size_t lattice_point(std::uint32_t x, std::uint32_t y) const {
    return scratch_.lattice.index(static_cast<int>(x) / kCell_px, static_cast<int>(y) / kCell_px);
  }

  void find_needed_points(std::span<const float> values, std::span<const float> tolerances) {
    scratch_.needed = scratch_.cells.must_be_vertex;
    find_needed(grid_, values, tolerances, scratch_.needed);
  }

  /// Visits all triangles square by square, so vertices near in the world are near in the mesh.
  template <typename Value, typename Take>
  void walk(Mesh& mesh, const Value& value, const Take& take) {
    scratch_.pixel_of_vertex.clear();
    const auto vertex = [&](std::uint32_t pixel) {
      std::uint32_t& at = scratch_.vertex_of_pixel[pixel];
      if (at == kNone) {
        at = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(rays_.point(static_cast<float>(pixel % width_),
                                            static_cast<float>(pixel / width_), value(pixel)));
        scratch_.pixel_of_vertex.push_back(pixel);
      }
      return at;
    };
    const auto at_point = [&](GridPoint p) {
      return vertex(static_cast<std::uint32_t>(kCell_px * p.y) * width_ +
                    static_cast<std::uint32_t>(kCell_px * p.x));
    };
    std::size_t square = 0;
    for (int row = 0; row + 1 < grid_.rows; row += kSquareCells) {
      for (int column = 0; column + 1 < grid_.columns; column += kSquareCells, ++square) {
        if (scratch_.cells.has_flat[square] != 0) {
          walk_square(grid_, scratch_.needed, column, row, [&](GridPoint a, GridPoint b, GridPoint c) {
            take(at_point(a), at_point(b), at_point(c));
          });
        }
        for (std::uint32_t t = scratch_.cells.first_triangle[square];
             t < scratch_.cells.first_triangle[square + 1]; ++t) {
          const PixelTriangle& pixels = scratch_.cells.triangles[t];
          take(vertex(pixels[0]), vertex(pixels[1]), vertex(pixels[2]));
        }
      }
    }
    forget_pixels();
  }

  void forget_pixels() {
    for (const std::uint32_t pixel : scratch_.pixel_of_vertex) scratch_.vertex_of_pixel[pixel] = kNone;
  }

  /// Leaves in `edges` the boundary edges of the seen mesh, which have a triangle on one side only.
  void find_rim() {
    scratch_.edges.clear();
    scratch_.first_edge.assign(seen_.vertices.size(), kNone);
    for (const Triangle& t : seen_.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = t[k], to = t[(k + 1) % 3];
        std::uint32_t* link = &scratch_.first_edge[to];
        while (*link != kNone && scratch_.edges[*link].to != from) link = &scratch_.edges[*link].next;
        if (*link != kNone) {
          scratch_.edges[*link].from = kNone;
          *link = scratch_.edges[*link].next;
        } else {
          scratch_.edges.push_back({from, to, scratch_.first_edge[from]});
          scratch_.first_edge[from] = static_cast<std::uint32_t>(scratch_.edges.size() - 1);
        }
      }
    }
  }

  std::uint32_t rim(std::uint32_t seen_vertex) {
    std::uint32_t& at = scratch_.rim_of_seen[seen_vertex];
    if (at == kNone) {
      at = static_cast<std::uint32_t>(inferred_.vertices.size());
      inferred_.vertices.push_back(seen_.vertices[seen_vertex]);
    }
    return at;
  }

  static void take(PixelBits& bits, int x, int y) { bits.row(y)[x >> 6] &= ~(std::uint64_t{1} << (x & 63)); }
  [[nodiscard]] float inverse_depth(int x, int y) const {
    return scratch_.pixels.inverse_depth[static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(x)];
  }
  [[nodiscard]] bool goes_on(int x, int y, int to_x, int to_y) const {
    return back_rules_.jump.is_one_surface_inverse(inverse_depth(x, y), inverse_depth(to_x, to_y));
  }

  /// Adds a slab over the pixels from (x0, y0) to (x1, y1), enlarged by half a pixel on all sides.
  void add_slab(int x0, int y0, int x1, int y1, bool with_back) {
    const std::array<float, 2> front{inverse_depth(x0, y0), inverse_depth(x1, y1)};
    const std::array<float, 2> x{static_cast<float>(x0) - 0.5F, static_cast<float>(x1) + 0.5F};
    const std::array<float, 2> y{static_cast<float>(y0) - 0.5F, static_cast<float>(y1) + 0.5F};
    const bool is_level = y0 == y1;
    // Top left, bottom left, bottom right, top right.
    const auto put = [&](Mesh& mesh, const std::array<float, 2>& inverse_depths) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const auto& [i, j] : {std::array<std::size_t, 2>{0, 0}, {0, 1}, {1, 1}, {1, 0}})
        mesh.vertices.push_back(rays_.point(x[i], y[j], inverse_depths[is_level ? i : j]));
      return first;
    };
    const std::uint32_t s = put(seen_, front);
    seen_.triangles.push_back({s, s + 1, s + 2});
    seen_.triangles.push_back({s, s + 2, s + 3});
    if (!with_back) return;
    const std::uint32_t f = put(inferred_, front);
    const std::uint32_t b = put(
        inferred_, {back_at({x0, y0, front[0]}, scratch_.lattice, expected_m_, back_rules_, scratch_.back),
                    back_at({x1, y1, front[1]}, scratch_.lattice, expected_m_, back_rules_, scratch_.back)});
    inferred_.triangles.push_back({b, b + 2, b + 1});
    inferred_.triangles.push_back({b, b + 3, b + 2});
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t next = (k + 1) % 4;
      inferred_.triangles.push_back({f + next, f + k, b + k});
      inferred_.triangles.push_back({f + next, b + k, b + next});
    }
  }

  const DepthImage& expected_m_;
  const Rays& rays_;
  const BackRules& back_rules_;
  DynamicSurfaceScratch& scratch_;
  Mesh& seen_;
  Mesh& inferred_;
  std::uint32_t width_;
  Rtin grid_;
};

/// Reserves upper bounds, so later frames do not allocate.
void reserve(std::size_t pixels, bool with_back, DynamicSurfaceScratch& scratch, DynamicSurface& surface) {
  surface.seen_world.vertices.reserve(pixels);
  surface.seen_world.normals.reserve(pixels);
  surface.seen_world.triangles.reserve(2 * pixels);
  if (scratch.vertex_of_pixel.size() != pixels) scratch.vertex_of_pixel.assign(pixels, kNone);
  scratch.pixel_of_vertex.reserve(pixels);
  scratch.smoothed.resize(pixels);
  scratch.seen_pixels.reserve(pixels);
  if (!with_back) return;
  surface.inferred_world.vertices.reserve(2 * pixels);
  surface.inferred_world.triangles.reserve(4 * pixels);
  scratch.rim_of_seen.reserve(pixels);
  scratch.edges.reserve(6 * pixels);
  scratch.first_edge.reserve(pixels);
}

}  // namespace

void require_valid(const DynamicSurfaceConfig& config) {
  const ConfigCheck require{"dynamic_surface"};
  const auto require_sigmas = [&require](const char* field, float value) {
    require(value > 0.0F && value < 1e3F, field, value, "over 0 and under 1000");
  };
  require_sigmas("deviation_sigmas", config.deviation_sigmas);
  require_sigmas("flat_sigmas", config.flat_sigmas);
  require_sigmas("cut_sigmas", config.cut_sigmas);
  require_sigmas("jump_sigmas", config.jump_sigmas);
  require(config.jump_incidence_deg >= 0.0F && config.jump_incidence_deg < 90.0F, "jump_incidence_deg",
          config.jump_incidence_deg, "at least 0 and under 90");
  require(config.least_thickness_m > 0.0F && config.least_thickness_m < 10.0F, "least_thickness_m",
          config.least_thickness_m, "over 0 and under 10");
  require(config.most_thickness_m >= config.least_thickness_m && config.most_thickness_m < 10.0F,
          "most_thickness_m", config.most_thickness_m, "at least least_thickness_m and under 10");
  require(config.least_roundness >= 0.0F && config.least_roundness <= 1.0F, "least_roundness",
          config.least_roundness, "in 0..1");
  require(config.back_clearance_m >= 0.0F && config.back_clearance_m < 1.0F, "back_clearance_m",
          config.back_clearance_m, "at least 0 and under 1");
}

void mesh_dynamic(const DynamicView& view, std::span<const FineRegion> regions,
                  const DynamicSurfaceConfig& config, DynamicSurfaceScratch& scratch,
                  DynamicSurface& surface) {
  const auto& [depth_m, camera, T_world_camera] = view.measured;
  const DepthImage& expected_depth_m = view.expected_depth_m;
  assert(depth_m.width == view.dynamic_mask.width && depth_m.height == view.dynamic_mask.height);
  assert(depth_m.width == expected_depth_m.width && depth_m.height == expected_depth_m.height);
  clear(surface.seen_world, T_world_camera.translation());
  clear(surface.inferred_world, T_world_camera.translation());
  if (depth_m.empty()) return;
  reserve(depth_m.pixels.size(), config.has_back, scratch, surface);

  scratch.fine.clear();
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const Eigen::Vector3d centre = T_camera_world * regions[i].centre_world;
    if (centre.allFinite() && std::isfinite(regions[i].radius_m))
      scratch.fine.push_back({centre.cast<float>(), static_cast<float>(regions[i].radius_m), i});
  }

  take_dynamic_pixels(depth_m, view.dynamic_mask, scratch.pixels);
  make_lattice(scratch.pixels, camera, config.noise, config.flat_sigmas, scratch.lattice);
  const CellRules cell_rules{
      DepthDiscontinuity(config.noise, config.jump_sigmas, config.jump_incidence_deg, 1.0F, camera),
      config.cut_sigmas};
  make_cells(scratch.pixels, scratch.lattice, camera, {scratch.fine, regions.size()}, cell_rules,
             scratch.cells);

  scratch.values = scratch.lattice.inverse_depth;
  scratch.tolerances = scratch.lattice.sigma;
  for (float& tolerance : scratch.tolerances) tolerance *= config.deviation_sigmas;
  const Rays rays{static_cast<float>(1.0 / camera.fx_px), static_cast<float>(1.0 / camera.fy_px),
                  static_cast<float>(camera.cx_px), static_cast<float>(camera.cy_px),
                  T_world_camera.linear().cast<float>()};
  const BackRules back_rules{
      DepthDiscontinuity(config.noise, config.jump_sigmas, config.jump_incidence_deg, kCell_px, camera),
      config.least_thickness_m, config.most_thickness_m, config.least_roundness, config.back_clearance_m};
  Assembler assembler(expected_depth_m, rays, back_rules, scratch, surface);
  assembler.make_seen();
  if (config.has_back) {
    make_back(scratch.pixels, scratch.lattice, view, back_rules, scratch.back);
    assembler.make_inferred();
  }
  assembler.add_thin(config.has_back);
  assembler.make_normals();
}

}  // namespace roomradar
