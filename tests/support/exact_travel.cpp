// exact_travel.cpp: least gap between projected triangles, found at vertices or crossings of edges.
#include "tests/support/exact_travel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

struct OutlinedCorners {
  ExactTriangle p;
  Eigen::AlignedBox2d outline;
  double min_z = 0.0, max_z = 0.0;  // rounded outwards, like the outline
};

OutlinedCorners corners_of(const ExactTriangle& p) {
  OutlinedCorners corners{p, {}, 0.0, 0.0};
  const ExactPoint low = p[0].cwiseMin(p[1]).cwiseMin(p[2]);
  const ExactPoint high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
  const Exact beyond = 1e-11L * (high - low).maxCoeff();  // more than exact_gap's tolerance for touching
  const Eigen::Vector3d low_m = (low.array() - beyond).matrix().cast<double>();
  const Eigen::Vector3d high_m = (high.array() + beyond).matrix().cast<double>();
  corners.outline = Eigen::AlignedBox2d(low_m.head<2>(), high_m.head<2>());
  corners.min_z = low_m.z();
  corners.max_z = high_m.z();
  return corners;
}

/// Returns the least distance >= -slack_m at which the two triangles touch, or infinity.
double travel_of_pair(const OutlinedCorners& object, const OutlinedCorners& scene, double slack_m) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if (!object.outline.intersects(scene.outline)) return kNever;
  const auto span = exact_gap(object.p, scene.p);
  if (!span || span->to_m < -slack_m) return kNever;
  return std::max(span->from_m, -slack_m);
}

/// z along the direction, origin at the object's.
struct Frame {
  Eigen::Matrix<Exact, 3, 3> R_frame_world;
  ExactPoint origin_world;
};

Frame frame_of(const Eigen::Isometry3d& T_world_object, const Mesh& object,
               const Eigen::Vector3d& direction_world) {
  if (!direction_world.allFinite() || !(direction_world.stableNorm() > 0.0)) {
    throw Error("exact_travel: direction must be finite and not zero");
  }
  const ExactPoint u = direction_world.cast<Exact>().stableNormalized();
  const ExactPoint x = u.unitOrthogonal();
  Frame frame;
  frame.R_frame_world << x.transpose(), u.cross(x).transpose(), u.transpose();
  frame.origin_world = (T_world_object * object.origin).cast<Exact>();
  return frame;
}

/// Returns the triangles whose outline overlaps the area.
std::vector<OutlinedCorners> triangles_in_frame(const Mesh& mesh, const Eigen::Isometry3d& T_world_mesh,
                                                const Frame& frame, const Eigen::AlignedBox2d& area) {
  const Eigen::Matrix<Exact, 3, 3> R_world_mesh = T_world_mesh.linear().cast<Exact>();
  const Eigen::Matrix<Exact, 3, 3> R_frame_mesh = frame.R_frame_world * R_world_mesh;
  const ExactPoint t_world_mesh = T_world_mesh.translation().cast<Exact>();
  const ExactPoint shift =
      frame.R_frame_world * (R_world_mesh * mesh.origin.cast<Exact>() + (t_world_mesh - frame.origin_world));
  std::vector<ExactPoint> vertices;
  vertices.reserve(mesh.vertices.size());
  for (const Eigen::Vector3f& p : mesh.vertices) vertices.push_back(R_frame_mesh * p.cast<Exact>() + shift);
  std::vector<OutlinedCorners> result;
  for (const Triangle& triangle : mesh.triangles) {
    const bool is_usable = std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t i) {
      return i < mesh.vertices.size() && mesh.vertices[i].allFinite();
    });
    if (!is_usable) continue;
    const OutlinedCorners corners =
        corners_of({vertices[triangle[0]], vertices[triangle[1]], vertices[triangle[2]]});
    if (corners.outline.intersects(area)) result.push_back(corners);
  }
  return result;
}

Eigen::AlignedBox2d everywhere() {
  const Eigen::Vector2d far_m = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  return {-far_m, far_m};
}

Eigen::AlignedBox2d outline_of(std::span<const OutlinedCorners> object) {
  Eigen::AlignedBox2d area;
  for (const OutlinedCorners& o : object) area.extend(o.outline);
  return area;
}

