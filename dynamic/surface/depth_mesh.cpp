// depth_mesh.cpp: triangle mesh through the pixels of a depth frame.
#include "dynamic/surface/depth_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "dynamic/surface/depth_discontinuity.hpp"
#include "mapping/types/system/config_check.hpp"

namespace roomradar {
namespace {

constexpr std::uint32_t kNoVertex = 0xFFFFFFFFU;

// Camera and pose in the form that the inner loop needs.
struct Projection {
  float inv_fx, inv_fy, cx, cy;
  Eigen::Matrix3f R_world_camera;
  int last_x = 0, last_y = 0;  // last column and row of the grid
  float border_push_m = 0.0F;  // for vertices in the grid's first and last row and column

  Eigen::Vector3f operator()(int x, int y, float depth_m) const {
    Eigen::Vector3f p_camera((static_cast<float>(x) - cx) * inv_fx * depth_m,
                             (static_cast<float>(y) - cy) * inv_fy * depth_m, depth_m);
    if (border_push_m > 0.0F) push_out(x, y, p_camera);
    return R_world_camera * p_camera;
  }
  void push_out(int x, int y, Eigen::Vector3f& p_camera) const {
    constexpr float kNearest_m = 0.1F;  // still in front of the camera
    const int side_x = static_cast<int>(x == last_x) - static_cast<int>(x == 0);
    const int side_y = static_cast<int>(y == last_y) - static_cast<int>(y == 0);
    if (side_x == 0 && side_y == 0) return;
    p_camera.x() += static_cast<float>(side_x) * border_push_m;
    p_camera.y() += static_cast<float>(side_y) * border_push_m;
    p_camera.z() = std::max(p_camera.z() - border_push_m, std::min(p_camera.z(), kNearest_m));
  }
};

// A corner of a grid cell. The first triangle that needs its vertex makes it, so every vertex has a triangle.
struct Corner {
  int x, y;
  float depth_m;          // 0: no depth
  std::uint32_t& vertex;  // slot in the row buffer
};

class GridMesher {
 public:
  GridMesher(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera, const DepthMeshConfig& config,
             bool skirts, Mesh& mesh)
      : project_{static_cast<float>(1.0 / camera.fx_px), static_cast<float>(1.0 / camera.fy_px),
                 static_cast<float>(camera.cx_px), static_cast<float>(camera.cy_px),
                 T_world_camera.linear().cast<float>()},
        rule_(config.noise, config.jump_sigmas, config.jump_incidence_deg,
              static_cast<float>(config.stride_px), camera),
        skirts_(skirts),
        mesh_(mesh) {}

  // Adds the cell with corners a (top left), b (bottom left), c (bottom right), d (top right),
  // counter-clockwise as seen by the camera. Splits it along the diagonal with the smaller depth step.
  void cell(const Corner& a, const Corner& b, const Corner& c, const Corner& d) {
    const bool has_ac = a.depth_m > 0.0F && c.depth_m > 0.0F;
    const bool has_bd = b.depth_m > 0.0F && d.depth_m > 0.0F;
    if (!has_ac && !has_bd) return;
    if (has_bd && (!has_ac || std::abs(b.depth_m - d.depth_m) <= std::abs(a.depth_m - c.depth_m))) {
      triangle(a, b, d);  // right angle first, diagonal opposite
      triangle(c, d, b);
    } else {
      triangle(b, c, a);
      triangle(d, a, c);
    }
  }

  // Moves the outermost vertices of a grid of this size outwards and nearer.
  void push_border(int width, int height, int stride, float push_m) {
    project_.last_x = (width - 1) / stride * stride;
    project_.last_y = (height - 1) / stride * stride;
    project_.border_push_m = push_m;
  }

  void finish() {
    for (Eigen::Vector3f& normal : mesh_.normals) {
      const float length = normal.norm();
      if (length > 0.0F) normal /= length;
    }
    if (!skirts_) return;
    for (std::size_t i = 0; i < mesh_.normals.size(); ++i) {  // vertices of skirts only face the camera
      if (mesh_.normals[i].isZero()) mesh_.normals[i] = -mesh_.vertices[i].normalized();
    }
  }

 private:
  void triangle(const Corner& corner, const Corner& second, const Corner& third) {
    if (!(corner.depth_m > 0.0F && second.depth_m > 0.0F && third.depth_m > 0.0F)) return;
    const bool one_surface = rule_.is_one_surface(corner.depth_m, second.depth_m) &&
                             rule_.is_one_surface(corner.depth_m, third.depth_m) &&
                             rule_.is_one_surface_diagonally(second.depth_m, third.depth_m);
    if (!one_surface && !skirts_) return;
    const Triangle t = {vertex(corner), vertex(second), vertex(third)};
    mesh_.triangles.push_back(t);
    if (!one_surface) return;  // a skirt is no surface: it does not affect the normals
    const Eigen::Vector3f& p = mesh_.vertices[t[0]];
    const Eigen::Vector3f area_normal = (mesh_.vertices[t[1]] - p).cross(mesh_.vertices[t[2]] - p);
    for (const std::uint32_t i : t) mesh_.normals[i] += area_normal;
  }

  std::uint32_t vertex(const Corner& corner) {
    if (corner.vertex == kNoVertex) {
      corner.vertex = static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.push_back(project_(corner.x, corner.y, corner.depth_m));
      mesh_.normals.emplace_back(0.0F, 0.0F, 0.0F);
    }
    return corner.vertex;
  }

