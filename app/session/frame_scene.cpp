// live_scene.cpp: expected depth, moved pixels and their mesh, frame by frame.
#include "app/session/frame_scene.hpp"

#include <array>
#include <utility>

namespace roomradar {
namespace {

/// Whether seen from one pose and the other the same pixels show the same surfaces: at 585 px of focal length
/// 0.2 mrad are a tenth of a pixel, and so are 0.2 mm at 1 m.
bool is_same_view(const Eigen::Isometry3d& T_world_a, const Eigen::Isometry3d& T_world_b) {
  const Eigen::Isometry3d T_a_b = T_world_a.inverse() * T_world_b;
  return T_a_b.translation().norm() < 2e-4 && Eigen::AngleAxisd(T_a_b.linear()).angle() < 2e-4;
}

}  // namespace

LiveScene::LiveScene(GlContext& context, const Shape& room, const LiveSceneConfig& config,
                     const TriangleTree* unknown)
    : config_(config), room_(room), unknown_(unknown), moved_(context), depth_pass_(context) {
  require_valid(config.foreground);
  require_valid(config.moved);
  require_valid(config.mesh);
}

std::size_t LiveScene::render_expected(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera) {
  if (expected_camera_ == camera && is_same_view(T_world_expected_, T_world_camera))
    return expected_triangles_;
  const MeshInstance room{&room_.drawn, Eigen::Isometry3d::Identity()};
  expected_triangles_ = depth_pass_.render({&room, 1}, camera, T_world_camera, expected_depth_m_);
  ++room_drawn_.views;
  room_drawn_.triangles += expected_triangles_;
  expected_camera_ = camera;
  T_world_expected_ = T_world_camera;
  return expected_triangles_;
}

void LiveScene::set_surfaces(SurfacePolicy surfaces) {
  config_.surfaces = surfaces;
  moved_world_.inferred_world = {};  // backs are inferred with the map only
  inferred_.build_in_order(moved_world_.inferred_world);
}

void LiveScene::expect_size(const Intrinsics& camera) {
  if (moved_mask_.empty()) return;
  if (moved_mask_.width == camera.width_px && moved_mask_.height == camera.height_px) return;
  const MaskImage before = std::exchange(moved_mask_, MaskImage(camera.width_px, camera.height_px));
  for (int y = 0; y < moved_mask_.height; ++y) {
    const std::uint8_t* from = before.row(y * before.height / moved_mask_.height);
    for (int x = 0; x < moved_mask_.width; ++x)
      moved_mask_.at(x, y) = from[x * before.width / moved_mask_.width];
  }
}

ForegroundCounts LiveScene::find_moved(const Frame& frame) {
  return mark_foreground(frame.depth_m, expected_depth_m_, frame.depth_camera, T_world_expected_,
                         config_.foreground, foreground_, labels_, moved_mask_);
}

void LiveScene::mesh_moved(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                           std::span<const FineRegion> fine) {
  if (config_.surfaces == SurfacePolicy::kMap) {
    roomradar::mesh_moved(frame.depth_m, moved_mask_, expected_depth_m_, frame.depth_camera, T_world_camera,
                          fine, config_.moved, moved_scratch_, moved_world_);
    inferred_.build_in_order(moved_world_.inferred_world);
  } else {
    mesh_whole(frame.depth_m, frame.depth_camera, T_world_camera, config_.surfaces, config_.mesh,
               mesh_scratch_, moved_world_.seen_world);
  }
  moved_.set(moved_world_.seen_world, MeshUsage::kStreamed);
}

std::vector<SceneTree> LiveScene::surfaces() const {
  std::vector<SceneTree> surfaces;
  if (config_.surfaces == SurfacePolicy::kMap)
    surfaces.push_back({{&room_.touched, Eigen::Isometry3d::Identity()}, Touched::kStatic});
  surfaces.push_back({{&moved_.touched, Eigen::Isometry3d::Identity()}, Touched::kDynamic});
  if (!inferred_.empty())
    surfaces.push_back({{&inferred_, Eigen::Isometry3d::Identity()}, Touched::kInferredBack});
  if (config_.surfaces == SurfacePolicy::kMap && unknown_ != nullptr)
    surfaces.push_back({{unknown_, Eigen::Isometry3d::Identity()}, Touched::kUnknownFrontier});
  return surfaces;
}

void LiveScene::render_surfaces(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                                const PixelRect& rect, DepthImage& depth_m) {
  std::array<MeshInstance, 2> drawn{MeshInstance{&moved_.drawn}};
  if (config_.surfaces == SurfacePolicy::kMap) drawn[1].mesh = &room_.drawn;
  depth_pass_.render(drawn, camera, T_world_camera, rect, depth_m);
}

}  // namespace roomradar
