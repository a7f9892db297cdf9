// depth_raster.cpp: finds visible pieces, shares them between two threads, merges both canvases.
#include "radar/depth/depth_raster.hpp"

#include <algorithm>
#include <utility>

namespace roomradar {
namespace {

constexpr double kFarAside_px = 8192.0;  // beyond it, pixel coordinates in float lose more than 1/1024 pixel
constexpr std::size_t kWorthTwo = 8;     // pieces from which a second thread pays

/// Corner of a triangle being clipped: (u * depth, v * depth, depth).
using Corner = Eigen::Vector3d;

/// A triangle clipped by five planes has at most eight corners.
struct Polygon {
  std::array<Corner, 8> corners;
  std::size_t count = 0;
};

/// Clips the polygon to side(corner) >= 0. Source: Sutherland and Hodgman, Reentrant polygon clipping, 1974.
template <typename Side>
void cut(const Side& side, Polygon& polygon) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const Corner& a = polygon.corners[i];
    const Corner& b = polygon.corners[(i + 1) % polygon.count];
    const double at_a = side(a), at_b = side(b);
    if (at_a >= 0.0) kept.corners[kept.count++] = a;
    if ((at_a >= 0.0) != (at_b >= 0.0)) kept.corners[kept.count++] = a + at_a / (at_a - at_b) * (b - a);
  }
  polygon = kept;
}

}  // namespace

DepthRaster::KnownMesh& DepthRaster::known_mesh(const GpuMesh& mesh) {
  constexpr std::size_t kKept = 8;  // meshes; the one drawn least recently is replaced
  const auto is_same = [&](const auto& known) { return known->mesh == &mesh; };
  auto found = std::find_if(known_.begin(), known_.end(), is_same);
  if (found == known_.end()) {
    const auto oldest = std::min_element(known_.begin(), known_.end(), [](const auto& a, const auto& b) {
      return a->last_drawn < b->last_drawn;
    });
    if (known_.size() < kKept || (*oldest)->last_drawn == drawings_) {
      known_.push_back(std::make_unique<KnownMesh>());
      found = known_.end() - 1;
    } else {
      found = oldest;
    }
  }
  (*found)->last_drawn = drawings_;
  return **found;
}

void DepthRaster::set_pieces(const GpuMesh& mesh, RasterMesh pieces) {
  KnownMesh& known = known_mesh(mesh);
  known.pieces = std::move(pieces);
  known.mesh = &mesh;
  known.revision = mesh.revision();
}

const RasterMesh& DepthRaster::pieces_of(const GpuMesh& mesh) {
  KnownMesh& known = known_mesh(mesh);
  if (known.mesh != &mesh || known.revision != mesh.revision()) {
    cut_into_pieces(mesh.vertices(), mesh.triangles(), known.pieces);
    known.mesh = &mesh;
    known.revision = mesh.revision();
  }
  return known.pieces;
}

std::size_t DepthRaster::find_visible(std::span<const MeshInstance> scene, const Intrinsics& camera,
                                      const Eigen::Isometry3d& T_world_camera, const PixelRect& rect) {
  Eigen::Matrix3d K;
  K << camera.fx_px, 0.0, camera.cx_px - rect.x, 0.0, camera.fy_px, camera.cy_px - rect.y, 0.0, 0.0, 1.0;
  visible_meshes_.clear();
  visible_pieces_.clear();
  std::size_t triangles = 0;
  for (const MeshInstance& instance : scene) {
    if (instance.mesh == nullptr || instance.mesh->triangle_count() == 0) continue;
    Eigen::Isometry3d T_camera_local = T_world_camera.inverse() * instance.T_world_mesh;
    T_camera_local.translate(instance.mesh->origin());
    const RasterMesh& mesh = pieces_of(*instance.mesh);
    const Projection projection = K * T_camera_local.matrix().topRows<3>();
    visible_meshes_.push_back({&mesh, projection});

    // Planes through the image's borders: one pixel outside, and far outside for pieces that need clipping.
    const auto borders = [&](double aside_px) {
      Eigen::Matrix4d planes;
      planes << projection.row(0) + aside_px * projection.row(2),
          (width_px_ - 1 + aside_px) * projection.row(2) - projection.row(0),
          projection.row(1) + aside_px * projection.row(2),
          (height_px_ - 1 + aside_px) * projection.row(2) - projection.row(1);
      return planes;
    };
    const Eigen::Matrix4d near_borders = borders(1.0), far_borders = borders(kFarAside_px);
    const Eigen::RowVector4d depth = projection.row(2);
    for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
      const Eigen::AlignedBox3d box = mesh.pieces[i].bounds_local.cast<double>();
      const Eigen::Vector3d centre = box.center(), half = 0.5 * box.sizes();
      const Eigen::Vector4d at = centre.homogeneous();
      const Eigen::Vector4d inside = near_borders * at, reach = near_borders.leftCols<3>().cwiseAbs() * half;
      const double depth_m = depth.dot(at), depth_reach_m = depth.head<3>().cwiseAbs().dot(half);
      if (depth_m + depth_reach_m < near_m_ || ((inside + reach).array() < 0.0).any()) continue;
      const bool is_cut =
          depth_m - depth_reach_m < near_m_ ||
          ((far_borders * at - far_borders.leftCols<3>().cwiseAbs() * half).array() < 0.0).any();
      visible_pieces_.push_back(
          {static_cast<std::uint32_t>(visible_meshes_.size() - 1), static_cast<std::uint32_t>(i), is_cut});
      triangles += mesh.pieces[i].triangle_count;
    }
  }
  return triangles;
}

