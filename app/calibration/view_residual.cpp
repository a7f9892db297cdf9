// view_residual.cpp: projects the board's corners, and compares depth with the board's plane.
#include "app/calibration/view_residual.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>
#include <vector>

#include "app/calibration/board_pose.hpp"
#include "app/sources/formats/median.hpp"

namespace roomradar {

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

}  // namespace roomradar
