// calibrate.cpp: a joint least-squares fit, its initial values, and the checks of its result.
#include "app/calibration/calibrate.hpp"

#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <opencv2/calib3d.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/calibration/board_views.hpp"
#include "app/calibration/calibration.hpp"
#include "app/calibration/checkerboard.hpp"
#include "app/sources/formats/median.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/lens.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"

namespace ceres {
class Problem;
}

namespace roomradar {
namespace {

/// T_a_b as rotation vector (rad) and translation (m): x_a = R x_b + t.
struct PoseBlock {
  std::array<double, 6> turn_and_shift{};
};

/// A camera and its lens: fx, fy, cx, cy (px), k1, k2, p1, p2, k3.
using CameraBlock = std::array<double, 9>;

/// Parameters of the fit, and its result.
struct CalibrationUnknowns {
  CameraBlock colour, depth;
  PoseBlock T_colour_depth;
  std::vector<PoseBlock> T_colour_board;  ///< the checkerboard's pose in each view
  double inverse_scale = 1.0;
  std::vector<double> nodes;  ///< offsets of the depth correction (1/m), row by row
};

/// Number of nodes of the depth correction, and the size of the depth images that its grid covers.
struct CorrectionGrid {
  int columns = 0, rows = 0;
  int width_px = 0, height_px = 0;
};

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

/// Convert between a pose and its parameters.
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

/// Convert between a camera and its parameters. `sized` provides the image size of the result.
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

/// Adds the residuals of one view. Residuals are the reprojection errors of corners (sigma 0.15 px) and the
/// differences of inverse depth from the checkerboard's plane (sigma: twice the sensor's noise). The loss is
/// Huber's.
/// @param T_colour_board  the checkerboard's pose in this view. Must be an element of unknowns.T_colour_board
/// @param unknowns        must outlive the problem and must not move
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

/// Adds two priors on each node of the depth correction. One pulls it towards 0, the other towards its
/// neighbours.
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

}  // namespace

ViewResidual residual_of(const BoardView& view, const Board& board, const Calibration& calibration) {
  const Intrinsics& colour = *calibration.rig.colour_camera;
  const Intrinsics& depth = calibration.rig.depth_camera;
  const Eigen::Isometry3d T_colour_board =
      pose_of_board(view.corners_px, board, colour, calibration.colour_lens);
  ViewResidual residual;
  double sum_px2 = 0.0;
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column) {
      const Eigen::Vector3d p = T_colour_board * corner_board(board, column, row);
      const PlanePoint<double> at = distorted({p.x() / p.z(), p.y() / p.z()}, calibration.colour_lens);
      const Eigen::Vector2d shown_px(colour.fx_px * at.x + colour.cx_px, colour.fy_px * at.y + colour.cy_px);
      sum_px2 +=
          (shown_px - view.corners_px[static_cast<std::size_t>(row * board.columns + column)]).squaredNorm();
    }
  residual.colour_rms_px = std::sqrt(sum_px2 / static_cast<double>(view.corners_px.size()));

  const Eigen::Isometry3d T_depth_board = calibration.rig.T_colour_depth.inverse() * T_colour_board;
  const Eigen::Vector3d normal = T_depth_board.linear().col(2);
  const double distance_m = normal.dot(T_depth_board.translation());
  residual.distance_m = (T_depth_board * corner_board(board, board.columns / 2, board.rows / 2)).z();
  std::vector<double> errors_m;
  double sum_m2 = 0.0;
  for (const DepthSample& sample : view.depth) {
    const PlanePoint<double> p =
        undistorted({(sample.x_px - depth.cx_px) / depth.fx_px, (sample.y_px - depth.cy_px) / depth.fy_px},
                    calibration.depth_lens);
    const double plane_m = distance_m / normal.dot(Eigen::Vector3d(p.x, p.y, 1.0));
    const double offset =
        offset_per_m(calibration.depth_correction, depth.width_px, depth.height_px, sample.x_px, sample.y_px);
    const auto reported_m = static_cast<float>(sample.reported_m);
    const double error_m =
        corrected_depth_m(reported_m, calibration.depth_correction.inverse_scale, offset) - plane_m;
    errors_m.push_back(error_m);
    sum_m2 += error_m * error_m;
  }
  residual.depth_rms_m = std::sqrt(sum_m2 / static_cast<double>(errors_m.size()));
  residual.depth_bias_m = median_of(std::move(errors_m));
  return residual;
}