void DepthRaster::paint(Painter& painter) {
  painter.canvas.clear(width_px_, height_px_);
  for (;;) {
    const std::size_t next = next_piece_.fetch_add(1, std::memory_order_relaxed);
    if (next >= visible_pieces_.size()) return;
    const VisiblePiece& visible = visible_pieces_[next];
    const RasterMesh& mesh = *visible_meshes_[visible.mesh].mesh;
    const RasterPiece& piece = mesh.pieces[visible.piece];
    const Projection& projection = visible_meshes_[visible.mesh].projection;
    if (visible.is_cut) {
      paint_cut(mesh, piece, projection, painter);
      continue;
    }
    const Eigen::Matrix<float, 3, 4> p = projection.cast<float>();
    const float *x_m = mesh.x_m.data() + piece.first_vertex, *y_m = mesh.y_m.data() + piece.first_vertex,
                *z_m = mesh.z_m.data() + piece.first_vertex;
    painter.vertices.resize(piece.vertex_count);
    float *u_px = painter.vertices.u_px.data(), *v_px = painter.vertices.v_px.data(),
          *q = painter.vertices.inverse_depth_per_m.data();
    for (std::size_t i = 0; i < piece.vertex_count; ++i) {
      const float inverse = 1.0F / (p(2, 0) * x_m[i] + p(2, 1) * y_m[i] + p(2, 2) * z_m[i] + p(2, 3));
      u_px[i] = (p(0, 0) * x_m[i] + p(0, 1) * y_m[i] + p(0, 2) * z_m[i] + p(0, 3)) * inverse;
      v_px[i] = (p(1, 0) * x_m[i] + p(1, 1) * y_m[i] + p(1, 2) * z_m[i] + p(1, 3)) * inverse;
      q[i] = inverse;
    }
    draw_triangles(painter.vertices,
                   {mesh.triangles.data() + piece.first_triangle, std::size_t{piece.triangle_count}},
                   cull_back_faces_, painter.setup, painter.canvas);
  }
}

/// Draws a piece whose triangles may need clipping, one by one.
void DepthRaster::paint_cut(const RasterMesh& mesh, const RasterPiece& piece, const Projection& projection,
                            Painter& painter) const {
  painter.vertices.resize(0);
  painter.clipped.clear();
  const double last_u = width_px_ - 1 + kFarAside_px, last_v = height_px_ - 1 + kFarAside_px;
  for (std::size_t t = piece.first_triangle; t < piece.first_triangle + piece.triangle_count; ++t) {
    Polygon polygon;
    for (const std::uint16_t corner : mesh.triangles[t]) {
      const std::size_t i = piece.first_vertex + corner;
      polygon.corners[polygon.count++] =
          projection * Eigen::Vector3f(mesh.x_m[i], mesh.y_m[i], mesh.z_m[i]).cast<double>().homogeneous();
    }
    cut([&](const Corner& c) { return c.z() - near_m_; }, polygon);
    cut([&](const Corner& c) { return c.x() + kFarAside_px * c.z(); }, polygon);
    cut([&](const Corner& c) { return last_u * c.z() - c.x(); }, polygon);
    cut([&](const Corner& c) { return c.y() + kFarAside_px * c.z(); }, polygon);
    cut([&](const Corner& c) { return last_v * c.z() - c.y(); }, polygon);
    const std::size_t first = painter.vertices.u_px.size();
    for (std::size_t i = 0; i < polygon.count; ++i) {
      const Corner& c = polygon.corners[i];
      painter.vertices.u_px.push_back(static_cast<float>(c.x() / c.z()));
      painter.vertices.v_px.push_back(static_cast<float>(c.y() / c.z()));
      painter.vertices.inverse_depth_per_m.push_back(static_cast<float>(1.0 / c.z()));
      if (i >= 2)
        painter.clipped.push_back({static_cast<std::uint16_t>(first),
                                   static_cast<std::uint16_t>(first + i - 1),
                                   static_cast<std::uint16_t>(first + i)});
    }
  }
  draw_triangles(painter.vertices, painter.clipped, cull_back_faces_, painter.setup, painter.canvas);
}

std::size_t DepthRaster::render(std::span<const MeshInstance> scene, const Intrinsics& camera,
                                const Eigen::Isometry3d& T_world_camera, const PixelRect& rect,
                                const RasterRules& rules, DepthImage& depth_m) {
  ++drawings_;
  width_px_ = rect.width;
  height_px_ = rect.height;
  near_m_ = rules.near_m;
  cull_back_faces_ = rules.cull_back_faces;
  const std::size_t triangles = find_visible(scene, camera, T_world_camera, rect);

  next_piece_ = 0;
  const bool alone = visible_pieces_.size() < kWorthTwo;
  const auto lay_over = [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      const float* one = painters_[0].canvas.row(y);
      const float* other = painters_[alone ? 0 : 1].canvas.row(y);
      float* out = depth_m.row(rect.y + y) + rect.x;
      for (int x = 0; x < rect.width; ++x) {
        const float q = std::max(one[x], other[x]);
        out[x] = q > 0.0F ? 1.0F / q : 0.0F;
      }
    }
  };
  if (alone) {
    paint(painters_[0]);
    lay_over(0, height_px_);
    return triangles;
  }
  second_.run([&] { paint(painters_[0]); }, [&] { paint(painters_[1]); });
  second_.run([&] { lay_over(0, height_px_ / 2); }, [&] { lay_over(height_px_ / 2, height_px_); });
  return triangles;
}

}  // namespace roomradar
