// exact_travel.cpp: gaps between projected triangles, which are least where corners or edges cross.
#include "radar/exact_travel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "mapping/types/error.hpp"

namespace roomradar {
namespace {

using Point = Eigen::Vector3d;  // x, y across the direction, z along it
struct Corners {
  std::array<Point, 3> p;
  [[nodiscard]] Eigen::AlignedBox2d outline() const {
    Eigen::AlignedBox2d box;
    for (const Point& corner : p) box.extend(corner.head<2>());
    return box;
  }
  [[nodiscard]] double min_z() const { return std::min({p[0].z(), p[1].z(), p[2].z()}); }
  [[nodiscard]] double max_z() const { return std::max({p[0].z(), p[1].z(), p[2].z()}); }
};

double cross2(const Point& a, const Point& b, const Point& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Height of the triangle where p projects into it, its outline included.
std::optional<double> height_at(const Corners& t, const Point& p) {
  const double area = cross2(t.p[0], t.p[1], t.p[2]);
  if (area == 0.0) return std::nullopt;  // edge-on: its edges speak for it
  const double w0 = cross2(t.p[1], t.p[2], p) / area;
  const double w1 = cross2(t.p[2], t.p[0], p) / area;
  const double w2 = cross2(t.p[0], t.p[1], p) / area;
  if (w0 < 0.0 || w1 < 0.0 || w2 < 0.0) return std::nullopt;
  return w0 * t.p[0].z() + w1 * t.p[1].z() + w2 * t.p[2].z();
}

/// Height of edge b above edge a where their projections cross, ends included.
std::optional<double> gap_of_edges(const Point& a0, const Point& a1, const Point& b0, const Point& b1) {
  const double dx = a1.x() - a0.x(), dy = a1.y() - a0.y();
  const double ex = b1.x() - b0.x(), ey = b1.y() - b0.y();
  const double crossing = dx * ey - dy * ex;
  if (crossing == 0.0) return std::nullopt;
  const double s = ((b0.x() - a0.x()) * ey - (b0.y() - a0.y()) * ex) / crossing;
  const double t = ((b0.x() - a0.x()) * dy - (b0.y() - a0.y()) * dx) / crossing;
  if (s < 0.0 || s > 1.0 || t < 0.0 || t > 1.0) return std::nullopt;
  return b0.z() + t * (b1.z() - b0.z()) - (a0.z() + s * (a1.z() - a0.z()));
}

/// Least travel >= -slack_m at which the two touch, or infinity.
double travel_of_pair(const Corners& object, const Corners& scene, double slack_m) {
  double least_m = std::numeric_limits<double>::infinity();
  double lowest_m = least_m;
  double highest_m = -least_m;
  const auto put = [&](double gap_m) {
    lowest_m = std::min(lowest_m, gap_m);
    highest_m = std::max(highest_m, gap_m);
    if (gap_m >= -slack_m) least_m = std::min(least_m, gap_m);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    if (const auto z = height_at(scene, object.p[i])) put(*z - object.p[i].z());
    if (const auto z = height_at(object, scene.p[i])) put(scene.p[i].z() - *z);
    for (std::size_t j = 0; j < 3; ++j) {
      const auto gap_m = gap_of_edges(object.p[i], object.p[(i + 1) % 3], scene.p[j], scene.p[(j + 1) % 3]);
      if (gap_m) put(*gap_m);
    }
  }
  // They cross already where the gap changes sign over their common outline.
  if (lowest_m < -slack_m && highest_m > -slack_m) return -slack_m;
  return least_m;
}

std::vector<Corners> triangles_in_frame(const Mesh& mesh, const Eigen::Isometry3d& T_world_mesh,
                                        const Eigen::Matrix3d& R_frame_world,
                                        const Eigen::Vector3d& origin_world) {
  const Eigen::Matrix3d R_frame_mesh = R_frame_world * T_world_mesh.linear();
  const Eigen::Vector3d shift = R_frame_world * (T_world_mesh * mesh.origin - origin_world);
  std::vector<Corners> result;
  result.reserve(mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles) {
    Corners corners;
    bool is_usable = true;
    for (std::size_t i = 0; i < 3 && is_usable; ++i) {
      is_usable = triangle[i] < mesh.vertices.size() && mesh.vertices[triangle[i]].allFinite();
      if (is_usable) corners.p[i] = R_frame_mesh * mesh.vertices[triangle[i]].cast<double>() + shift;
    }
    if (is_usable) result.push_back(corners);
  }
  return result;
}

/// Scene triangles by the cells of a square grid over the object's outline.
class Grid {
 public:
  Grid(const Eigen::AlignedBox2d& area, std::span<const Corners> scene) : area_(area) {
    side_ = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(scene.size()) / 2.0)), 1, 512);
    cells_.resize(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_));
    for (std::size_t i = 0; i < scene.size(); ++i) {
      if (!scene[i].outline().intersects(area)) continue;
      visit(scene[i].outline(), [&](std::vector<std::size_t>& cell) { cell.push_back(i); });
    }
  }
  template <typename Work>
  void visit(const Eigen::AlignedBox2d& outline, const Work& work) {
    const auto cell_of = [&](double v, int axis) {
      const double size = std::max(area_.sizes()[axis], 1e-12) / side_;
      return static_cast<int>(std::clamp((v - area_.min()[axis]) / size, 0.0, side_ - 1.0));
    };
    constexpr double kMargin_m = 1e-9;  // rounding must not part neighbours
    for (int y = cell_of(outline.min().y() - kMargin_m, 1); y <= cell_of(outline.max().y() + kMargin_m, 1);
         ++y) {
      for (int x = cell_of(outline.min().x() - kMargin_m, 0); x <= cell_of(outline.max().x() + kMargin_m, 0);
           ++x) {
        work(cells_[static_cast<std::size_t>(y) * static_cast<std::size_t>(side_) +
                    static_cast<std::size_t>(x)]);
      }
    }
  }

 private:
  Eigen::AlignedBox2d area_;
  int side_ = 1;
  std::vector<std::vector<std::size_t>> cells_;
};

}  // namespace