/// Scene triangles by the cells of a square grid over the object's outline.
class Grid {
 public:
  Grid(const Eigen::AlignedBox2d& area, std::span<const OutlinedCorners> scene) : area_(area) {
    side_ = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(scene.size()) / 2.0)), 1, 512);
    cells_.resize(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_));
    for (std::size_t i = 0; i < scene.size(); ++i) {
      visit(scene[i].outline, [&](std::vector<std::size_t>& cell) { cell.push_back(i); });
    }
  }
  template <typename Work>
  void visit(const Eigen::AlignedBox2d& outline, const Work& work) {
    const auto cell_of = [&](double v, int axis) {
      const double size = std::max(area_.sizes()[axis], 1e-12) / side_;
      return static_cast<int>(std::clamp((v - area_.min()[axis]) / size, 0.0, side_ - 1.0));
    };
    constexpr double kMargin_m = 1e-9;  // rounding must not separate neighbours
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

/// Returns the union of the spans, ascending; spans that touch up to rounding are merged.
std::vector<TravelSpan> joined(std::vector<TravelSpan> spans) {
  constexpr double kRounding_m = 1e-12;
  std::sort(spans.begin(), spans.end(),
            [](const TravelSpan& a, const TravelSpan& b) { return a.from_m < b.from_m; });
  std::vector<TravelSpan> result;
  for (const TravelSpan& span : spans) {
    if (!result.empty() && span.from_m <= result.back().to_m + kRounding_m) {
      result.back().to_m = std::max(result.back().to_m, span.to_m);
    } else {
      result.push_back(span);
    }
  }
  return result;
}

}  // namespace

std::optional<double> exact_travel(const Mesh& object, const Eigen::Isometry3d& T_world_object,
                                   const Eigen::Vector3d& direction_world, double distance_m,
                                   const Mesh& scene, const Eigen::Isometry3d& T_world_scene,
                                   ExactMethod method, double slack_m) {
  if (!(distance_m >= 0.0) || !std::isfinite(distance_m)) {
    throw Error("exact_travel: distance_m = " + std::to_string(distance_m) + ": must be finite and >= 0");
  }
  const Frame frame = frame_of(T_world_object, object, direction_world);
  std::vector<OutlinedCorners> object_triangles =
      triangles_in_frame(object, T_world_object, frame, everywhere());
  const Eigen::AlignedBox2d area = outline_of(object_triangles);
  const std::vector<OutlinedCorners> scene_triangles = triangles_in_frame(scene, T_world_scene, frame, area);

  double least_m = std::numeric_limits<double>::infinity();
  if (method == ExactMethod::kBruteForce) {
    for (const OutlinedCorners& o : object_triangles) {
      for (const OutlinedCorners& s : scene_triangles)
        least_m = std::min(least_m, travel_of_pair(o, s, slack_m));
    }
  } else {
    Grid grid(area, scene_triangles);
    // Foremost triangles first: an early, small bound rules out most of the rest.
    std::sort(object_triangles.begin(), object_triangles.end(),
              [](const OutlinedCorners& a, const OutlinedCorners& b) { return a.max_z > b.max_z; });
    for (const OutlinedCorners& o : object_triangles) {
      grid.visit(o.outline, [&](const std::vector<std::size_t>& cell) {
        for (const std::size_t i : cell) {
          const OutlinedCorners& s = scene_triangles[i];
          const bool is_behind = s.max_z - o.min_z < -slack_m;
          if (is_behind || s.min_z - o.max_z >= least_m) continue;
          least_m = std::min(least_m, travel_of_pair(o, s, slack_m));
        }
      });
    }
  }
  if (!(least_m <= distance_m)) return std::nullopt;
  return least_m;
}

std::vector<TravelSpan> exact_crossings(const Mesh& object, const Eigen::Isometry3d& T_world_object,
                                        const Eigen::Vector3d& direction_world, const Mesh& scene,
                                        const Eigen::Isometry3d& T_world_scene) {
  const Frame frame = frame_of(T_world_object, object, direction_world);
  const std::vector<OutlinedCorners> object_triangles =
      triangles_in_frame(object, T_world_object, frame, everywhere());
  const Eigen::AlignedBox2d area = outline_of(object_triangles);
  const std::vector<OutlinedCorners> scene_triangles = triangles_in_frame(scene, T_world_scene, frame, area);
  Grid grid(area, scene_triangles);
  std::vector<TravelSpan> spans;
  for (const OutlinedCorners& o : object_triangles) {
    grid.visit(o.outline, [&](const std::vector<std::size_t>& cell) {
      for (const std::size_t i : cell) {
        if (!o.outline.intersects(scene_triangles[i].outline)) continue;
        if (const auto span = exact_gap(o.p, scene_triangles[i].p)) spans.push_back(*span);
      }
    });
  }
  return joined(std::move(spans));
}

std::optional<TravelSpan> exact_overlap(std::span<const TravelSpan> crossings) {
  for (const TravelSpan& span : crossings) {
    if (span.from_m < 0.0 && span.to_m > 0.0) return span;
  }
  return std::nullopt;
}

}  // namespace roomradar