namespace {

constexpr std::size_t kLeastViews = 12;
constexpr double kTilt_rad = 12.0 * M_PI / 180.0;
constexpr std::ptrdiff_t kLeastTilted = 6;
constexpr double kMostUnsure = 0.01;  // max relative sigma of a focal length

/// Calibrates the colour camera alone with OpenCV, as the initial value.
CameraBlock start_of_colour(const std::vector<const BoardView*>& views, const Board& board,
                            const Intrinsics& said) {
  std::vector<std::vector<cv::Point3f>> on_board;
  std::vector<std::vector<cv::Point2f>> in_image;
  for (const BoardView* view : views) {
    std::vector<cv::Point3f> corners;
    for (int row = 0; row < board.rows; ++row)
      for (int column = 0; column < board.columns; ++column) {
        const Eigen::Vector3f p = corner_board(board, column, row).cast<float>();
        corners.emplace_back(p.x(), p.y(), p.z());
      }
    std::vector<cv::Point2f> seen;
    for (const Eigen::Vector2d& corner : view->corners_px)
      seen.emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()));
    on_board.push_back(std::move(corners));
    in_image.push_back(std::move(seen));
  }
  cv::Matx33d matrix(said.fx_px, 0, said.cx_px, 0, said.fy_px, said.cy_px, 0, 0, 1);
  cv::Vec<double, 5> distortion;
  std::vector<cv::Mat> turns, shifts;
  cv::calibrateCamera(on_board, in_image, cv::Size(said.width_px, said.height_px), matrix, distortion, turns,
                      shifts, cv::CALIB_USE_INTRINSIC_GUESS);
  return {matrix(0, 0),  matrix(1, 1),  matrix(0, 2),  matrix(1, 2), distortion[0],
          distortion[1], distortion[2], distortion[3], distortion[4]};
}

/// Returns the ratio of the residuals' standard deviation to the assumed one, at least 1.
double excess_of(const ceres::Solver::Summary& summary) {
  const double freedom = summary.num_residuals_reduced - summary.num_effective_parameters_reduced;
  return freedom > 0.0 ? std::max(1.0, std::sqrt(2.0 * summary.final_cost / freedom)) : 1.0;
}

CalibrationSigmas sigmas_of(ceres::Problem& problem, const CalibrationUnknowns& unknowns, double excess) {
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::SPARSE_QR;
  ceres::Covariance covariance(options);
  const double* colour = unknowns.colour.data();
  const double* depth = unknowns.depth.data();
  const double* pose = unknowns.T_colour_depth.turn_and_shift.data();
  if (!covariance.Compute({{colour, colour}, {depth, depth}, {pose, pose}}, &problem))
    throw Error(
        "calibrate: the views do not constrain all parameters; show the board near and far, tilted "
        "every way, and in all parts of the image");
  Eigen::Matrix<double, 9, 9, Eigen::RowMajor> of_colour, of_depth;
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> of_pose;
  covariance.GetCovarianceBlock(colour, colour, of_colour.data());
  covariance.GetCovarianceBlock(depth, depth, of_depth.data());
  covariance.GetCovarianceBlock(pose, pose, of_pose.data());
  const auto largest = [excess](const auto& of, int a, int b) {
    return excess * std::sqrt(std::max(of(a, a), of(b, b)));
  };
  CalibrationSigmas sigmas;
  sigmas.colour_focal_px = largest(of_colour, 0, 1);
  sigmas.colour_centre_px = largest(of_colour, 2, 3);
  sigmas.depth_focal_px = largest(of_depth, 0, 1);
  sigmas.depth_centre_px = largest(of_depth, 2, 3);
  sigmas.turn_rad = excess * std::sqrt(of_pose.diagonal().head<3>().maxCoeff());
  sigmas.shift_m = excess * std::sqrt(of_pose.diagonal().tail<3>().maxCoeff());
  return sigmas;
}

/// Rejects views that are all parallel: these do not separate focal length from distance.
void require_tilted(const std::vector<PoseBlock>& T_colour_board) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> normals;
  for (const PoseBlock& pose : T_colour_board) {
    normals.emplace_back(isometry_of(pose).linear().col(2));
    if (normals.back().dot(normals.front()) < 0.0) normals.back() *= -1.0;
    mean += normals.back();
  }
  const double cosine = std::cos(kTilt_rad);
  const auto tilted = std::count_if(normals.begin(), normals.end(), [&](const Eigen::Vector3d& normal) {
    return normal.dot(mean.normalized()) < cosine;
  });
  if (tilted >= kLeastTilted) return;
  throw Error("calibrate: of " + std::to_string(normals.size()) + " views of the board, " +
              std::to_string(tilted) + " are tilted by 12 degrees or more against the others; at least " +
              std::to_string(kLeastTilted) + " are needed. Tilt the board every way, by 30 to 50 degrees");
}

void require_sure(const char* which, double focal_px, double sigma_px) {
  if (sigma_px <= kMostUnsure * focal_px) return;
  throw Error(std::string("calibrate: the views leave the ") + which +
              " camera's focal length uncertain by " + std::to_string(std::lround(sigma_px)) + " px of " +
              std::to_string(std::lround(focal_px)) +
              "; tilt the board more, by 30 to 50 degrees, near and far");
}

