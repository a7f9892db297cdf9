// picture_composer.cpp: colour, shadows, objects and occlusion of one picture.
#include "app/session/picture_composer.hpp"

#include <algorithm>

#include "app/objects/unknown_support.hpp"
#include "app/render/camera_noise.hpp"

namespace roomradar {
namespace {

constexpr double kBesideObject_m = 0.03;  // by which a hatched patch is seen beside its object

/// Extrapolates a camera's pose to after_s after T_world_now from its motion over the last dt_s, by at most
/// that motion in either direction. Returns T_world_now without a time difference, or after a jump: the
/// source was rewound, or the camera relocalised.
Eigen::Isometry3d pose_beside(const Eigen::Isometry3d& T_world_before, const Eigen::Isometry3d& T_world_now,
                              double dt_s, double after_s) {
  constexpr double kJump_m = 0.3, kJump_rad = 0.3;
  if (!(dt_s > 0.0) || after_s == 0.0) return T_world_now;
  const double part = std::clamp(after_s / dt_s, -1.0, 1.0);
  const Eigen::Isometry3d T_before_now = T_world_before.inverse() * T_world_now;
  const Eigen::AngleAxisd turn(T_before_now.linear());
  if (!(T_before_now.translation().norm() < kJump_m && turn.angle() < kJump_rad)) return T_world_now;
  Eigen::Isometry3d T_now_then = Eigen::Isometry3d::Identity();
  T_now_then.linear() = Eigen::AngleAxisd(part * turn.angle(), turn.axis()).toRotationMatrix();
  T_now_then.translation() = part * T_before_now.linear().transpose() * T_before_now.translation();
  return T_world_now * T_now_then;
}

/// Returns the smallest rectangle of the pixels in `rect` that have no depth.
PixelRect without_depth(const DepthImage& depth_m, const PixelRect& rect) {
  PixelRect gaps;
  for (int y = rect.y; y < rect.y + rect.height; ++y) {
    const float* row = depth_m.row(y);
    int first = rect.x, last = rect.x + rect.width - 1;
    while (first <= last && row[first] > 0.0F) ++first;
    while (last > first && row[last] > 0.0F) --last;
    if (first <= last) gaps = united(gaps, {first, y, last - first + 1, 1});
  }
  return gaps;
}

/// Marks the pixels that are seen past a part of the room that is gone. Empties the mask if there are none.
void mark_revealed(const FrameForeground& foreground, MaskImage& revealed_mask) {
  const LabelImage& labels = foreground.labels;
  revealed_mask.resize(0, 0);
  if (foreground.counts.revealed == 0) return;
  revealed_mask.resize(labels.width, labels.height);
  std::transform(
      labels.pixels.begin(), labels.pixels.end(), revealed_mask.pixels.begin(),
      [](PixelLabel label) { return label == PixelLabel::kRevealed ? std::uint8_t{255} : std::uint8_t{0}; });
}

}  // namespace

PictureComposer::PictureComposer(GlContext& context, FrameScene& scene,
                                 const std::vector<std::unique_ptr<VirtualObject>>& objects,
                                 const SessionConfig& config)
    : scene_(scene), objects_(objects), config_(config), drawer_(context) {}

void PictureComposer::keep_colour(const Frame& frame, const Eigen::Isometry3d& T_world_camera, double dt_s) {
  if (frame.colour.empty()) return;
  const Eigen::Isometry3d T_world_then =
      T_world_before_ ? pose_beside(*T_world_before_, T_world_camera, dt_s, frame.colour_after_depth_s)
                      : T_world_camera;
  colour_.view = {frame.colour_camera, T_world_then * frame.T_colour_depth.inverse()};
  buffers_.background = frame.colour;
  estimate_light(frame, T_world_camera, dt_s);
  if (const std::optional<float> noise =
          config_.picture.has_grain ? noise_of(buffers_.background) : std::nullopt)
    light_.noise += (light_.noise > 0.0F ? renewed_fraction(dt_s, config_.picture.light) : 1.0F) *
                    (*noise - light_.noise);
}

void PictureComposer::estimate_light(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                                     double dt_s) {
  const ExpectedView& expected = scene_.expected();
  const MaskImage& dynamic_mask = scene_.foreground().dynamic_mask;
  light_.samples.clear();
  Eigen::Vector3d place_world = Eigen::Vector3d::Zero();
  int placed = 0;
  for (const auto& object : objects_) {
    if (!object->in_room) continue;
    place_world += middle_world(*object);
    ++placed;
  }
  if (placed == 0 || expected.depth_m.empty()) return;
  place_world /= placed;
  const LightConfig& config = config_.picture.light;
  take_light_samples({buffers_.background, colour_.view->camera, colour_.view->T_world_view},
                     {expected.depth_m, expected.camera, T_world_camera, frame.depth_m, dynamic_mask},
                     wanted_samples(!light_.estimator.light(), dt_s, config), light_.position,
                     light_.samples);
  TreeInstance room;
  for (const SceneTree& surface : scene_.surfaces())
    if (surface.kind == SurfaceKind::kStatic) room = surface.instance;
  for (LightSample& sample : light_.samples)
    sample.reach =
        surface_reach(room, sample.p_world_m.cast<double>(), sample.normal_world.cast<double>(), place_world);
  light_.estimator.add(light_.samples, place_world.cast<float>(), dt_s, config);
  if (light_.estimator.light()) buffers_.reaches.update(objects_, room, dt_s, renewed_fraction(dt_s, config));
}

ShadowCaster PictureComposer::caster_of(const VirtualObject& object, const SplitLight* light) {
  ShadowCaster caster{&object.shadow, object.body.T_world_object};
  if (light == nullptr) return caster;
  const MainLight& main = light->main;
  const float on_level = main.directed.sum() * std::max(0.0F, static_cast<float>(main.to_light_world.z()));
  const float all = irradiance(light->whole, Eigen::Vector3f::UnitZ()).sum();
  caster.to_light_world = main.to_light_world.cast<float>();
  caster.directed_fraction = all > 0.0F ? std::min(on_level / all, 1.0F) : 0.0F;
  return caster;
}

void PictureComposer::find_feet(const ShownView& view) {
  buffers_.feet.camera = view.camera;
  buffers_.feet.planes.clear();
  const Eigen::Vector3d up_camera = view.T_world_view.linear().transpose() * Eigen::Vector3d::UnitZ();
  for (const auto& object : objects_) {
    if (!object->in_room) continue;
    const double foot_m = object->body.T_world_object.translation().z() + lowest_m(*object);
    buffers_.feet.planes.push_back(
        {up_camera.cast<float>(), static_cast<float>(view.T_world_view.translation().z() - foot_m)});
  }
}

void PictureComposer::begin_frame(const Frame& frame) {
  colour_.frames_without =
      frame.colour.empty() ? std::min(colour_.frames_without + 1, kColourLasts_frames + 1) : 0;
  if (colour_.frames_without > kColourLasts_frames) colour_.view.reset();
}

ShownView PictureComposer::view_of(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  if (colour_.view) return *colour_.view;
  shade_depth(frame.depth_m, frame.depth_camera, buffers_.background);
  return {frame.depth_camera, T_world_camera};
}

void PictureComposer::show_camera_alone(const Frame& frame) {
  shown_view_.reset();
  if (!frame.colour.empty()) {
    picture_ = frame.colour;
    colour_.view.reset();  // older, and of unknown pose
  } else if (colour_.view) {
    picture_ = buffers_.background;
  } else if (colour_.frames_without > kColourLasts_frames || picture_.empty()) {
    shade_depth(frame.depth_m, frame.depth_camera, picture_);
  }
}

void PictureComposer::renew_a_shadow(bool may_refine) {
  constexpr double kTurned_rad = 0.05;
  constexpr int kFine = 16, kCoarse = 8;  // 3 ms and 0.2 ms
  // Objects take turns, so one that keeps rotating does not block the others.
  for (std::size_t i = 1; i <= objects_.size(); ++i) {
    const std::size_t number = (last_shadow_ + i) % objects_.size();
    VirtualObject& object = *objects_[number];
    if (!object.in_room) continue;
    const Eigen::Matrix3d& R_world_object = object.body.T_world_object.linear();
    const bool has_turned =
        Eigen::AngleAxisd(object.shadow.R_world_object.transpose() * R_world_object).angle() > kTurned_rad;
    const bool gets_fine = object.body.asleep && object.shadow.cells_across < kFine && may_refine;
    if (!has_turned && !gets_fine) continue;
    make_contact_shadow(object.model->surface, R_world_object, object.shadow, gets_fine ? kFine : kCoarse);
    last_shadow_ = number;
    return;
  }
}

void PictureComposer::compose(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                              bool may_refine_shadow) {
  shown_view_ = view_of(frame, T_world_camera);
  const auto& [camera, T_world_view] = *shown_view_;

  const bool has_shadows = config_.picture.shadow_strength > 0.0F;
  std::vector<DrawnObject> drawn;
  light_.objects.clear();
  light_.objects.reserve(objects_.size());  // drawn objects keep pointers
  std::vector<ShadowCaster> casters;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const VirtualObject* object = objects_[i].get();
    if (!object->in_room) continue;
    drawn.push_back(drawn_object(*object, camera, T_world_view, config_.object_error_px));
    if (const LightReach* reach = buffers_.reaches.of(i);
        colour_.view && light_.estimator.light() && reach != nullptr) {
      const RoomLight light = light_.estimator.light_at(*reach);
      light_.objects.push_back({light, main_light(light)});
      drawn.back().light = &light_.objects.back();
    }
    if (has_shadows) casters.push_back(caster_of(*object, drawn.back().light));
  }
  drawer_.begin(drawn, camera, T_world_view, {}, layer_);  // runs in parallel with real depth and shadows

