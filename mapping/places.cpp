// places.cpp: what is remembered of a room to find the camera in it again.
#include "mapping/places.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "mapping/view.hpp"

namespace roomradar {
namespace {

/// Depth at a pixel as the middle one of its 3 x 3 surroundings; 0 if fewer than five of them have any.
float median_depth_m(const DepthImage& depth_m, int x, int y) {
  std::array<float, 9> around{};
  std::size_t count = 0;
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, depth_m.height - 1); ++v) {
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, depth_m.width - 1); ++u) {
      if (depth_m.at(u, v) > 0.0F) around[count++] = depth_m.at(u, v);
    }
  }
  if (count < 5) return 0.0F;
  const auto middle = around.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(around.begin(), middle, around.begin() + static_cast<std::ptrdiff_t>(count));
  return *middle;
}

/// The surface point seen at a colour pixel, in the depth camera. The point's depth decides where in the
/// depth image to look for it, so it is searched for along the ray, from near and from far.
std::optional<Eigen::Vector3f> point_at(const Frame& frame, const Eigen::Isometry3d& T_depth_colour,
                                        double u_px, double v_px) {
  for (const double start_m : {0.8, 3.0}) {
    double z_colour_m = start_m;
    for (int step = 0; step < 8; ++step) {
      const Eigen::Vector3d p = T_depth_colour * back_project(frame.colour_camera, u_px, v_px, z_colour_m);
      if (p.z() < 0.1) break;
      const Eigen::Vector2d at_px = project(frame.depth_camera, p);
      if (!(at_px.cwiseAbs().maxCoeff() < 1e5)) break;
      const int x = static_cast<int>(std::lround(at_px.x())), y = static_cast<int>(std::lround(at_px.y()));
      if (!frame.depth_m.contains(x, y)) break;
      const auto depth_m = static_cast<double>(median_depth_m(frame.depth_m, x, y));
      if (depth_m <= 0.0) break;
      const Eigen::Vector3d seen = p * (depth_m / p.z());
      const double next_m = (frame.T_colour_depth * seen).z();
      if (std::abs(next_m - z_colour_m) < 0.01 * next_m) return seen.cast<float>();
      z_colour_m = next_m;
    }
  }
  return std::nullopt;
}

void describe_features(const Frame& frame, int most, Place& place) {
  cv::Mat3b colour(frame.colour.height, frame.colour.width);
  std::memcpy(colour.data, frame.colour.pixels.data(), frame.colour.pixels.size() * sizeof(Rgb));
  cv::Mat1b grey;
  cv::cvtColor(colour, grey, cv::COLOR_RGB2GRAY);
  constexpr int kFastThreshold = 12;  // of 255; rooms have dim, plain walls
  const cv::Ptr<cv::ORB> orb =
      cv::ORB::create(most, 1.2F, 8, 31, 0, 2, cv::ORB::HARRIS_SCORE, 31, kFastThreshold);
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat1b descriptors;
  orb->detectAndCompute(grey, cv::noArray(), keypoints, descriptors);

  std::vector<std::size_t> strongest(keypoints.size());
  for (std::size_t i = 0; i < strongest.size(); ++i) strongest[i] = i;
  std::stable_sort(strongest.begin(), strongest.end(), [&](std::size_t a, std::size_t b) {
    return keypoints[a].response > keypoints[b].response;
  });
  const Eigen::Isometry3d T_depth_colour = frame.T_colour_depth.inverse();
  for (const std::size_t i : strongest) {
    const auto p = point_at(frame, T_depth_colour, static_cast<double>(keypoints[i].pt.x),
                            static_cast<double>(keypoints[i].pt.y));
    if (!p) continue;
    Descriptor& bits = place.descriptors.emplace_back();
    std::memcpy(bits.data(), descriptors.ptr(static_cast<int>(i)), bits.size());
    place.points_camera.push_back(*p);
  }
}

}  // namespace

Place describe_place(const Frame& frame, const Eigen::Isometry3d& T_world_camera, const PlaceConfig& config) {
  Place place;
  place.frame_index = frame.index;
  place.T_world_camera = T_world_camera;
  ViewPyramid small;
  make_pyramid(frame.depth_m, frame.depth_camera, {.finest_width_px = config.preview_width_px, .levels = 1},
               small);
  const ViewPyramid::Level& level = small.levels.front();
  place.preview_camera = level.camera;
  place.preview_depth_mm.resize(level.camera.width_px, level.camera.height_px);
  std::transform(level.inverse_depth_per_m.pixels.begin(), level.inverse_depth_per_m.pixels.end(),
                 place.preview_depth_mm.pixels.begin(), [](float q) {
                   return q > 0.0F ? static_cast<std::uint16_t>(std::lround(std::min(1000.0F / q, 65535.0F)))
                                   : std::uint16_t{0};
                 });
  // ORB needs 31 pixels of surroundings and OpenCV's pyramid some more.
  constexpr int kSmallest_px = 64;
  if (config.features > 0 && std::min(frame.colour.width, frame.colour.height) >= kSmallest_px) {
    describe_features(frame, config.features, place);
  }
  return place;
}

void transform(Places& places, const Eigen::Isometry3d& T_new_old) {
  for (Place& place : places.keyframes) place.T_world_camera = T_new_old * place.T_world_camera;
}

}  // namespace roomradar
