// correlative_search.cpp: scores a depth image's points on a grid of the room at every position and heading.
#include "mapping/localization/correlative_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mapping/alignment/align.hpp"
#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kCoarse_m = 0.15;
constexpr double kMostCells = 5e5;
constexpr float kNearest_m = 0.4F, kFarthest_m = 5.0F;  // beyond 5 m a Kinect's noise exceeds a cube
/// Max ratio of a ray's length to its depth: 84 degrees from the optical axis.
constexpr float kWidest = 10.0F;
constexpr int kHeadings = 72;

/// Returns points of an image on a lattice of `columns` x `rows` pixels; empty if the image is too small.
std::vector<Vector3f> points_of(const DepthImage& depth_m, const Intrinsics& camera, int columns, int rows) {
  std::vector<Vector3f> points;
  if (depth_m.width < 2 * columns || depth_m.height < 2 * rows) return points;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int x = (2 * i + 1) * depth_m.width / (2 * columns);
      const int y = (2 * j + 1) * depth_m.height / (2 * rows);
      const float depth = depth_m.at(x, y);
      if (depth > kNearest_m && depth < kFarthest_m)
        points.push_back(back_project(camera, x, y, static_cast<double>(depth)).cast<float>());
    }
  }
  return points;
}

/// Returns points of all previews, in the world, except points that a damaged camera places kilometres away.
std::vector<Vector3f> points_of(const KeyframeDatabase& keyframe_database) {
  constexpr int kStep_px = 2;
  std::vector<Vector3f> points;
  for (const MapKeyframe& place : keyframe_database.keyframes) {
    const Eigen::Isometry3f T_world_camera = place.T_world_camera.cast<float>();
    for (int y = 0; y < place.preview_depth_mm.height; y += kStep_px) {
      for (int x = 0; x < place.preview_depth_mm.width; x += kStep_px) {
        const float depth = 0.001F * static_cast<float>(place.preview_depth_mm.at(x, y));
        if (!(depth > kNearest_m && depth < kFarthest_m)) continue;
        const Vector3f p_camera =
            back_project(place.preview_camera, x, y, static_cast<double>(depth)).cast<float>();
        if (p_camera.norm() < kWidest * kFarthest_m) points.emplace_back(T_world_camera * p_camera);
      }
    }
  }
  return points;
}

std::size_t index_in(const ShapeGrid& grid, int x, int y, int z) {
  return (static_cast<std::size_t>(z) * static_cast<std::size_t>(grid.size[1]) +
          static_cast<std::size_t>(y)) *
             static_cast<std::size_t>(grid.size[0]) +
         static_cast<std::size_t>(x);
}

