// column_search.cpp: a scene triangle's outline and plane as functions of the object's points.
#include "radar/geometry/column_search.hpp"
#include "radar/geometry/infinity.hpp"

namespace roomradar {

SceneColumn::SceneColumn(const TurnedTree& object, const FrameTriangle& scene) {
  constexpr float kRounding = 16.0F * std::numeric_limits<float>::epsilon();
  const auto& c = scene.corners;
  const Eigen::Vector3d low = c[0].cwiseMin(c[1]).cwiseMin(c[2]), high = c[0].cwiseMax(c[1]).cwiseMax(c[2]);
  const float size_m = object.tree->half_size().sum();
  const auto margin_m = static_cast<float>(object.margin_m) * (1.0F + kRounding);
  const auto near_m = static_cast<float>(low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff());
  const float slack_m = kRounding * (size_m + near_m) + margin_m;
  const Eigen::Matrix3d& R = object.R_frame_mesh;
  x_axis = R.row(0).cast<float>();
  y_axis = R.row(1).cast<float>();
  z_axis = R.row(2).cast<float>();
  x0 = static_cast<float>(low.x()) - slack_m, x1 = static_cast<float>(high.x()) + slack_m;
  y0 = static_cast<float>(low.y()) - slack_m, y1 = static_cast<float>(high.y()) + slack_m;

  std::size_t longest = 0;
  double longest2 = -1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double length2 = (c[(i + 1) % 3] - c[i]).head<2>().squaredNorm();
    if (length2 > longest2) longest2 = length2, longest = i;
  }
  const Eigen::Vector3d along = c[(longest + 1) % 3] - c[longest];
  Eigen::Vector2d out(along.y(), -along.x());
  out /= std::max(out.lpNorm<1>(), std::numeric_limits<double>::min());
  if (out.dot((c[(longest + 2) % 3] - c[longest]).head<2>()) > 0.0) out = -out;
  edge = (out.x() * R.row(0) + out.y() * R.row(1)).cast<float>();
  double reach = -std::numeric_limits<double>::infinity();  // from the corner farthest out, whichever it is
  for (const Eigen::Vector3d& corner : c) reach = std::max(reach, out.dot(corner.head<2>()));
  edge_reach = static_cast<float>(reach) + slack_m;

  if (std::abs(scene.normal.z()) > kEdgeOn) {
    const Eigen::Vector3d in_frame(-scene.normal.x() / scene.normal.z(), -scene.normal.y() / scene.normal.z(),
                                   -1.0);
    plane = (R.transpose() * in_frame).cast<float>();
    offset = static_cast<float>(scene.normal.dot(c[0]) / scene.normal.z());
    const float slope = plane.cwiseAbs().sum();
    plane_slack = kRounding * (slope * (size_m + near_m) + std::abs(offset)) + slope * margin_m;
    constexpr float kSteep = 4.0F;  // sum of three components: 1 to 1.7 for a plane perpendicular to the
                                    // motion
    is_steep = slope > kSteep;
  } else if (!scene.normal.isZero(0.0)) {
    // Triangles that do not reach through its plane slide along it.
    is_edge_on = true;
    plane = (R.transpose() * scene.normal).cast<float>();
    offset = static_cast<float>(-scene.normal.dot(c[0]));
    beside = static_cast<float>(object.touching_m) - 2.0F * slack_m - kRounding * std::abs(offset);
  }
  z0 = is_steep ? static_cast<float>(low.z()) - slack_m : -kInfinity<float>;
  z1 = is_steep ? static_cast<float>(high.z()) + slack_m : kInfinity<float>;
}

}  // namespace roomradar
