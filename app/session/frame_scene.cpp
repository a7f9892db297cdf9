// frame_scene.cpp: expected depth, dynamic pixels and their mesh, frame by frame.
#include "app/session/frame_scene.hpp"

#include <cmath>
#include <utility>

#include "app/session/tiles/unloaded_space.hpp"
#include "radar/gl/projection.hpp"

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

const ExpectedView& FrameScene::render_expected(const Intrinsics& camera,
                                                const Eigen::Isometry3d& T_world_camera) {
  if (expected_.camera == camera && is_same_view(expected_.T_world_camera, T_world_camera)) return expected_;
  buffers_.drawn.clear();
  add_room(buffers_.drawn);
  expected_.triangles = depth_pass_.render(buffers_.drawn, camera, T_world_camera, expected_.depth_m);
  if (tiles_ != nullptr) hide_unloaded(camera, T_world_camera, expected_.depth_m);
  ++room_drawn_.views;
  room_drawn_.triangles += expected_.triangles;
  expected_.camera = camera;
  expected_.T_world_camera = T_world_camera;
  return expected_;
}

void FrameScene::add_room(std::vector<MeshInstance>& drawn) {
  if (tiles_ == nullptr) return drawn.push_back({&room_.drawn, Eigen::Isometry3d::Identity()});
  for (const auto& tile : tiles_->tiles()) {
    if (tile->pieces) depth_pass_.set_pieces(tile->shape.drawn, *std::exchange(tile->pieces, std::nullopt));
    drawn.push_back({&tile->shape.drawn, Eigen::Isometry3d::Identity()});
  }
}

void FrameScene::hide_unloaded(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                               DepthImage& depth_m) {
  buffers_.hidden_world.clear();
  const std::vector<BuildingTile>& listed = tiles_->config().building.tiles;
  for (std::size_t i = 0; i < listed.size(); ++i)
    if (!tiles_->loaded()[i]) buffers_.hidden_world.push_back(listed[i].surface_world);
  hide_behind(buffers_.hidden_world, camera, T_world_camera, depth_m);
}

void FrameScene::set_surfaces(SurfacePolicy surfaces) {
  config_.surfaces = surfaces;
  dynamic_world_.inferred_world = {};  // backs are inferred with kMap only
  inferred_.build_in_order(dynamic_world_.inferred_world);
  points_world_.clear();
}

const MaskImage& FrameScene::previous_dynamic_mask(const Intrinsics& camera) {
  MaskImage& mask = foreground_.dynamic_mask;
  if (mask.empty() || (mask.width == camera.width_px && mask.height == camera.height_px)) return mask;
  const MaskImage before = std::exchange(mask, MaskImage(camera.width_px, camera.height_px));
  for (int y = 0; y < mask.height; ++y) {
    const std::uint8_t* from = before.row(y * before.height / mask.height);
    for (int x = 0; x < mask.width; ++x) mask.at(x, y) = from[x * before.width / mask.width];
  }
  return mask;
}

const FrameForeground& FrameScene::find_dynamic(const Frame& frame, const ExpectedView& expected) {
  config_.foreground.noise = frame.depth_noise;
  foreground_.counts =
      mark_foreground({frame.depth_m, frame.depth_camera, expected.T_world_camera}, expected.depth_m,
                      config_.foreground, foreground_history_, foreground_.labels, foreground_.dynamic_mask);
  return foreground_;
}

void FrameScene::find_touchable(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                                const LabelImage& labels, std::span<const FineRegion> objects) {
  constexpr double kNear_m = 0.3;  // an object does not move farther in a frame
  MaskImage& touchable = buffers_.touchable;
  touchable = foreground_.dynamic_mask;
  for (const FineRegion& object : objects) {
    const double reach_m = object.radius_m + kNear_m;
    const Eigen::Vector3d centre = T_world_camera.inverse() * object.centre_world;
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(reach_m);
    const PixelRect rect = clamped(pixels_of(Eigen::AlignedBox3d(centre - reach, centre + reach),
                                             frame.depth_camera, Eigen::Isometry3d::Identity(), 0.05),
                                   labels.width, labels.height);
    for (int y = rect.y; y < rect.y + rect.height; ++y)
      for (int x = rect.x; x < rect.x + rect.width; ++x)
        if (labels.at(x, y) == PixelLabel::kUnmapped &&
            std::abs(frame.depth_m.at(x, y) - centre.z()) < reach_m)
          touchable.at(x, y) = 255;
  }
}

void FrameScene::mesh_surfaces(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                               const ExpectedView& expected, const FrameForeground& foreground,
                               std::span<const FineRegion> fine, std::span<const FineRegion> objects) {
  if (config_.surfaces != SurfacePolicy::kMap) return mesh_all_pixels(frame, T_world_camera);
  config_.moved.noise = frame.depth_noise;
  find_touchable(frame, T_world_camera, foreground.labels, objects);
  const MaskImage& touchable = buffers_.touchable;
  mesh_dynamic({.measured = {frame.depth_m, frame.depth_camera, T_world_camera},
                .dynamic_mask = touchable,
                .expected_depth_m = expected.depth_m},
               fine, config_.moved, buffers_.dynamic, dynamic_world_);
  points_world_.swap(last_points_world_);
  dynamic_points(frame.depth_m, touchable, frame.depth_camera, T_world_camera, points_world_);
  inferred_.build_in_order(dynamic_world_.inferred_world);
  moved_.set(dynamic_world_.seen_world, MeshUsage::kStreamed);
}

void FrameScene::mesh_all_pixels(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  config_.mesh.noise = frame.depth_noise;
  mesh_whole({frame.depth_m, frame.depth_camera, T_world_camera}, config_.surfaces, config_.mesh,
             buffers_.mesh, dynamic_world_.seen_world);
  moved_.set(dynamic_world_.seen_world, MeshUsage::kStreamed);
}

std::vector<SceneTree> FrameScene::surfaces() const {
  std::vector<SceneTree> surfaces;
  const bool has_map = config_.surfaces == SurfacePolicy::kMap;
  const auto add = [&](const TriangleTree& tree, SurfaceKind kind) {
    surfaces.push_back({{&tree, Eigen::Isometry3d::Identity()}, kind});
  };
  if (has_map && tiles_ == nullptr) add(room_.touched, SurfaceKind::kStatic);
  if (has_map && tiles_ != nullptr)
    for (const auto& tile : tiles_->tiles()) add(tile->shape.touched, SurfaceKind::kStatic);
  add(moved_.touched, SurfaceKind::kDynamic);
  if (!inferred_.empty()) add(inferred_, SurfaceKind::kInferredBack);
  if (!has_map || unknown_ == nullptr) return surfaces;
  if (tiles_ == nullptr)
    add(*unknown_, SurfaceKind::kUnknownFrontier);
  else
    for (const auto& tile : tiles_->tiles()) add(tile->unknown_tree, SurfaceKind::kUnknownFrontier);
  return surfaces;
}

void FrameScene::render_surfaces(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                                 const PixelRect& rect, DepthImage& depth_m) {
  buffers_.drawn.assign(1, MeshInstance{&moved_.drawn, Eigen::Isometry3d::Identity()});
  if (config_.surfaces == SurfacePolicy::kMap) add_room(buffers_.drawn);
  depth_pass_.render(buffers_.drawn, camera, T_world_camera, rect, depth_m);
}

}  // namespace roomradar
