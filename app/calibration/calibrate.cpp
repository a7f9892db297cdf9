// calibrate.cpp: a joint least-squares fit, its initial values, and the checks of its result.
#include "app/calibration/calibrate.hpp"

#include <ceres/ceres.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <opencv2/calib3d.hpp>
#include <string>
#include <utility>

#include "app/calibration/board_pose.hpp"
#include "app/calibration/calibration_problem.hpp"
#include "app/sources/formats/median.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
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
