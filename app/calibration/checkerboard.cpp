// checkerboard.cpp: converts corners and camera for OpenCV's solvePnP.
#include "app/calibration/checkerboard.hpp"

#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

namespace roomradar {

Eigen::Isometry3d pose_of_board(const std::vector<Eigen::Vector2d>& corners_px, const Board& board,
                                const Intrinsics& camera, const Lens& lens) {
  std::vector<cv::Point3d> on_board;
  std::vector<cv::Point2d> in_image;
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column) {
      const Eigen::Vector3d p = corner_board(board, column, row);
      on_board.emplace_back(p.x(), p.y(), p.z());
    }
  for (const Eigen::Vector2d& corner : corners_px) in_image.emplace_back(corner.x(), corner.y());
  const cv::Matx33d matrix(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  const cv::Vec<double, 5> distortion(lens.k1, lens.k2, lens.p1, lens.p2, lens.k3);
  cv::Vec3d turn, shift;
  cv::solvePnP(on_board, in_image, matrix, distortion, turn, shift);
  cv::Matx33d rotation;
  cv::Rodrigues(turn, rotation);
  Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d linear;
  cv::cv2eigen(rotation, linear);
  T_camera_board.linear() = linear;
  T_camera_board.translation() = Eigen::Vector3d(shift[0], shift[1], shift[2]);
  return T_camera_board;
}

}  // namespace roomradar
