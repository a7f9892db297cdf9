// frame_scene.cpp: expected depth, dynamic pixels and their mesh, frame by frame.
#include "app/session/frame_scene.hpp"

#include <array>
#include <utility>

namespace roomradar {
namespace {

/// Returns true if pixels show the same surfaces from both poses: at a focal length of 585 px, 0.2 mrad or
/// 0.2 mm at 1 m is a tenth of a pixel.
bool is_same_view(const Eigen::Isometry3d& T_world_a, const Eigen::Isometry3d& T_world_b) {
  const Eigen::Isometry3d T_a_b = T_world_a.inverse() * T_world_b;
  return T_a_b.translation().norm() < 2e-4 && Eigen::AngleAxisd(T_a_b.linear()).angle() < 2e-4;
}

}  // namespace

FrameScene::FrameScene(GlContext& context, const Shape& room, const FrameSceneConfig& config,
                       const TriangleTree* unknown)
    : config_(config), room_(room), unknown_(unknown), moved_(context), depth_pass_(context) {
  require_valid(config.foreground);
  require_valid(config.moved);
  require_valid(config.mesh);
}

std::size_t FrameScene::render_expected(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera) {
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

void FrameScene::set_surfaces(SurfacePolicy surfaces) {
  config_.surfaces = surfaces;
  dynamic_world_.inferred_world = {};  // backs are inferred with kMap only
  inferred_.build_in_order(dynamic_world_.inferred_world);
}

void FrameScene::expect_size(const Intrinsics& camera) {
  if (dynamic_mask_.empty()) return;
  if (dynamic_mask_.width == camera.width_px && dynamic_mask_.height == camera.height_px) return;
  const MaskImage before = std::exchange(dynamic_mask_, MaskImage(camera.width_px, camera.height_px));
  for (int y = 0; y < dynamic_mask_.height; ++y) {
    const std::uint8_t* from = before.row(y * before.height / dynamic_mask_.height);
    for (int x = 0; x < dynamic_mask_.width; ++x)
      dynamic_mask_.at(x, y) = from[x * before.width / dynamic_mask_.width];
  }
}

ForegroundCounts FrameScene::find_dynamic(const Frame& frame) {
  return mark_foreground(frame.depth_m, expected_depth_m_, frame.depth_camera, T_world_expected_,
                         config_.foreground, foreground_, labels_, dynamic_mask_);
}

void FrameScene::mesh_dynamic(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                              std::span<const FineRegion> fine) {
  if (config_.surfaces == SurfacePolicy::kMap) {
    roomradar::mesh_dynamic(frame.depth_m, dynamic_mask_, expected_depth_m_, frame.depth_camera,
                            T_world_camera, fine, config_.moved, dynamic_scratch_, dynamic_world_);
    inferred_.build_in_order(dynamic_world_.inferred_world);
  } else {
    mesh_whole(frame.depth_m, frame.depth_camera, T_world_camera, config_.surfaces, config_.mesh,
               mesh_scratch_, dynamic_world_.seen_world);
  }
  moved_.set(dynamic_world_.seen_world, MeshUsage::kStreamed);
}

std::vector<SceneTree> FrameScene::surfaces() const {
  std::vector<SceneTree> surfaces;
  if (config_.surfaces == SurfacePolicy::kMap)
    surfaces.push_back({{&room_.touched, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic});
  surfaces.push_back({{&moved_.touched, Eigen::Isometry3d::Identity()}, SurfaceKind::kDynamic});
  if (!inferred_.empty())
    surfaces.push_back({{&inferred_, Eigen::Isometry3d::Identity()}, SurfaceKind::kInferredBack});
  if (config_.surfaces == SurfacePolicy::kMap && unknown_ != nullptr)
    surfaces.push_back({{unknown_, Eigen::Isometry3d::Identity()}, SurfaceKind::kUnknownFrontier});
  return surfaces;
}

void FrameScene::render_surfaces(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                                 const PixelRect& rect, DepthImage& depth_m) {
  std::array<MeshInstance, 2> drawn{MeshInstance{&moved_.drawn}};
  if (config_.surfaces == SurfacePolicy::kMap) drawn[1].mesh = &room_.drawn;
  depth_pass_.render(drawn, camera, T_world_camera, rect, depth_m);
}

}  // namespace roomradar
