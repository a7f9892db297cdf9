// calibration_problem.cpp: residuals of corners and depth, and priors of the depth correction.
#include "app/calibration/calibration_problem.hpp"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include "app/calibration/calibration.hpp"
#include "mapping/types/depth_noise.hpp"

namespace roomradar {
namespace {

constexpr double kCornerSigma_px = 0.15;
// Depth sigmas are inflated: adjacent samples share most of their noise, and the board is not perfectly flat.
constexpr double kDepthSigmas = 2.0;
// Priors on the correction: its sigma, and the sigma of the difference between adjacent nodes.
constexpr double kNodeStep_per_m = 8e-4;
constexpr double kNodeSize_per_m = 0.02;
constexpr double kRobust_sigmas = 3.0;

struct CornerError {
  Eigen::Vector3d p_board;
  Eigen::Vector2d seen_px;

  template <typename T>
  bool operator()(const T* camera, const T* T_colour_board, T* residual) const {
    const std::array<T, 3> on_board{T(p_board.x()), T(p_board.y()), T(p_board.z())};
    std::array<T, 3> p;
    ceres::AngleAxisRotatePoint(T_colour_board, on_board.data(), p.data());
    for (std::size_t i = 0; i < 3; ++i) p[i] += T_colour_board[3 + i];
    if (!(p[2] > T(1e-3)))
      p[2] = T(1e-3);  // large residual if a solver step moves the board behind the
                       // camera
    const PlanePoint<T> at = distorted(PlanePoint<T>{p[0] / p[2], p[1] / p[2]}, camera[4], camera[5],
                                       camera[6], camera[7], camera[8]);
    residual[0] = (camera[0] * at.x + camera[2] - seen_px.x()) / kCornerSigma_px;
    residual[1] = (camera[1] * at.y + camera[3] - seen_px.y()) / kCornerSigma_px;
    return true;
  }
};

struct DepthError {
  DepthSample sample;
  GridPlace place;
  double sigma_per_m;