std::optional<double> exact_travel(const Mesh& object, const Eigen::Isometry3d& T_world_object,
                                   const Eigen::Vector3d& direction_world, double distance_m,
                                   const Mesh& scene, const Eigen::Isometry3d& T_world_scene,
                                   ExactMethod method, double slack_m) {
  const double norm = direction_world.stableNorm();
  if (!direction_world.allFinite() || !(norm > 0.0)) {
    throw Error("exact_travel: direction must be finite and not zero");
  }
  if (!(distance_m >= 0.0) || !std::isfinite(distance_m)) {
    throw Error("exact_travel: distance_m = " + std::to_string(distance_m) + ": must be finite and >= 0");
  }
  const Eigen::Vector3d u = direction_world / norm;
  const Eigen::Vector3d x = u.unitOrthogonal();
  Eigen::Matrix3d R_frame_world;
  R_frame_world << x.transpose(), u.cross(x).transpose(), u.transpose();
  const Eigen::Vector3d origin_world = T_world_object * object.origin;
  std::vector<Corners> object_triangles =
      triangles_in_frame(object, T_world_object, R_frame_world, origin_world);
  const std::vector<Corners> scene_triangles =
      triangles_in_frame(scene, T_world_scene, R_frame_world, origin_world);

  double least_m = std::numeric_limits<double>::infinity();
  if (method == ExactMethod::kBruteForce) {
    for (const Corners& o : object_triangles) {
      for (const Corners& s : scene_triangles) least_m = std::min(least_m, travel_of_pair(o, s, slack_m));
    }
  } else {
    Eigen::AlignedBox2d area;
    for (const Corners& o : object_triangles) area.extend(o.outline());
    Grid grid(area, scene_triangles);
    // Foremost triangles first: the bound found early rules out most of the rest.
    std::sort(object_triangles.begin(), object_triangles.end(),
              [](const Corners& a, const Corners& b) { return a.max_z() > b.max_z(); });
    for (const Corners& o : object_triangles) {
      grid.visit(o.outline(), [&](const std::vector<std::size_t>& cell) {
        for (const std::size_t i : cell) {
          const Corners& s = scene_triangles[i];
          const bool is_behind = s.max_z() - o.min_z() < -slack_m;
          if (is_behind || s.min_z() - o.max_z() >= least_m) continue;
          least_m = std::min(least_m, travel_of_pair(o, s, slack_m));
        }
      });
    }
  }
  if (!(least_m <= distance_m)) return std::nullopt;
  return least_m;
}

}  // namespace roomradar