  if (has_shadows) renew_a_shadow(may_refine_shadow);
  buffers_.real_depth_m.resize(camera.width_px, camera.height_px);
  const PixelRect rect = pixels_to_compose(casters, camera, T_world_view, layer_, config_.picture.occlusion);
  if (rect.width > 0 && rect.height > 0)
    scene_.render_surfaces(camera, T_world_view, rect, buffers_.real_depth_m);
  // Where nothing moved or is gone, measured depth matters only where the map has none.
  const FrameForeground& foreground = scene_.foreground();
  const bool has_moved = foreground.counts.moved > 0;
  mark_revealed(foreground, buffers_.revealed_mask);
  const bool bridges = has_moved && config_.picture.bridge_gaps;
  const PixelRect measured =
      has_moved || !buffers_.revealed_mask.empty() ? rect : without_depth(buffers_.real_depth_m, rect);
  if (measured.width > 0) {
    view_measured({.depth_m = frame.depth_m,
                   .dynamic_mask = foreground.dynamic_mask,
                   .camera = frame.depth_camera,
                   .revealed_mask = buffers_.revealed_mask},
                  T_world_view.inverse() * T_world_camera, camera, measured, buffers_.measured);
    add_measured(buffers_.measured, frame.depth_noise, buffers_.real_depth_m);
    if (bridges) bridge_gaps(buffers_.background, buffers_.measured, buffers_.real_depth_m);
  }
  const MaskImage* is_decided = bridges && measured.width > 0 ? &buffers_.measured.is_decided : nullptr;
  cast_shadows(buffers_.background, {buffers_.real_depth_m, camera, T_world_view}, casters, config_.picture,
               picture_, is_decided);
  buffers_.patches.clear();
  for (const auto& object : objects_)
    if (rests_on_unknown(*object))
      buffers_.patches.push_back(
          {support_point_world(*object),
           footprint_radius_m(*object, object->body.T_world_object.linear()) + kBesideObject_m});
  hatch(buffers_.patches, camera, T_world_view, buffers_.real_depth_m, picture_);
  drawer_.finish(layer_);
  find_feet(*shown_view_);
  lay_objects({.layer = layer_, .feet = buffers_.feet}, buffers_.real_depth_m, config_.picture.occlusion,
              occlusion_, picture_, &buffers_.background);
  ++pictures_;
  if (colour_.view && config_.picture.has_grain)
    add_grain(layer_, occlusion_, light_.noise, pictures_, picture_);
}

}  // namespace roomradar