/// One pass of a squared distance transform (cells) along one axis, limited to kReach_cells. Source:
/// Felzenszwalb and Huttenlocher, Distance Transforms of Sampled Functions, 2012.
void spread(std::vector<int>& squares, int count, std::size_t stride, std::size_t first) {
  constexpr int kReach = ShapeGrid::kReach_cells;
  std::vector<int> line(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    line[static_cast<std::size_t>(i)] = squares[first + static_cast<std::size_t>(i) * stride];
  for (int i = 0; i < count; ++i) {
    int& least = squares[first + static_cast<std::size_t>(i) * stride];
    for (int k = std::max(i - kReach, 0); k <= std::min(i + kReach, count - 1); ++k)
      least = std::min(least, line[static_cast<std::size_t>(k)] + (i - k) * (i - k));
  }
}

constexpr double kRim_cells = 2.0;

/// Returns the number of cubes along x, y, z for a box with these edges and a rim.
Eigen::Array3d cells_across(const Vector3d& edges_m, double cell_m) {
  return (edges_m.array() / cell_m + 2.0 * kRim_cells).floor() + 1.0;
}

ShapeGrid grid_of(const std::vector<Vector3f>& points, const Eigen::AlignedBox3f& box, double cell_m) {
  constexpr int kFew = 3;  // cubes with fewer points may be noise
  constexpr int kFar = ShapeGrid::kReach_cells * ShapeGrid::kReach_cells;
  ShapeGrid grid;
  grid.cell_m = cell_m;
  grid.low = box.min().cast<double>() - Vector3d::Constant(kRim_cells * cell_m);
  const Eigen::Array3i across = cells_across(box.sizes().cast<double>(), cell_m).cast<int>();
  grid.size = {across.x(), across.y(), across.z()};
  std::vector<int> squares(index_in(grid, 0, 0, grid.size[2]), 0);
  for (const Vector3f& p : points) {
    const Eigen::Vector3i cell = ((p.cast<double>() - grid.low) / cell_m).cast<int>();
    ++squares[index_in(grid, cell.x(), cell.y(), cell.z())];
  }
  for (int& cell : squares) cell = cell >= kFew ? 0 : 2 * kFar;
  for (int z = 0; z < grid.size[2]; ++z)
    for (int y = 0; y < grid.size[1]; ++y) spread(squares, grid.size[0], 1, index_in(grid, 0, y, z));
  for (int z = 0; z < grid.size[2]; ++z)
    for (int x = 0; x < grid.size[0]; ++x)
      spread(squares, grid.size[1], index_in(grid, 0, 1, 0), index_in(grid, x, 0, z));
  for (int y = 0; y < grid.size[1]; ++y)
    for (int x = 0; x < grid.size[0]; ++x)
      spread(squares, grid.size[2], index_in(grid, 0, 0, 1), index_in(grid, x, y, 0));
  grid.nearness.resize(squares.size());
  std::transform(squares.begin(), squares.end(), grid.nearness.begin(), [](int square) {
    const double part = 1.0 - std::sqrt(static_cast<double>(square)) / ShapeGrid::kReach_cells;
    return static_cast<std::uint8_t>(std::lround(ShapeGrid::kOnSurface * std::max(part, 0.0)));
  });
  return grid;
}

/// Nearness (0..1) interpolated between the cubes' centres, and its gradient (1/m); 0 outside.
struct Near {
  float value = 0.0F;
  Vector3f slope_per_m = Vector3f::Zero();
};
Near near_at(const ShapeGrid& grid, const Vector3f& p_world) {
  const Vector3f at =
      (p_world - grid.low.cast<float>()) / static_cast<float>(grid.cell_m) - Vector3f::Constant(0.5F);
  const Vector3f floor = at.array().floor();
  if (!(floor.minCoeff() >= 0.0F)) return {};
  const Eigen::Vector3i cell = floor.cast<int>();
  for (int axis = 0; axis < 3; ++axis)
    if (cell(axis) + 1 >= grid.size[static_cast<std::size_t>(axis)]) return {};
  const Vector3f f = at - floor;
  std::array<float, 8> corner;
  for (int k = 0; k < 8; ++k)
    corner[static_cast<std::size_t>(k)] = static_cast<float>(
        grid.nearness[index_in(grid, cell.x() + (k & 1), cell.y() + (k >> 1 & 1), cell.z() + (k >> 2))]);
  const auto mix = [](float a, float b, float t) { return a + t * (b - a); };
  const float y0z0 = mix(corner[0], corner[1], f.x()), y1z0 = mix(corner[2], corner[3], f.x());
  const float y0z1 = mix(corner[4], corner[5], f.x()), y1z1 = mix(corner[6], corner[7], f.x());
  const float z0 = mix(y0z0, y1z0, f.y()), z1 = mix(y0z1, y1z1, f.y());
  Near near;
  near.value = mix(z0, z1, f.z()) / ShapeGrid::kOnSurface;
  const float dx0 = mix(corner[1] - corner[0], corner[3] - corner[2], f.y());
  const float dx1 = mix(corner[5] - corner[4], corner[7] - corner[6], f.y());
  near.slope_per_m = Vector3f(mix(dx0, dx1, f.z()), mix(y1z0 - y0z0, y1z1 - y0z1, f.z()), z1 - z0) /
                     (ShapeGrid::kOnSurface * static_cast<float>(grid.cell_m));
  return near;
}

double mean_nearness(const ShapeGrid& grid, const std::vector<Vector3f>& points,
                     const Eigen::Isometry3d& T_world_camera) {
  const Eigen::Isometry3f T = T_world_camera.cast<float>();
  float sum = 0.0F;
  for (const Vector3f& p : points) sum += near_at(grid, T * p).value;
  return static_cast<double>(sum) / static_cast<double>(points.size());
}

/// Refines a pose to bring its points nearer to surfaces (Gauss-Newton, six degrees of freedom).
Eigen::Isometry3d refined_pose(const ShapeGrid& grid, const std::vector<Vector3f>& points,
                               Eigen::Isometry3d T_world_camera) {
  constexpr int kIterations = 8;
  constexpr double kDamping = 0.02;  // of the mean diagonal: unconstrained directions stay
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Eigen::Isometry3f T = T_world_camera.cast<float>();
    Eigen::Matrix<float, 6, 6> H = Eigen::Matrix<float, 6, 6>::Zero();
    Eigen::Matrix<float, 6, 1> g = Eigen::Matrix<float, 6, 1>::Zero();
    for (const Vector3f& p : points) {
      const Near near = near_at(grid, T * p);
      if (near.value <= 0.0F) continue;
      const Vector3f m = T.linear().transpose() * near.slope_per_m;
      Eigen::Matrix<float, 6, 1> J;
      J << m, p.cross(m);
      const float weight = near.value * near.value;  // points on no surface have no weight
      H += weight * J * J.transpose();
      g += weight * (1.0F - near.value) * J;
    }
    Matrix6d damped = H.cast<double>();
    damped.diagonal().array() += kDamping * damped.trace() / 6.0 + 1e-6;
    const Vector6d twist = solve_symmetric(damped, g.cast<double>());
    if (!twist.allFinite() || twist.norm() > 0.5) break;
    T_world_camera = T_world_camera * retract(twist);
    if (twist.norm() < 2e-3) break;
  }
  return T_world_camera;
}