  Projection project_;
  DepthDiscontinuity rule_;
  bool skirts_;
  Mesh& mesh_;
};

void start(const DepthImage& depth_m, const Eigen::Isometry3d& T_world_camera, const DepthMeshConfig& config,
           DepthMeshScratch& scratch, Mesh& mesh) {
  const auto columns = static_cast<std::size_t>((depth_m.width + config.stride_px - 1) / config.stride_px);
  const auto rows = static_cast<std::size_t>((depth_m.height + config.stride_px - 1) / config.stride_px);
  mesh.origin = T_world_camera.translation();
  mesh.vertices.clear();
  mesh.normals.clear();
  mesh.colours.clear();
  mesh.triangles.clear();
  mesh.vertices.reserve(columns * rows);  // upper bounds, so later frames do not allocate
  mesh.normals.reserve(columns * rows);
  mesh.triangles.reserve(columns * rows * 2);
  scratch.vertex_above.assign(columns, kNoVertex);
  scratch.vertex_here.assign(columns, kNoVertex);
}

// Meshes the cells of the stride grid row by row; depth_at(x, y) is 0 without depth.
template <typename DepthAt>
void mesh_grid(int width, int height, int stride, const DepthAt& depth_at, DepthMeshScratch& scratch,
               GridMesher& mesher) {
  for (int y = 0; y + stride < height; y += stride) {
    std::fill(scratch.vertex_here.begin(), scratch.vertex_here.end(), kNoVertex);
    float top_left = width > 0 ? depth_at(0, y) : 0.0F;
    float bottom_left = width > 0 ? depth_at(0, y + stride) : 0.0F;
    for (int x = 0, i = 0; x + stride < width; x += stride, ++i) {
      const float top_right = depth_at(x + stride, y);
      const float bottom_right = depth_at(x + stride, y + stride);
      mesher.cell({x, y, top_left, scratch.vertex_above[i]},
                  {x, y + stride, bottom_left, scratch.vertex_here[i]},
                  {x + stride, y + stride, bottom_right, scratch.vertex_here[i + 1]},
                  {x + stride, y, top_right, scratch.vertex_above[i + 1]});
      top_left = top_right;
      bottom_left = bottom_right;
    }
    scratch.vertex_above.swap(scratch.vertex_here);
  }
}

// Copies one row and fills its gaps of up to gap_px along straight lines, which are linear in inverse depth.
void fill_gaps(const float* depth_m, int width, int gap_px, float* filled_m) {
  std::copy_n(depth_m, width, filled_m);
  int last = -1;
  for (int x = 0; x < width; ++x) {
    if (!(depth_m[x] > 0.0F)) continue;
    const int gap = x - last - 1;
    if (last >= 0 && gap > 0 && gap <= gap_px) {
      const float from = 1.0F / depth_m[last];
      const float step = (1.0F / depth_m[x] - from) / static_cast<float>(gap + 1);
      for (int i = 1; i <= gap; ++i) filled_m[last + i] = 1.0F / (from + step * static_cast<float>(i));
    }
    last = x;
  }
}

// Extends a row's first and last depth over the unmeasured pixels beside them.
void fill_ends(int width, float* depth_m) {
  const auto measured = [](float of_m) { return of_m > 0.0F; };
  float* const end = depth_m + width;
  float* const first = std::find_if(depth_m, end, measured);
  if (first == end) return;
  std::fill(depth_m, first, *first);
  float* last = end - 1;
  while (!measured(*last)) --last;
  std::fill(last + 1, end, *last);
}

}  // namespace

void require_valid(const DepthMeshConfig& config) {
  const ConfigCheck require{"depth_mesh"};
  require(config.stride_px >= 1 && config.stride_px <= 64, "stride_px", config.stride_px, "in 1..64");
  require(config.jump_sigmas >= 0.0F && config.jump_sigmas < 1e3F, "jump_sigmas", config.jump_sigmas,
          "in 0..1000");
  require(config.jump_incidence_deg >= 0.0F && config.jump_incidence_deg < 90.0F, "jump_incidence_deg",
          config.jump_incidence_deg, "at least 0 and under 90");
  require(config.skirt_gap_px >= 0, "skirt_gap_px", config.skirt_gap_px, ">= 0");
  require(config.border_push_m >= 0.0F && config.border_push_m < 100.0F, "border_push_m",
          config.border_push_m, "in 0..100");
}

void mesh_whole(const PosedDepth& measured, SurfacePolicy policy, const DepthMeshConfig& config,
                DepthMeshScratch& scratch, Mesh& mesh) {
  const DepthImage& depth_m = measured.depth_m;
  const bool border = policy == SurfacePolicy::kBorder;
  const bool skirts = border || policy == SurfacePolicy::kSkirt;
  start(depth_m, measured.T_world_camera, config, scratch, mesh);
  GridMesher mesher(measured.camera, measured.T_world_camera, config, skirts, mesh);
  if (border) mesher.push_border(depth_m.width, depth_m.height, config.stride_px, config.border_push_m);
  const float* depths = depth_m.pixels.data();
  if (skirts) {
    scratch.filled_m.resize(depth_m.pixels.size());
    for (int y = 0; y < depth_m.height; ++y) {
      float* const filled_m = scratch.filled_m.data() + depth_m.index(0, y);
      fill_gaps(depth_m.row(y), depth_m.width, config.skirt_gap_px, filled_m);
      if (border) fill_ends(depth_m.width, filled_m);
    }
    depths = scratch.filled_m.data();
  }
  const auto depth_at = [&](int x, int y) { return depths[depth_m.index(x, y)]; };
  mesh_grid(depth_m.width, depth_m.height, config.stride_px, depth_at, scratch, mesher);
  mesher.finish();
}

}  // namespace roomradar