void require_views(const BoardViews& views, const Board& board) {
  if (views.views.size() >= kLeastViews) return;
  if (are_squares_off(views)) {
    const double ratio = median_of(views.off_plane_ratios);
    std::array<char, 160> sizes{};
    format_classic(
        sizes.data(), sizes.size(),
        "is %.3g times as far as squares of %g m would be; squares of %.3g m would fit. Measure one, "
        "and give its side with --square",
        ratio, board.square_m, ratio * board.square_m);
    throw Error("calibrate: the depth in " + std::to_string(views.off_plane_ratios.size()) +
                " views of the board " + sizes.data());
  }
  throw Error("calibrate: of " + std::to_string(views.frames) + " frames, " +
              std::to_string(views.with_board) + " show a board of " + std::to_string(board.columns) +
              " by " + std::to_string(board.rows) + " inner corners, and " +
              std::to_string(views.views.size()) +
              " of these are still, differ, and have depth on it; at least " + std::to_string(kLeastViews) +
              " are needed. Count the inner corners, hold the board still for a moment in each position, "
              "0.6 m or more away");
}

/// Rejects a fit that read_calibration() would reject: a lens observed only in the image's centre may be
/// arbitrary in its corners.
void require_readable(const Calibration& calibration) {
  try {
    require_valid(calibration, "calibrate: the fit");
  } catch (const Error& fault) {
    throw Error(std::string(fault.what()) + ". Show the board in all corners of the image too, near and far");
  }
}

Calibration calibration_of(const CalibrationUnknowns& unknowns, const CalibrateConfig& config,
                           const Frame& first) {
  Calibration calibration;
  calibration.rig.depth_camera = camera_of(unknowns.depth, first.depth_camera);
  calibration.rig.colour_camera = camera_of(unknowns.colour, first.colour_camera);
  calibration.rig.T_colour_depth = isometry_of(unknowns.T_colour_depth);
  calibration.depth_lens = lens_of(unknowns.depth);
  calibration.colour_lens = lens_of(unknowns.colour);
  calibration.depth_correction = {unknowns.inverse_scale, config.grid_columns, config.grid_rows,
                                  unknowns.nodes};
  return calibration;
}

}  // namespace

CalibrationFit calibrate(const BoardViews& views, const CalibrateConfig& config) {
  require_views(views, config.board);
  CalibrationFit fit;
  std::vector<const BoardView*> making;
  for (std::size_t i = 0; i < views.views.size(); ++i) {
    if (config.hold_out > 0 &&
        i % static_cast<std::size_t>(config.hold_out) == static_cast<std::size_t>(config.hold_out) / 2)
      fit.held_out.push_back(i);
    else
      making.push_back(&views.views[i]);
  }

  CalibrationUnknowns unknowns;
  unknowns.colour = start_of_colour(making, config.board, views.first.colour_camera);
  unknowns.depth = block_of(views.first.depth_camera, {});
  unknowns.T_colour_depth = pose_of(views.first.T_colour_depth);
  unknowns.nodes.assign(
      static_cast<std::size_t>(config.grid_columns) * static_cast<std::size_t>(config.grid_rows), 0.0);
  const Intrinsics colour = camera_of(unknowns.colour, views.first.colour_camera);
  for (const BoardView* view : making)
    unknowns.T_colour_board.push_back(
        pose_of(pose_of_board(view->corners_px, config.board, colour, lens_of(unknowns.colour))));

  require_tilted(unknowns.T_colour_board);

  ceres::Problem problem;
  const CorrectionGrid grid{config.grid_columns, config.grid_rows, views.first.depth_m.width,
                            views.first.depth_m.height};
  for (std::size_t i = 0; i < making.size(); ++i)
    add_view(*making[i], config.board, grid, unknowns.T_colour_board[i], unknowns, problem);
  add_smoothness(grid, unknowns, problem);
  // k3 of the depth lens is constrained to 0: with a pixel of noise, r^6 cannot be told from r^4.
  problem.SetManifold(unknowns.depth.data(), new ceres::SubsetManifold(9, {8}));
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-9;  // focal length and distance are strongly correlated and converge slowly
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (summary.termination_type != ceres::CONVERGENCE)
    throw Error("calibrate: the fit does not converge: " + summary.message +
                "; is the size of the squares right, and the board flat?");

  fit.sigmas = sigmas_of(problem, unknowns, excess_of(summary));
  require_sure("colour", unknowns.colour[0], fit.sigmas.colour_focal_px);
  require_sure("depth", unknowns.depth[0], fit.sigmas.depth_focal_px);
  fit.calibration = calibration_of(unknowns, config, views.first);
  require_readable(fit.calibration);
  Calibration said;
  said.rig = {views.first.depth_camera, views.first.colour_camera, views.first.T_colour_depth, false, {}};
  for (const BoardView& view : views.views) {
    fit.before.push_back(residual_of(view, config.board, said));
    fit.after.push_back(residual_of(view, config.board, fit.calibration));
  }
  return fit;
}

}  // namespace roomradar