/// Candidate pose: the camera's cube and heading.
struct Vote {
  int score = 0;
  int heading = 0;
  std::array<int, 3> cell{};
};

/// Adds the grid, shifted by this many cubes, to the scores: one point's nearness for every camera cube.
void add_shifted(const ShapeGrid& grid, const Eigen::Vector3i& shift, std::vector<std::uint16_t>& scores) {
  const auto begin = [&](int axis) { return std::max(0, -shift(axis)); };
  const auto end = [&](int axis) {
    return std::min(grid.size[static_cast<std::size_t>(axis)],
                    grid.size[static_cast<std::size_t>(axis)] - shift(axis));
  };
  const int count = end(0) - begin(0);
  if (count <= 0) return;
  for (int z = begin(2); z < end(2); ++z) {
    for (int y = begin(1); y < end(1); ++y) {
      std::uint16_t* to = scores.data() + index_in(grid, begin(0), y, z);
      const std::uint8_t* from =
          grid.nearness.data() + index_in(grid, begin(0) + shift.x(), y + shift.y(), z + shift.z());
      for (int x = 0; x < count; ++x) to[x] = static_cast<std::uint16_t>(to[x] + from[x]);
    }
  }
}

/// Appends the best cube of each block of 5 x 5 columns, about a square metre, for one heading.
void take_best(const ShapeGrid& grid, const std::vector<std::uint16_t>& scores, int heading,
               std::vector<Vote>& votes) {
  constexpr int kBlock = 5;  // cubes
  for (int y0 = 0; y0 < grid.size[1]; y0 += kBlock) {
    for (int x0 = 0; x0 < grid.size[0]; x0 += kBlock) {
      Vote best;
      for (int z = 0; z < grid.size[2]; ++z)
        for (int y = y0; y < std::min(y0 + kBlock, grid.size[1]); ++y)
          for (int x = x0; x < std::min(x0 + kBlock, grid.size[0]); ++x)
            if (const int score = scores[index_in(grid, x, y, z)]; score > best.score)
              best = {score, heading, {x, y, z}};
      if (best.score > 0) votes.push_back(best);
    }
  }
}

bool is_same_candidate(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  const Eigen::Isometry3d gap = a.inverse() * b;
  return gap.translation().norm() < 0.2 && Eigen::AngleAxisd(gap.linear()).angle() < 0.15;
}

/// Keeps the best `count` candidates that are distinct poses, best first.
void keep_distinct(std::size_t count, std::vector<ShapeCandidate>& candidates) {
  const auto is_nearer = [](const ShapeCandidate& a, const ShapeCandidate& b) {
    return a.nearness > b.nearness;
  };
  std::stable_sort(candidates.begin(), candidates.end(), is_nearer);
  std::vector<ShapeCandidate> distinct;
  for (const ShapeCandidate& candidate : candidates) {
    if (distinct.size() == count) break;
    if (std::none_of(distinct.begin(), distinct.end(), [&](const ShapeCandidate& other) {
          return is_same_candidate(candidate.T_world_camera, other.T_world_camera);
        }))
      distinct.push_back(candidate);
  }
  candidates = std::move(distinct);
}

