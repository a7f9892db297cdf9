// picture_judge.cpp: composes the true picture and sums the differences.
#include "app/evaluation/trade/picture_judge.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace roomradar {
namespace {

double difference(Rgb a, Rgb b) {
  return (std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b)) / (3.0 * 255.0);
}

/// Returns true if the layer has an object at the pixel, hidden or not.
bool is_covered(const ObjectLayer& layer, int x, int y) {
  if (x < layer.rect.x || x >= layer.rect.x + layer.rect.width) return false;
  if (y < layer.rect.y || y >= layer.rect.y + layer.rect.height) return false;
  for (int j = 0; j < layer.samples; ++j) {
    const float* depth_m =
        layer.depth_m.row((y - layer.rect.y) * layer.samples + j) + (x - layer.rect.x) * layer.samples;
    if (std::any_of(depth_m, depth_m + layer.samples, [](float z_m) { return z_m > 0.0F; })) return true;
  }
  return false;
}

/// Marks the pixels within kEdgeBand_px of an edge between shown and hidden parts of an object.
void mark_edges(const ObjectLayer& layer, const Occlusion& occlusion, MaskImage& edges) {
  const PixelRect& rect = occlusion.rect;
  edges.resize(rect.width, rect.height);
  const auto is_hidden = [&](int x, int y) { return occlusion.unsoftened.at(x, y) >= 0.5F; };
  for (int y = 0; y < rect.height; ++y) {
    for (int x = 0; x < rect.width; ++x) {
      if (!is_covered(layer, rect.x + x, rect.y + y)) continue;
      for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{0, 1}}) {
        if (!edges.contains(x + dx, y + dy) || !is_covered(layer, rect.x + x + dx, rect.y + y + dy)) continue;
        if (is_hidden(x, y) == is_hidden(x + dx, y + dy)) continue;
        for (int v = std::max(y - kEdgeBand_px, 0); v < std::min(y + kEdgeBand_px + 1, rect.height); ++v)
          std::fill_n(edges.row(v) + std::max(x - kEdgeBand_px, 0),
                      std::min(x + kEdgeBand_px + 1, rect.width) - std::max(x - kEdgeBand_px, 0), 1);
      }
    }
  }
}

}  // namespace

PictureErrors& PictureErrors::operator+=(const PictureErrors& other) {
  difference += other.difference;
  object_pixels += other.object_pixels;
  edge_difference += other.edge_difference;
  edge_pixels += other.edge_pixels;
  return *this;
}

PictureJudge::PictureJudge(const std::vector<Mesh>& objects) : drawer_(context_) {
  for (const Mesh& mesh : objects) objects_.push_back(object_of(context_, "judged", mesh, objects_));
}

PictureErrors PictureJudge::errors_of(const JudgedPicture& judged, const Frame& frame,
                                      const DepthImage& true_depth_m,
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
  config.occlusion.edge_reach_px = 0;  // exact depth needs no correction of edges
  cast_shadows(frame.colour, {true_depth_m, frame.colour_camera, T_world_camera}, casters, config, right_);
  lay_objects({.layer = layer_, .feet = {}}, true_depth_m, config.occlusion, occlusion_, right_);
  PictureErrors errors;
  for (std::size_t i = 0; i < right_.pixels.size(); ++i) {
    errors.difference += difference(right_.pixels[i], judged.picture.pixels[i]);
    errors.object_pixels += difference(right_.pixels[i], frame.colour.pixels[i]) > 0.0 ? 1 : 0;
  }

  mark_edges(layer_, occlusion_, edges_);
  for (int y = 0; y < edges_.height; ++y) {
    for (int x = 0; x < edges_.width; ++x) {
      if (edges_.at(x, y) == 0) continue;
      const int u = occlusion_.rect.x + x, v = occlusion_.rect.y + y;
      errors.edge_difference += difference(right_.at(u, v), judged.picture.at(u, v));
      ++errors.edge_pixels;
    }
  }
  return errors;
}

}  // namespace roomradar