  /// The last four parameters are nodes of the depth correction.
  template <typename T>
  bool operator()(const T* camera, const T* T_colour_depth, const T* T_colour_board, const T* inverse_scale,
                  const T* up_left, const T* up_right, const T* down_left, const T* down_right,
                  T* residual) const {
    const PlanePoint<T> ray_plane = undistorted(
        PlanePoint<T>{(sample.x_px - camera[2]) / camera[0], (sample.y_px - camera[3]) / camera[1]},
        camera[4], camera[5], camera[6], camera[7], camera[8]);
    // Plane in the colour camera's frame: n . p = distance; the point at depth z of the ray is R ray z + t.
    const std::array<T, 3> z_board{T(0), T(0), T(1)};
    std::array<T, 3> n, ray;
    ceres::AngleAxisRotatePoint(T_colour_board, z_board.data(), n.data());
    const std::array<T, 3> ray_depth{ray_plane.x, ray_plane.y, T(1)};
    ceres::AngleAxisRotatePoint(T_colour_depth, ray_depth.data(), ray.data());
    T distance(0), along(0);
    for (std::size_t i = 0; i < 3; ++i) {
      distance += n[i] * (T_colour_board[3 + i] - T_colour_depth[3 + i]);
      along += n[i] * ray[i];
    }
    const T inverse_of_plane = along / distance;
    const T offset = (1.0 - place.down) * ((1.0 - place.right) * *up_left + place.right * *up_right) +
                     place.down * ((1.0 - place.right) * *down_left + place.right * *down_right);
    // The residual is in reported depth, expected minus measured. With inverse_scale applied to the measured
    // value, noise would bias the scale towards 0.
    residual[0] = ((inverse_of_plane - offset) / *inverse_scale - 1.0 / sample.reported_m) / sigma_per_m;
    return true;
  }
};

/// Priors that pull a node towards its neighbour (NodeDifference) or towards 0 (NodeSize).
struct NodeDifference {
  double sigma_per_m;
  template <typename T>
  bool operator()(const T* a, const T* b, T* residual) const {
    residual[0] = (*a - *b) / sigma_per_m;
    return true;
  }
};
struct NodeSize {
  double sigma_per_m;
  template <typename T>
  bool operator()(const T* node, T* residual) const {
    residual[0] = *node / sigma_per_m;
    return true;
  }
};

double inverse_sigma_per_m(double depth_m) {
  return kDepthSigmas * static_cast<double>(depth_sigma_m(DepthNoise{}, static_cast<float>(depth_m))) /
         (depth_m * depth_m);
}

}  // namespace

PoseBlock pose_of(const Eigen::Isometry3d& T_a_b) {
  const Eigen::AngleAxisd turn(T_a_b.linear());
  const Eigen::Vector3d axis = turn.angle() * turn.axis();
  const Eigen::Vector3d shift = T_a_b.translation();
  return {{axis.x(), axis.y(), axis.z(), shift.x(), shift.y(), shift.z()}};
}

Eigen::Isometry3d isometry_of(const PoseBlock& pose) {
  const Eigen::Vector3d axis(pose.turn_and_shift.data());
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  if (axis.norm() > 0.0) T.linear() = Eigen::AngleAxisd(axis.norm(), axis.normalized()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(pose.turn_and_shift.data() + 3);
  return T;
}

CameraBlock block_of(const Intrinsics& camera, const Lens& lens) {
  return {camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px, lens.k1,
          lens.k2,      lens.p1,      lens.p2,      lens.k3};
}
Intrinsics camera_of(const CameraBlock& block, Intrinsics sized) {
  sized.fx_px = block[0];
  sized.fy_px = block[1];
  sized.cx_px = block[2];
  sized.cy_px = block[3];
  return sized;
}
Lens lens_of(const CameraBlock& block) { return {block[4], block[5], block[6], block[7], block[8]}; }

void add_view(const BoardView& view, const Board& board, const CorrectionGrid& grid,
              PoseBlock& T_colour_board, CalibrationUnknowns& unknowns, ceres::Problem& problem) {
  double* board_pose = T_colour_board.turn_and_shift.data();
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column) {
      const auto i = static_cast<std::size_t>(row * board.columns + column);
      auto* error = new CornerError{corner_board(board, column, row), view.corners_px[i]};
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<CornerError, 2, 9, 6>(error),
                               new ceres::HuberLoss(kRobust_sigmas), unknowns.colour.data(), board_pose);
    }
  for (const DepthSample& sample : view.depth) {
    const GridPlace place =
        grid_place(grid.columns, grid.rows, grid.width_px, grid.height_px, sample.x_px, sample.y_px);
    double* up = unknowns.nodes.data() + place.row * grid.columns + place.column;
    double* down = up + grid.columns;
    auto* error = new DepthError{sample, place, inverse_sigma_per_m(sample.reported_m)};
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<DepthError, 1, 9, 6, 6, 1, 1, 1, 1, 1>(error),
                             new ceres::HuberLoss(kRobust_sigmas), unknowns.depth.data(),
                             unknowns.T_colour_depth.turn_and_shift.data(), board_pose,
                             &unknowns.inverse_scale, up, up + 1, down, down + 1);
  }
}

void add_smoothness(const CorrectionGrid& grid, CalibrationUnknowns& unknowns, ceres::Problem& problem) {
  const auto join = [&](int a, int b) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<NodeDifference, 1, 1, 1>(new NodeDifference{kNodeStep_per_m}),
        nullptr, &unknowns.nodes[static_cast<std::size_t>(a)], &unknowns.nodes[static_cast<std::size_t>(b)]);
  };
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const int node = row * grid.columns + column;
      if (column > 0) join(node - 1, node);
      if (row > 0) join(node - grid.columns, node);
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<NodeSize, 1, 1>(new NodeSize{kNodeSize_per_m}),
                               nullptr, &unknowns.nodes[static_cast<std::size_t>(node)]);
    }
}

}  // namespace roomradar