/// Returns at most `count` of the points, evenly spread.
std::vector<Vector3f> thinned(const std::vector<Vector3f>& points, std::size_t count) {
  std::vector<Vector3f> chosen;
  const std::size_t kept = std::min(points.size(), count);
  for (std::size_t i = 0; i < kept; ++i) chosen.push_back(points[i * points.size() / kept]);
  return chosen;
}

/// Searches by few points on the coarse grid, then refines by more on the fine one.
/// @param points  at most 257: their nearness is summed in 16 bits
std::vector<ShapeCandidate> search(const std::vector<Vector3f>& points,
                                   const std::vector<Vector3f>& more_points, const Vector3d& down_camera,
                                   const ShapeIndex& known, std::size_t most) {
  constexpr std::size_t kMinPoints = 30, kSettled = 200;
  std::vector<ShapeCandidate> candidates;
  if (points.size() < kMinPoints || known.empty() || !(std::abs(down_camera.norm() - 1.0) < 0.1))
    return candidates;
  const Eigen::Matrix3d R_level_camera = rotation_between(down_camera, -Vector3d::UnitZ()).toRotationMatrix();
  const ShapeGrid& grid = known.coarse;
  const auto R_world_camera = [&](int heading) -> Eigen::Matrix3d {
    const double angle_rad = 2.0 * std::numbers::pi * heading / kHeadings;
    return Eigen::AngleAxisd(angle_rad, Vector3d::UnitZ()) * R_level_camera;
  };

  std::vector<Vote> votes;
  std::vector<std::uint16_t> scores(grid.nearness.size());
  for (int heading = 0; heading < kHeadings; ++heading) {
    std::fill(scores.begin(), scores.end(), std::uint16_t{0});
    const Eigen::Matrix3f R = (R_world_camera(heading) / grid.cell_m).cast<float>();
    for (const Vector3f& p : points) {
      const Vector3f shift = (R * p).array().round();
      add_shifted(grid, shift.cast<int>(), scores);
    }
    take_best(grid, scores, heading, votes);
  }
  std::stable_sort(votes.begin(), votes.end(),
                   [](const Vote& a, const Vote& b) { return a.score > b.score; });
  votes.resize(std::min(votes.size(), kSettled));

  for (const Vote& vote : votes) {
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    T_world_camera.linear() = R_world_camera(vote.heading);
    for (int axis = 0; axis < 3; ++axis)
      T_world_camera.translation()(axis) =
          grid.low(axis) + grid.cell_m * (vote.cell[static_cast<std::size_t>(axis)] + 0.5);
    T_world_camera = refined_pose(known.coarse, points, T_world_camera);
    candidates.push_back({T_world_camera, mean_nearness(known.coarse, points, T_world_camera)});
  }
  keep_distinct(4 * most, candidates);
  for (ShapeCandidate& candidate : candidates) {
    candidate.T_world_camera = refined_pose(known.fine, more_points, candidate.T_world_camera);
    candidate.nearness = mean_nearness(known.fine, more_points, candidate.T_world_camera);
  }
  keep_distinct(most, candidates);
  return candidates;
}

}  // namespace

ShapeIndex shape_index(const KeyframeDatabase& keyframe_database) {
  const std::vector<Vector3f> points = points_of(keyframe_database);
  if (points.empty()) return {};
  Eigen::AlignedBox3f box;
  for (const Vector3f& p : points) box.extend(p);
  double coarse_m = kCoarse_m;
  const auto cells = [&] { return cells_across(box.sizes().cast<double>(), coarse_m).prod(); };
  while (cells() > kMostCells) coarse_m *= std::max(1.02, std::cbrt(cells() / kMostCells));
  return {grid_of(points, box, coarse_m), grid_of(points, box, 0.5 * coarse_m)};
}

std::vector<ShapeCandidate> search_by_shape(const DepthImage& depth_m, const Intrinsics& camera,
                                            const Vector3d& down_camera, const ShapeIndex& known,
                                            std::size_t most) {
  return search(points_of(depth_m, camera, 10, 8), points_of(depth_m, camera, 20, 15), down_camera, known,
                most);
}

std::vector<ShapeCandidate> search_by_shape(const std::vector<Vector3f>& points, const Vector3d& down,
                                            const ShapeIndex& known, std::size_t most) {
  constexpr std::size_t kFew = 240, kMany = 2000;
  return search(thinned(points, kFew), thinned(points, kMany), down, known, most);
}

}  // namespace roomradar
