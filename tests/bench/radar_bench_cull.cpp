// radar_bench_cull.cpp: finds the image rectangle of the swept volume, then tests each triangle against the
// volume's sides.
#include "radar_bench_cull.hpp"

#include <algorithm>
#include <cmath>

namespace roomradar::bench {
namespace {

struct CellRange {
  int first = 0, last = -1;  // vertex indices, both inclusive
};

std::array<CellRange, 2> vertices_of(const FrameScene& frame, const SweptVolume& volume) {
  const Intrinsics& camera = frame.camera;
  const int stride = frame.stride_px;
  const int columns = (camera.width_px - 1) / stride + 1, rows = (camera.height_px - 1) / stride + 1;
  const Eigen::Isometry3d T_world_volume = volume.T_volume_world.inverse();
  Eigen::AlignedBox2d box;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner =
        T_world_volume * volume.box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(i)).cast<double>();
    if (corner.z() < 0.05) return {{{0, columns - 1}, {0, rows - 1}}};  // reaches behind the camera
    box.extend(project(camera, corner));
  }
  const auto range = [&](int axis, int count) {
    const double first = std::floor(box.min()[axis] / stride), last = std::ceil(box.max()[axis] / stride);
    return CellRange{static_cast<int>(std::clamp(first, 0.0, count - 1.0)),
                     static_cast<int>(std::clamp(last, 0.0, count - 1.0))};
  };
  return {range(0, columns), range(1, rows)};
}

}  // namespace

SweptVolume swept_volume(const std::vector<Eigen::Vector3f>& sensor_vertices, const Pose& pose,
                         double distance_m) {
  const Eigen::Vector3d& u = pose.direction_world;
  const Eigen::Vector3d x = u.unitOrthogonal();
  SweptVolume volume;
  volume.T_volume_world = Eigen::Isometry3d::Identity();
  volume.T_volume_world.linear() << x.transpose(), u.cross(x).transpose(), u.transpose();
  volume.T_volume_world.translation() = -volume.T_volume_world.linear() * pose.T_world_sensor.translation();
  const Eigen::Matrix3f R_volume_sensor =
      (volume.T_volume_world.linear() * pose.T_world_sensor.linear()).cast<float>();
  Eigen::Array3f low = Eigen::Array3f::Constant(1e9F), high = -low;
  for (const Eigen::Vector3f& vertex : sensor_vertices) {
    const Eigen::Array3f p = (R_volume_sensor * vertex).array();
    low = low.min(p);
    high = high.max(p);
  }
  constexpr float kRounding_m = 1e-6F;
  volume.box.min() = low - kRounding_m;
  volume.box.max() = high + kRounding_m;
  volume.box.max().z() += static_cast<float>(distance_m);
  return volume;
}

void cull(const FrameScene& frame, const SweptVolume& volume, CulledScene& result) {
  const auto [in_row, in_column] = vertices_of(frame, volume);
  const int columns = in_row.last - in_row.first + 1, rows = in_column.last - in_column.first + 1;
  const auto count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  result.vertices.resize(count);
  result.is_outside.resize(count);
  result.triangles.resize(2 * count);
  const Intrinsics& camera = frame.camera;
  const Eigen::Matrix3f R = volume.T_volume_world.linear().cast<float>();
  const Eigen::Vector3f t = volume.T_volume_world.translation().cast<float>();
  const Eigen::Vector3f step = R.col(0) / static_cast<float>(camera.fx_px);
  const Eigen::Vector3f low = volume.box.min(), high = volume.box.max();
  for (int j = 0; j < rows; ++j) {
    const int v = (in_column.first + j) * frame.stride_px;
    const float* depth_m = frame.depth_m.row(v);
    const Eigen::Vector3f ray0 = R.col(1) * static_cast<float>((v - camera.cy_px) / camera.fy_px) + R.col(2) -
                                 step * static_cast<float>(camera.cx_px);
    std::array<float, 4>* vertices = result.vertices.data() + static_cast<std::size_t>(j) * columns;
    std::uint8_t* is_outside = result.is_outside.data() + static_cast<std::size_t>(j) * columns;
    for (int i = 0; i < columns; ++i) {
      const int u = (in_row.first + i) * frame.stride_px;
      const float z_m = depth_m[u], pixel = static_cast<float>(u);
      const float px = (ray0[0] + step[0] * pixel) * z_m + t[0];
      const float py = (ray0[1] + step[1] * pixel) * z_m + t[1];
      const float pz = (ray0[2] + step[2] * pixel) * z_m + t[2];
      vertices[i] = {px, py, pz, 0.0F};
      is_outside[i] = static_cast<std::uint8_t>((px < low[0] ? 1 : 0) | (px > high[0] ? 2 : 0) |
                                                (py < low[1] ? 4 : 0) | (py > high[1] ? 8 : 0) |
                                                (pz < low[2] ? 16 : 0) | (pz > high[2] ? 32 : 0));
    }
  }
  std::size_t kept = 0;
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    result.triangles[kept] = {a, b, c};
    kept += (result.is_outside[a] & result.is_outside[b] & result.is_outside[c]) == 0 ? 1 : 0;
  };
  for (int j = 0; j + 1 < rows; ++j) {
    for (int i = 0; i + 1 < columns; ++i) {
      const auto a = static_cast<std::uint32_t>(j * columns + i);
      const auto c = a + static_cast<std::uint32_t>(columns);
      add(a, c, c + 1);
      add(a, c + 1, a + 1);
    }
  }
  result.triangles.resize(kept);
}

}  // namespace roomradar::bench
