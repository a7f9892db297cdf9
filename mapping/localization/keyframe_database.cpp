// keyframe_database.cpp: keyframe database for relocalisation in a known room.
#include "mapping/localization/keyframe_database.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "mapping/alignment/surface_point.hpp"
#include "mapping/alignment/view.hpp"

namespace roomradar {
namespace {

void describe_features(const Frame& frame, int most, MapKeyframe& place) {
  cv::Mat3b colour(frame.colour.height, frame.colour.width);
  std::memcpy(colour.data, frame.colour.pixels.data(), frame.colour.pixels.size() * sizeof(Rgb));
  cv::Mat1b grey;
  cv::cvtColor(colour, grey, cv::COLOR_RGB2GRAY);
  constexpr int kFastThreshold = 12;  // of 255; low, because rooms have dim, plain walls
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
    const auto p = surface_point_at(frame, T_depth_colour, static_cast<double>(keypoints[i].pt.x),
                                    static_cast<double>(keypoints[i].pt.y));
    if (!p) continue;
    Descriptor& bits = place.descriptors.emplace_back();
    std::memcpy(bits.data(), descriptors.ptr(static_cast<int>(i)), bits.size());
    place.points_camera.push_back(*p);
  }
}

}  // namespace

MapKeyframe make_map_keyframe(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                              const KeyframeDatabaseConfig& config) {
  MapKeyframe place;
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
  // ORB needs a neighbourhood of 31 pixels, and OpenCV's pyramid some more.
  constexpr int kSmallest_px = 64;
  place.patches = describe_patches(frame, std::min(config.patches, kMostDescribed));
  if (config.features > 0 && std::min(frame.colour.width, frame.colour.height) >= kSmallest_px) {
    describe_features(frame, std::min(config.features, kMostDescribed), place);
  }
  // A long scan keeps hundreds of keyframes.
  place.points_camera.shrink_to_fit();
  place.descriptors.shrink_to_fit();
  place.patches.shrink_to_fit();
  return place;
}

void update_index(KeyframeDatabase& keyframe_database) {
  for (std::size_t i = keyframe_database.index.size(); i < keyframe_database.keyframes.size(); ++i)
    keyframe_database.index.add(keyframe_database.keyframes[i].descriptors);
}

void transform(KeyframeDatabase& keyframe_database, const Eigen::Isometry3d& T_new_old) {
  for (MapKeyframe& place : keyframe_database.keyframes)
    place.T_world_camera = T_new_old * place.T_world_camera;
  for (LookAlike& look_alike : keyframe_database.look_alikes) {
    look_alike.p_world = T_new_old * look_alike.p_world;
    look_alike.T_other_this = T_new_old * look_alike.T_other_this * T_new_old.inverse();
  }
}

}  // namespace roomradar
