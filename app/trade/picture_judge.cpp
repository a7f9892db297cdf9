// picture_judge.cpp: the right picture, and what another one has different.
#include "app/trade/picture_judge.hpp"

#include <cstdlib>

namespace roomradar {
namespace {

double difference(Rgb a, Rgb b) {
  return (std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b)) / (3.0 * 255.0);
}

}  // namespace

PictureJudge::PictureJudge(const std::vector<Mesh>& objects) : drawer_(context_) {
  for (const Mesh& mesh : objects) objects_.push_back(object_of(context_, "judged", mesh, objects_));
}

double PictureJudge::error_of(const JudgedPicture& judged, const Frame& frame, const DepthImage& true_depth_m,
                              const Eigen::Isometry3d& T_world_camera) {
  std::vector<DrawnObject> drawn;
  std::vector<ShadowCaster> casters;
  for (const JudgedObject& shown : judged.objects) {
    VirtualObject& object = *objects_[shown.object];
    make_contact_shadow(object.model->surface, shown.T_world_object.linear(), object.shadow);
    drawn.push_back({.instance = {&object.model->shape.drawn, shown.T_world_object},
                     .is_closed = object.model->shape.touched.is_closed()});
    casters.push_back({&object.shadow, shown.T_world_object});
  }
  drawer_.draw(drawn, frame.colour_camera, T_world_camera, {}, layer_);
  ComposeConfig config;
  config.occlusion.edge_reach_px = 0;  // the depth has no edge in the wrong place
  compose(frame.colour, frame.colour_camera, T_world_camera, true_depth_m, casters, layer_, config,
          occlusion_, right_);
  double sum = 0.0;
  std::size_t changed = 0;
  for (std::size_t i = 0; i < right_.pixels.size(); ++i) {
    sum += difference(right_.pixels[i], judged.picture.pixels[i]);
    changed += difference(right_.pixels[i], frame.colour.pixels[i]) > 0.0 ? 1 : 0;
  }
  return changed > 0 ? sum / static_cast<double>(changed) : 0.0;
}

}  // namespace roomradar
