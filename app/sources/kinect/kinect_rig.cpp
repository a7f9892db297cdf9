// kinect_rig.cpp: Gauss-Newton fit to the pixel correspondences of a Kinect's registration.
#include "app/sources/kinect/kinect_rig.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace roomradar {
namespace {

constexpr int kParameters = 7;  // focal length, principal point, rotation, shift along x
using Parameters = Eigen::Matrix<double, kParameters, 1>;

CameraRig changed(const CameraRig& nominal, const Parameters& by) {
  CameraRig rig = nominal;
  rig.colour_camera->fx_px = rig.colour_camera->fy_px = nominal.colour_camera->fx_px + by[0];
  rig.colour_camera->cx_px += by[1];
  rig.colour_camera->cy_px += by[2];
  const Eigen::Vector3d turn = by.segment<3>(3);
  if (turn.norm() > 0.0)
    rig.T_colour_depth.linear() =
        Eigen::AngleAxisd(turn.norm(), turn.normalized()) * nominal.T_colour_depth.linear();
  rig.T_colour_depth.translation().x() += by[6];
  return rig;
}

Eigen::Vector2d colour_px_of(const SeenByBoth& seen, const CameraRig& rig) {
  const Eigen::Vector3d p_depth =
      back_project(rig.depth_camera, seen.depth_px.x(), seen.depth_px.y(), seen.depth_m);
  return project(*rig.colour_camera, rig.T_colour_depth * p_depth);
}

}  // namespace

std::optional<CameraRig> fit_kinect_rig(const std::vector<SeenByBoth>& seen_by_both,
                                        const CameraRig& nominal) {
  constexpr std::size_t kLeastPoints = 50;
  constexpr int kSteps = 10;  // nearly linear: converges in three or four steps
  constexpr double kWorst_px = 3.0;
  // Sigmas of the prior, the likely deviation of a device from nominal: px, rad, m.
  const Parameters likely = (Parameters() << 20.0, 10.0, 10.0, 0.02, 0.02, 0.02, 0.003).finished();
  const Parameters step = likely * 1e-4;
  if (!nominal.colour_camera || seen_by_both.size() < kLeastPoints) return std::nullopt;

  Parameters by = Parameters::Zero();
  for (int i = 0; i < kSteps; ++i) {
    Eigen::Matrix<double, kParameters, kParameters> A =
        likely.cwiseInverse().cwiseAbs2().asDiagonal().toDenseMatrix();
    Parameters b = -A * by;
    const CameraRig rig = changed(nominal, by);
    std::array<CameraRig, kParameters> moved;
    for (int k = 0; k < kParameters; ++k) moved[k] = changed(nominal, by + step[k] * Parameters::Unit(k));
    for (const SeenByBoth& seen : seen_by_both) {
      const Eigen::Vector2d at_px = colour_px_of(seen, rig);
      Eigen::Matrix<double, 2, kParameters> J;
      for (int k = 0; k < kParameters; ++k) J.col(k) = (colour_px_of(seen, moved[k]) - at_px) / step[k];
      A += J.transpose() * J;
      b += J.transpose() * (seen.colour_px - at_px);
    }
    by += A.ldlt().solve(b);
  }

  const CameraRig rig = changed(nominal, by);
  double sum_px2 = 0.0;
  for (const SeenByBoth& seen : seen_by_both)
    sum_px2 += (colour_px_of(seen, rig) - seen.colour_px).squaredNorm();
  const double rms_px = std::sqrt(sum_px2 / static_cast<double>(seen_by_both.size()));
  if (!(rms_px <= kWorst_px)) return std::nullopt;  // also rejects NaN
  return rig;
}

}  // namespace roomradar
